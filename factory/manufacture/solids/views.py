"""Which part is seen where from the six sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.crossings import BoolArray, Raster, Side
from ...geometry.elevations import PIXELS, Elevation, elevation
from ...mesh import FloatArray, IntArray, Mesh


@dataclass(frozen=True)
class PartView:
    """A side's picture; arrays have shape [rows, columns], row 0 lowest.

    Attributes:
        side: that is looked at; its frame's axes are right ``u``, up ``v`` and away ``w``.
        part: which part is seen; -1: nothing.
        depth: of what is seen, along the side's ``w`` [m]; infinite where there is nothing.
        picture: colours and normals.
    """

    side: Side
    part: IntArray
    depth: FloatArray
    picture: Elevation

    @property
    def raster(self) -> Raster:
        """Return where its pixels lie."""
        return self.picture.raster


def look(mesh: Mesh, face_part: IntArray, side: Side) -> PartView:
    """Return one side's view of a mesh whose faces belong to parts, shape [face_count]."""
    picture = elevation(mesh, side, PIXELS)
    seen: BoolArray = picture.seen
    part = np.where(seen, face_part[picture.face], -1)
    return PartView(
        side, part, np.where(seen, picture.depth + picture.raster.near, np.inf), picture
    )
