"""Panels that slope: a plane through what a box shows, and the panel on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...mesh import FloatArray
from ...part import OpensBy, Panel
from ..seams.cutting import Region
from ..seams.placing import OpeningPart
from .boxed import StatedBox

#: A panel slopes by more than this [rad], and departs from its plane by at most so many pixels, at
#: its middle half.
SLOPES = 0.1
FLAT = 1.5
#: Rounds in which what departs from the plane, as a handle does, is left out.
ROUNDS = 4


def tilted(mover: OpeningPart, part: StatedBox) -> OpeningPart:
    """Return a panel that is parallel to what its box shows, if that slopes; else as it is."""
    panel = mover.panel
    if panel is None or panel.opens is OpensBy.OUT or panel.thickness is None:
        return mover
    plane = _plane_of(part)
    if plane is None:
        return mover
    frame = panel.frame
    normal = frame[2] - plane[1:] @ frame[:2]
    normal /= np.linalg.norm(normal)
    axis = mover.motion.axis - float(mover.motion.axis @ normal) * normal
    origin = _point(plane, frame, *(frame[:2] @ mover.motion.origin))
    right = frame[0] - float(frame[0] @ normal) * normal
    right /= np.linalg.norm(right)
    own = np.stack([right, np.cross(normal, right), normal])
    if float(own[1] @ frame[1]) < 0.0:
        own[1] = -own[1]
    edges = (panel.low, panel.high)
    corners = np.array([_point(plane, frame, a[0], b[1]) for a in edges for b in edges])
    local = corners @ own.T
    behind = float(local[:, 2].max()) + panel.thickness
    return replace(
        mover,
        region=Region(
            np.concatenate([mover.region.normals[:-1], normal[None]]),
            np.array([*mover.region.offsets[:-1], behind]),
        ),
        motion=replace(mover.motion, axis=axis / np.linalg.norm(axis), origin=origin),
        panel=Panel(
            own,
            local[:, :2].min(axis=0),
            local[:, :2].max(axis=0),
            float(local[:, 2].min()),
            panel.thickness,
            panel.opens,
        ),
    )


def _point(plane: FloatArray, frame: FloatArray, right: float, up: float) -> FloatArray:
    """Return the point of a plane, as of :func:`_plane_of`, at a place [m], object frame, [3]."""
    return np.asarray(np.array([right, up, plane @ [1.0, right, up]]) @ frame)


def _plane_of(part: StatedBox) -> FloatArray | None:
    """Return the plane of what a box shows; ``None`` if it is upright to the view, or no plane.

    Depth in the side's frame is ``plane @ [1, right, up]`` [m].
    """
    rows, columns = part.rectangle.window
    raster = part.front.relief.raster
    seen = part.front.relief.seen[rows, columns]
    row, column = np.nonzero(seen)
    if len(row) < 16:
        return None
    places = np.stack([raster.right[columns][column], raster.up[rows][row]], axis=1)
    depth = raster.near - part.front.face.height[rows, columns][seen] * raster.pixel
    rows_of = np.column_stack([np.ones(len(places)), places])
    kept = np.ones(len(places), dtype=np.bool_)
    for _ in range(ROUNDS):
        found = np.linalg.lstsq(rows_of[kept], depth[kept], rcond=None)[0]
        off = np.abs(rows_of @ found - depth)
        kept = off <= max(2.0 * float(np.median(off)), 0.5 * raster.pixel)
    slopes = float(np.arctan(np.linalg.norm(found[1:])))
    if slopes < SLOPES or float(np.median(off)) > FLAT * raster.pixel:
        return None
    return np.asarray(found, dtype=np.float64)
