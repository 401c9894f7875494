"""One moving group of pieces and its joint, in the view frame it was found in."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...mesh import FloatArray, IntArray
from ...part import Panel, PartKind
from ..proposal import Motion

#: The commonest limit by far of those that people give to doors [rad].
DOOR_LIMIT = np.radians(90.0)
#: A drawer, or a basket, slides this share of its depth.
DRAWER_SHARE = 0.92


@dataclass(frozen=True)
class Mover:
    """A part that moves, in the view frame.

    Attributes:
        kind: what it is; names the part.
        motion: how it moves.
        pieces: the pieces that move, shape [piece_count].
        guesses: assumptions, each the end of a sentence that starts with the part's name.
        weight: how much it speaks for the view it was found in.
        panel: as in :class:`~asset_factory.factory.part.Part`, where one was seen.
    """

    kind: PartKind
    motion: Motion
    pieces: IntArray
    guesses: tuple[str, ...] = ()
    weight: float = 0.0
    panel: Panel | None = None

    def seen_from(self, rotation: FloatArray) -> Mover:
        """Return the mover in the frame that ``rotation``, shape [3, 3], turned into this one."""
        back = rotation.T
        motion = self.motion.turned(back)
        return replace(
            self,
            motion=replace(motion, axis=motion.axis / np.linalg.norm(motion.axis)),
            panel=None if self.panel is None else self.panel.turned(back),
        )
