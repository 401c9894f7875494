"""What another source, e.g. a network, says of a part's motion: an input of the evidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, freeze, read_only


@dataclass(frozen=True)
class Guess:
    """A rough idea of how one part moves; anything may be left out.

    Attributes:
        turns: probability that it turns, 0 to 1; ``None`` for no opinion.
        direction: of the axis or the slide, object frame, any length, shape [3]; its sign is an
            opinion on which way opens.
        point: near the axis [m], object frame, shape [3].
        upper: how far it opens [rad] or [m].
    """

    turns: float | None = None
    direction: FloatArray | None = None
    point: FloatArray | None = None
    upper: float | None = None

    def __post_init__(self) -> None:
        if self.turns is not None and not 0.0 <= self.turns <= 1.0:
            raise ValueError(f"guess: turns with probability {self.turns}, want 0 to 1")
        if self.direction is not None:
            length = float(np.linalg.norm(self.direction))
            if not 0.0 < length < np.inf:
                raise ValueError(
                    "guess: its direction has no length, "
                    "want a vector that points somewhere, or None"
                )
            object.__setattr__(self, "direction", read_only(np.asarray(self.direction) / length))
        freeze(self, "point")


NOTHING = Guess()
