"""One side of an object as a relief: heights in pixels, colours and normals, ready to be read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import ndimage

from ...geometry.colors import linear_of
from ...mesh import BoolArray, FloatArray, IntArray
from ...views.raster import Raster, Side
from ...views.view import View

#: Nothing lies so far behind everything [pixels]; an outline is a step as high as that.
BEHIND = 24.0
#: What fills less than that share of the fullest row or column is a sliver.
SLIVER = 0.05


@dataclass(frozen=True)
class Relief:
    """What one side shows; arrays have shape [rows, columns], row 0 lowest.

    Attributes:
        raster: where the pixels lie.
        seen: where there is anything.
        height: towards the viewer [pixels]; where nothing is seen, below all that is.
        facing: cosine between the surface and the viewer, 0 where nothing is seen.
        lab: colour (CIE L*a*b*), shape [rows, columns, 3].
        depth: of the object, seen from this side [m].
    """

    raster: Raster
    seen: BoolArray
    height: FloatArray
    facing: FloatArray
    lab: FloatArray
    depth: float

    @property
    def side(self) -> Side:
        """Return the side that is looked at."""
        return self.raster.side

    @property
    def shape(self) -> tuple[int, int]:
        """Return the rows and columns."""
        return self.raster.rows, self.raster.columns

    @cached_property
    def box(self) -> IntArray:
        """Return first and last row and column with a surface, shape [2, 2].

        Without slivers that stick out: the ground that an object stands on, a handle, an antenna.
        """
        counts = [self.seen.sum(axis=across) for across in (1, 0)]
        ends = [np.flatnonzero(each > SLIVER * each.max())[[0, -1]] for each in counts]
        return np.stack(ends, axis=1)


def relief_of(view: View) -> Relief:
    """Return one side of a mesh."""
    seen = view.seen
    # A pinhole of a mesh that is not quite closed is no gap between two things.
    seen_filled = (
        ndimage.binary_closing(np.pad(seen, 2), np.ones((3, 3), np.bool_))[2:-2, 2:-2] | seen
    )
    height = -view.depth / view.raster.pixel
    lowest = float(height[seen].min()) if seen.any() else 0.0
    nearest = ndimage.distance_transform_edt(~seen, return_distances=False, return_indices=True)
    height = height[tuple(nearest)]
    lab = lab_of(view.color)[tuple(nearest)]
    # Whichever way round triangles are: sheets have two faces, and meshes are found inside out.
    facing = np.abs(view.normal[..., 2])[tuple(nearest)]
    return Relief(
        view.raster,
        np.asarray(seen_filled),
        np.where(seen_filled, height, lowest - BEHIND),
        np.where(seen_filled, np.clip(facing, 0.0, 1.0), 0.0),
        lab,
        float(np.abs(view.side.frame[2]) @ view.mesh.extents),
    )


def lab_of(color: FloatArray) -> FloatArray:
    """Convert sRGB colours in [0, 1], shape [..., 3], to CIE L*a*b* (D65; CIE 15:2004)."""
    to_xyz = np.array(
        [
            [0.4124564, 0.3575761, 0.1804375],
            [0.2126729, 0.7151522, 0.0721750],
            [0.0193339, 0.1191920, 0.9503041],
        ]
    )
    xyz = linear_of(color) @ to_xyz.T / np.array([0.95047, 1.0, 1.08883])
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)
