"""A stated part with the rectangle of seams that its box means."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from ...errors import InputRejected
from ...intake.stated import Hinge, StatedPart, StatedView
from ...mesh import FloatArray, IntArray
from ...part import OpensBy, PartKind
from ..seams.fronts import Front
from ..seams.handles import Protrusion
from ..seams.placing import OpeningPart
from ..seams.rectangles import Rectangle

T = TypeVar("T")
NOT_FOUND = "stated_part_not_found"
#: Of a stated box so much must show the mesh.
LEAST_SHOWN = 0.3
#: A box is at least so wide and so high [pixels].
THINNEST = 2
#: Ways to open that are tried for one part, where nobody says which.
MOST_WAYS = 2

#: How a panel of a kind opens where nobody says; these kinds are panels.
USUAL: Mapping[PartKind, tuple[OpensBy, ...]] = {
    PartKind.DOOR: (OpensBy.LEFT, OpensBy.RIGHT),
    PartKind.FLAP: (OpensBy.BOTTOM, OpensBy.TOP),
    PartKind.DRAWER: (OpensBy.OUT,),
    PartKind.RACK: (OpensBy.OUT,),
    PartKind.LID: (OpensBy.TOP, OpensBy.BOTTOM, OpensBy.LEFT, OpensBy.RIGHT),
}
#: How a panel opens that is hinged at an edge of its side's picture.
EDGES = {edge: OpensBy(edge) for edge in (Hinge.LEFT, Hinge.RIGHT, Hinge.TOP, Hinge.BOTTOM)}


@dataclass(frozen=True, eq=False)
class StatedWay:
    """One way in which a stated part may open.

    Attributes:
        mover: the part.
        faces: of the pieces that it is made of; none where it is cut out of the mesh in its region.
        cut: the part as it would be cut out, where it is made of pieces.
    """

    mover: OpeningPart
    faces: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    cut: OpeningPart | None = None

    def turned(self, rotation: FloatArray) -> StatedWay:
        """Return the same of an object turned about the origin by ``rotation``, shape [3, 3]."""
        cut = None if self.cut is None else self.cut.turned(rotation)
        return replace(self, mover=self.mover.turned(rotation), cut=cut)


@dataclass(frozen=True, eq=False)
class StatedBox:
    """A stated part and its place on a side.

    Attributes:
        stated: as somebody said it.
        place: in the list of parts.
        view: where it is seen.
        front: the side of the turned mesh that shows it.
        rectangle: its outline there.
        handle: that it is pulled by, the most prominent one; ``None`` without.
        ways: in which it may open, the likeliest first; none until it is placed on the mesh.
    """

    stated: StatedPart
    place: int
    view: StatedView
    front: Front
    rectangle: Rectangle
    handle: Protrusion | None
    ways: tuple[StatedWay, ...] = ()

    @property
    def kind(self) -> PartKind:
        """Return what it is."""
        return self.stated.kind.part

    @property
    def is_panel(self) -> bool:
        """Tell whether it closes an opening."""
        return self.kind in USUAL

    @property
    def corners(self) -> FloatArray:
        """Return its rectangle: right and up [m], low and high, shape [2, 2]."""
        return self.rectangle.corners(self.front.relief.raster)

    @property
    def label(self) -> str:
        """Return how messages call it."""
        return label_of(self.stated, self.place)

    def hinged(self, edges: Mapping[Hinge, T], what: str = "there") -> T | None:
        """Return the edge of some at which it is stated to be hinged; ``None``: nobody says.

        Raises:
            InputRejected: ``stated_part_not_found``: at another one.
        """
        hinge = self.stated.hinge
        if hinge is None or hinge in edges:
            return None if hinge is None else edges[hinge]
        sentence = f"is hinged at its {hinge}, want one of {', '.join(edges)} {what}"
        raise InputRejected(NOT_FOUND, f"{self.label}: {sentence}")


def label_of(part: StatedPart, place: int) -> str:
    """Return how messages call the part at a place of the list."""
    return f"parts[{place}] ({part.name or part.kind})"


def boxed_in(front: Front, part: StatedPart, place: int, box: Rectangle) -> StatedBox:
    """Return a stated part with the rectangle that its box means.

    Args:
        front: the side that shows it.
        part: that is stated, with a place.
        place: in the list of parts.
        box: that rectangle.

    Raises:
        InputRejected: ``stated_part_not_found``: the box hardly shows the mesh.
    """
    if box.size.min() < THINNEST:
        raise InputRejected(
            NOT_FOUND,
            f"{label_of(part, place)}: its box on the {part.side} is thinner than "
            f"{THINNEST * front.relief.raster.pixel * 1000.0:.3g} mm: too thin to be seen",
        )
    shown = front.relief.seen[box.window]
    share = float(shown.mean()) if shown.size else 0.0
    if share < LEAST_SHOWN or part.view is None:
        raise InputRejected(
            NOT_FOUND,
            f"{label_of(part, place)}: its box on the {part.side} shows the mesh on "
            f"{100 * share:.0f} % of its area, want {100 * LEAST_SHOWN:.0f} %; boxes are [left, "
            "lower, right, upper] in shares of that side's picture",
            value=share,
            unit="of its area",
            limit=LEAST_SHOWN,
        )
    handle = next(iter(front.handles_in(box)), None)
    return StatedBox(part, place, part.view, front, box, handle)
