"""The sides of a mesh as pictures to draw boxes on."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np

from ..mesh import FloatArray, Mesh
from ..views.raster import Side
from ..views.view import View, elevation

#: On which parts are stated, in the order of the page.
SIDES = tuple(side for side in Side if side is not Side.BOTTOM)
PIXELS = 480
#: Towards the light, in a side's frame: right, up, away.
_LIGHT = np.array([-0.35, 0.55, -0.76])
#: A step in depth that is drawn as a line, of the object's longest extent: not a slope's.
_STEP = 0.008


@dataclass(frozen=True)
class SidePicture:
    """One side, drawn.

    Attributes:
        side: which.
        png: transparent where nothing is.
        size: columns and rows [pixels].
        frame: left, lower, right and upper end of the mesh, in shares of the picture: what the
            shares of a stated box are shares of.
    """

    side: Side
    png: bytes
    size: tuple[int, int]
    frame: tuple[float, float, float, float]


def side_pictures(mesh: Mesh) -> tuple[SidePicture, ...]:
    """Return the sides of a mesh whose front is -Y."""
    return tuple(_drawn(elevation(mesh, side, PIXELS)) for side in SIDES)


def _drawn(seen: View) -> SidePicture:
    from PIL import Image

    pixels = np.concatenate([_shaded(seen), seen.seen[..., None].astype(float)], axis=-1)
    image = Image.fromarray((255.0 * pixels[::-1]).round().astype(np.uint8), "RGBA")
    buffer = io.BytesIO()
    image.save(buffer, format="PNG", compress_level=4)
    raster = seen.raster
    ends = seen.mesh.bounds @ raster.side.frame.T
    low = (ends.min(axis=0)[:2] - raster.low) / raster.pixel + 0.5
    high = (ends.max(axis=0)[:2] - raster.low) / raster.pixel + 0.5
    size = (raster.columns, raster.rows)
    left, lower, right, upper = (float(x) for x in np.concatenate([low / size, high / size]))
    return SidePicture(raster.side, buffer.getvalue(), size, (left, lower, right, upper))


def _shaded(seen: View) -> FloatArray:
    """Return colours in [0, 1] whose relief shows on white and on black, shape [..., 3]."""
    light = np.clip(seen.normal @ (_LIGHT / np.linalg.norm(_LIGHT)), 0.0, 1.0)
    shaded = (0.1 + 0.8 * seen.color) * (0.5 + 0.6 * light[..., None])
    depth = np.where(seen.seen, seen.depth, 0.0)
    step = np.zeros(depth.shape, dtype=bool)
    limit = _STEP * float(seen.mesh.extents.max())
    for axis in (0, 1):
        bend = np.roll(depth, 1, axis) - 2.0 * depth + np.roll(depth, -1, axis)
        step |= np.abs(bend) > limit
    shaded[step & seen.seen] *= 0.35
    return np.asarray(np.clip(shaded, 0.0, 1.0))
