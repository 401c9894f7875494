"""One moving group of pieces and its joint, in the view frame it was found in."""

from __future__ import annotations

from dataclasses import dataclass

from ...articulation import JointKind
from ...mesh import FloatArray, IntArray


@dataclass(frozen=True)
class Mover:
    """A part that moves.

    Attributes:
        label: what it is, e.g. ``door``, ``drawer``, ``lid``, ``knob`` or ``wheel``; names the
            part.
        kind: of its joint.
        axis: unit direction, view frame, shape [3]; positive opens.
        origin: a point on the axis, view frame [m], shape [3].
        lower, upper: limits [rad] or [m].
        pieces: the pieces that move, shape [piece_count].
        guesses: what was assumed, each the end of a sentence that starts with the part's name.
        weight: how much it speaks for the view it was found in.
    """

    label: str
    kind: JointKind
    axis: FloatArray
    origin: FloatArray
    lower: float
    upper: float
    pieces: IntArray
    guesses: tuple[str, ...] = ()
    weight: float = 1.0
