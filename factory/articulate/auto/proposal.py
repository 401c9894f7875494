"""A part that somebody thinks moves, before it is decided whether it does."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...mesh import FloatArray, read_only
from ...models.particulate.surface import BoolArray
from ...part import Proposer
from ..evidence import SeenMotion
from .trust import SIGNS
from .views import Slide

#: Where two proposals cannot both be, the one of the earlier proposer is believed.
BELIEVED = (Proposer.RULES, Proposer.SIDES, Proposer.NETWORK)


@dataclass(frozen=True)
class Proposal:
    """One part that may move, and how.

    Attributes:
        name: what to call it, e.g. ``door`` or ``part``.
        faces: whether each face of the mesh belongs to it, shape [face_count].
        motion: relative to what it hangs on.
        signs: what speaks for it, in the order of :data:`.trust.SIGNS`, shape [sign_count].
        notes: what was assumed, each the end of a sentence that starts with the part's name.
        slide: how it slides in what it turns with, if it does both; ``None`` if not.
        confidence: probability that there is such a part and that it moves so, 0 to 1; 0 until it
            is rated.
    """

    name: str
    faces: BoolArray = field(repr=False)
    motion: SeenMotion
    signs: FloatArray = field(repr=False)
    notes: tuple[str, ...] = ()
    slide: Slide | None = None
    confidence: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "faces", read_only(self.faces, np.bool_))
        object.__setattr__(self, "signs", read_only(self.signs))

    @property
    def proposer(self) -> Proposer:
        """Return who says so."""
        if self.signs[SIGNS.index("learned")] > 0.0:
            return Proposer.NETWORK
        return Proposer.SIDES if self.signs[SIGNS.index("sides")] > 0.0 else Proposer.RULES
