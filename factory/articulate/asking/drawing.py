"""One side of a mesh as a picture that somebody reads boxes off."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from ...articulation import rotation_about
from ...mesh import BoolArray, FloatArray, Mesh
from ...views.raster import Side
from ...views.view import View, elevation

Picture = npt.NDArray[np.uint8]

#: Pixels that are averaged to one, along each edge.
FINE = 2
#: A step in depth is drawn if it is this share of the longest extent, a crease from this angle on.
STEP = 0.002
CREASE = np.cos(np.radians(35.0))
STEP_INK = 0.75
CREASE_INK = 0.35
#: Towards the light, in a side's frame: right, up, away.
LIGHT = np.array([-0.45, 0.6, -0.66])
AMBIENT = 0.4
GROUND = 0.93
#: How far behind its nearest point a side's face goes, as a share of the longest extent.
FACE = 0.15
#: A darker object is brightened until half of it is as light as that.
BRIGHT = 0.4
#: How the oblique view is turned: about the upright, and down [rad].
ASIDE = 0.6
ABOVE = 0.4


def drawn_side(mesh: Mesh, side: Side, width: int, height: int) -> tuple[Picture, Picture]:
    """Return one side coloured and shaded, filling one direction, shape [rows, columns, 3] each.

    Args:
        mesh: whose front is -Y [m].
        side: that is looked at.
        width: at most [pixels].
        height: likewise.
    """
    size = np.abs(np.ptp(mesh.bounds @ side.frame.T, axis=0))[:2]
    scale = min(width / max(float(size[0]), 1e-9), height / max(float(size[1]), 1e-9))
    pixels = max(int(scale * float(mesh.extents.max())), 8) * FINE
    seen = elevation(mesh, side, pixels)
    light = AMBIENT + (1.0 - AMBIENT) * _lit(seen)
    ink = 1.0 - _lines(seen, float(mesh.extents.max()))
    colored = _brightened(seen) * (0.35 + 0.65 * light)[..., None]
    shaded = np.repeat(light[..., None], 3, axis=2)
    return (_finished(colored, seen.seen, ink), _finished(shaded, seen.seen, ink))


def drawn_oblique(mesh: Mesh, side: Side, width: int, height: int) -> Picture:
    """Return the mesh seen from an upright side, a little from its right and above, coloured."""
    before = side.frame.T @ Side.FRONT.frame
    turn = rotation_about([1.0, 0.0, 0.0], ABOVE) @ rotation_about([0.0, 0.0, 1.0], -ASIDE)
    colored, _ = drawn_side(mesh.turned(turn @ before.T), Side.FRONT, width, height)
    return colored


def count_lines(mesh: Mesh, side: Side, pixels: int) -> float:
    """Return how much a side's face shows: how many pixels its steps, grooves and creases fill.

    An inside seen through an open back is not counted.
    """
    seen = elevation(mesh, side, pixels)
    extent = float(mesh.extents.max())
    face = seen.seen & (seen.depth - seen.depth[seen.seen].min(initial=np.inf) < FACE * extent)
    return float(_lines(seen, extent)[face].sum())


def _brightened(seen: View) -> FloatArray:
    """Return the colours of a side, 0 to 1, those of a dark object lighter."""
    light = seen.color[seen.seen].max(axis=1, initial=0.0)
    middle = float(np.median(light)) if len(light) else 1.0
    if middle >= BRIGHT:
        return seen.color
    return np.asarray(seen.color ** (np.log(BRIGHT) / np.log(max(middle, 1e-3))))


def _lit(seen: View) -> FloatArray:
    """Return how much light each pixel gets, 0 to 1, whichever way round its triangle is."""
    normal = seen.normal
    toward = np.where(normal[..., 2:] > 0.0, -normal, normal)
    return np.asarray(np.clip(toward @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0))


def _lines(seen: View, extent: float) -> FloatArray:
    """Return how dark the line through each pixel is: steps, grooves, creases and outlines."""
    depth = np.where(seen.seen, seen.depth, float(seen.depth[seen.seen].max(initial=0.0)) + extent)
    normal = seen.normal
    toward = np.where(normal[..., 2:] > 0.0, -normal, normal)
    steps = np.zeros(depth.shape, dtype=np.bool_)
    creases = np.zeros(depth.shape, dtype=np.bool_)
    for axis in (0, 1):
        bend = ndimage.convolve1d(depth, [1.0, -2.0, 1.0], axis=axis, mode="nearest")
        steps |= (np.abs(bend) > STEP * extent) & seen.seen
        beside = np.roll(toward, 1, axis=axis)
        both = seen.seen & np.roll(seen.seen, 1, axis=axis)
        creases |= both & (np.einsum("ijk,ijk->ij", toward, beside) < CREASE)
    return np.asarray(np.maximum(STEP_INK * steps, CREASE_INK * creases))


def _finished(color: FloatArray, seen: BoolArray, ink: FloatArray) -> Picture:
    """Return an 8-bit picture, row 0 on top, its margin cut off and fine pixels averaged."""
    shown = np.where(seen[..., None], color * ink[..., None], GROUND)[1:-1, 1:-1][::-1]
    rows, columns = (max(length // FINE, 1) for length in shown.shape[:2])
    shown = shown[: rows * FINE, : columns * FINE]
    blocks = shown.reshape(rows, -1, columns, shown.shape[1] // columns, 3)
    return np.asarray(np.rint(255.0 * np.clip(blocks.mean(axis=(1, 3)), 0.0, 1.0)), dtype=np.uint8)
