"""The four sides of an object, made ready to be searched for panels and lids."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...mesh import FloatArray
from ...views.raster import Side, side_facing
from ...views.view import Views
from .controls import with_strips
from .evidence import seams_of
from .handles import Face, Protrusion, cleared
from .rectangles import SHORTEST, Lines, Rectangle, lines_of, rectangles_of
from .relief import Relief, relief_of

AROUND = (Side.FRONT, Side.RIGHT, Side.BACK, Side.LEFT)
OPPOSITE = {side: side_facing(side.frame[2]) for side in Side if side in AROUND}


@dataclass(frozen=True)
class Front:
    """One side and the space behind it.

    Attributes:
        relief: the side.
        face: it without handles.
        behind: the opposite side.
    """

    relief: Relief
    face: Face
    behind: Relief

    @cached_property
    def level(self) -> Lines:
        """Return the candidates for horizontal lines."""
        seams = seams_of(self.relief, self.face, upright=False)
        return lines_of(seams, *self.relief.box[:, 0].tolist())

    @cached_property
    def upright(self) -> Lines:
        """Return the candidates for vertical lines."""
        seams = seams_of(self.relief, self.face, upright=True)
        return lines_of(seams, *self.relief.box[:, 1].tolist())

    @cached_property
    def pulls(self) -> tuple[Protrusion, ...]:
        """Return the handles that are no controls, such as knobs on one strip."""
        told = with_strips(self.face, self.level, self.upright)
        return tuple(handle for handle in told if not handle.control)

    def handles_in(self, rectangle: Rectangle) -> tuple[Protrusion, ...]:
        """Return the pulls in a rectangle, the most prominent first."""
        inside = [
            handle
            for handle in self.pulls
            if (handle.low > rectangle.low).all() and (handle.high < rectangle.high).all()
        ]
        return tuple(sorted(inside, key=lambda h: -h.height * float(np.sqrt(h.size.prod()))))

    def rectangles(self) -> tuple[Rectangle, ...]:
        """Return those that are closed by seams, the best first."""
        first, last = self.relief.box
        shortest = SHORTEST * float((last - first).min())
        return rectangles_of(self.level, self.upright, shortest)


def fronts_of(views: Views) -> dict[Side, Front]:
    """Return the four upright sides of a mesh."""
    reliefs = {side: relief_of(views[side]) for side in AROUND}
    return {
        side: Front(reliefs[side], cleared(reliefs[side]), reliefs[OPPOSITE[side]])
        for side in AROUND
    }


def thickness(relief: Relief, behind: Relief) -> FloatArray:
    """Return the thickness between a side's surface and its opposite's [pixels]."""
    depth = float(relief.depth) / relief.raster.pixel
    return np.asarray(depth + relief.height + behind.height[:, ::-1])
