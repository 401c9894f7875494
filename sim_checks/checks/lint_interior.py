"""How much of a part's visible hollow do its collision hulls leave free?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage

from ..config import LintConfig
from ..description import BoolArray, DescribedShape, FloatArray, Link
from ..geometry.hull import CollisionHull, find_hull
from ..geometry.placing import box_around, spread_directions
from ..report import Finding
from .result import Findings, graded

#: Free voxels around everything, through which the outside is one.
MARGIN = 2
#: Spacing of the points that mark the surface, in voxels; up to 0.7 no path between voxels slips
#: through.
SPACING = 0.5
#: Points marked at a time, which bounds memory.
CHUNK = 500_000
#: A pocket is walled on this many of the six sides along the axes: one side may be open.
WALLED = 5
#: Components of a normal below this count as level.
LEVEL = 1e-9
#: The lattice stands this far off the middle of what it is laid around, in voxels. Things are made
#: in even measures, so that whole walls would lie on or half way between centres, where rounding
#: decides: one format has them in single precision, another as text.
OFF = np.array([0.0123, 0.0179, 0.0237])
#: Lengths that differ by less, in voxels, differ by rounding.
ROUNDING = 1e-3
#: More corners than this are thinned before their convex hull is taken, whose cost grows with their
#: square.
CORNERS = 1000


@dataclass(frozen=True)
class _Grid:
    """A cube lattice around a link: centre of voxel i at ``start + i * size`` [m]."""

    start: FloatArray
    size: float
    shape: tuple[int, int, int]


def interior_findings(
    link: Link, hulls: Sequence[CollisionHull], down: FloatArray, config: LintConfig
) -> tuple[list[Finding], dict[str, Any]]:
    """Return the findings about one link's open inside, and its numbers.

    The cavity is the space within the convex hull of the visible geometry that can be reached from
    outside without crossing a visible surface; space closer than a voxel or two to a surface is
    left out, so bulging hulls of a sound decomposition are not held against it. Of the cavity, a
    pocket is where a ball as wide as a hand comes from outside and finds visible walls on at least
    five of six sides, below among them: the inside of a cabinet, drawer, oven or bowl, not of a
    bottle, a knob or a table, nor of a block drawn without its bottom.

    What only rounding tells apart is measured alike: the URDF and the MJCF of an asset have the
    same figures.

    Args:
        link: with its visible geometry.
        hulls: of its collision shapes, in its frame.
        down: which way is down in the link's frame, shape [3].
        config: how finely to look, and what must stay free.

    Returns:
        ``interior_filled``: error for a pocket, warning for any other large cavity. The numbers are
        ``None`` where there is no such space.
    """
    numbers: dict[str, Any] = {"interior_kept": None, "pocket_kept": None}
    if not link.visuals or not hulls or _same(link.visuals, link.collisions):
        return [], numbers
    grid = _grid(link.visuals, config)
    surface = _surface(link.visuals, grid)
    whole = _outline(link.visuals, grid)
    if whole is None:
        return [], numbers
    near = ndimage.binary_dilation(surface, np.ones((3, 3, 3), dtype=bool))
    cavity = _reached(~surface) & _rasterised(whole, grid) & ~near
    if cavity.sum() * grid.size**3 < config.cavity_share * whole.volume:
        return [], numbers
    filled = np.zeros(grid.shape, dtype=bool)
    for hull in hulls:
        filled |= _rasterised(hull, grid)
    numbers["interior_kept"] = _kept(cavity, filled)
    least = config.pocket_share * whole.volume / grid.size**3
    pocket = cavity & _walled(surface, down)
    if pocket.sum() >= least:
        # Where the middle of a hand can be.
        radius = config.hand_m / 2.0 / grid.size - ROUNDING
        pocket &= _reached(ndimage.distance_transform_edt(~surface) >= radius)
        numbers["pocket_kept"] = _kept(pocket, filled) if pocket.sum() >= least else None
    return list(_findings(link, numbers, config)), numbers


def _findings(link: Link, numbers: dict[str, Any], config: LintConfig) -> Findings:
    kept = numbers["pocket_kept"]
    least = config.pocket_kept
    leave = f"link {link.name!r}: collision shapes leave"
    grave = kept is not None and kept < least
    if grave:
        message = f"{leave} {100 * kept:.0f} % of its open inside empty, want at least "
        message += f"{100 * least:.0f} %: no hand can reach into it"
    else:
        kept = numbers["interior_kept"]
        least = config.interior_kept
        message = f"{leave} {100 * kept:.0f} % of the open space within its outline empty, "
        message += f"want at least {100 * least:.0f} %"
    if kept < least:
        yield graded(grave, "interior_filled", message, parts=(link.name,), value=kept, limit=least)


def _same(visuals: Sequence[DescribedShape], collisions: Sequence[DescribedShape]) -> bool:
    """Tell whether visuals and collisions are the same primitives: nothing is filled."""
    if any(shape.kind == "mesh" for shape in visuals):
        return False
    seen, touched = (sorted(s.vertices.tobytes() for s in each) for each in (visuals, collisions))
    return seen == touched


def _grid(shapes: Sequence[DescribedShape], config: LintConfig) -> _Grid:
    bounds = box_around(shape.corners for shape in shapes)
    extent = bounds[1] - bounds[0]
    size = max(float(extent.max()) / config.voxels, config.voxel_m)
    counts = np.ceil(extent / size - ROUNDING).astype(int) + 1
    start = (bounds[0] + bounds[1] - (counts - 1) * size) / 2.0 - (MARGIN + OFF) * size
    nx, ny, nz = (int(count) + 2 * MARGIN for count in counts)
    return _Grid(start, size, (nx, ny, nz))


def _surface(shapes: Sequence[DescribedShape], grid: _Grid) -> BoolArray:
    """Return voxels that a triangle passes through, so close that nothing leaks between them."""
    marked = np.zeros(grid.shape, dtype=bool)
    corners = np.vstack([shape.vertices[shape.faces] for shape in shapes])
    corners = (corners - grid.start) / grid.size
    lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
    # The first corner is where the longest and the shortest side meet: its angle is never obtuse.
    middle = np.argsort(lengths, axis=1)[:, 1]
    first = (middle + 2) % 3
    rows = np.arange(len(corners))
    a, b, c = (corners[rows, (first + k) % 3] for k in range(3))
    across = b - a
    down = c - a
    spaced = (np.ceil(np.linalg.norm(side, axis=1) / SPACING) for side in (across, down))
    steps = [np.maximum(1, each.astype(np.int64)) for each in spaced]
    counts = (steps[0] + 1) * (steps[1] + 1)
    ends = np.cumsum(counts)
    start = 0
    while start < len(corners):
        taken = int(ends[start - 1]) if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, taken + CHUNK, side="right")))
        # Rows of points from side ac to b.
        which = np.repeat(np.arange(start, stop), counts[start:stop])
        place = np.arange(taken, taken + len(which)) - (ends - counts)[which]
        row, column = np.divmod(place, steps[1][which] + 1)
        u = row / steps[0][which]
        v = column / steps[1][which] * (1.0 - u)
        inside = a[which] + u[:, None] * across[which] + v[:, None] * down[which]
        cells = np.clip(np.rint(inside).astype(np.int64), 0, np.array(grid.shape) - 1)
        marked[cells[:, 0], cells[:, 1], cells[:, 2]] = True
        start = stop
    return marked


def _outline(shapes: Sequence[DescribedShape], grid: _Grid) -> CollisionHull | None:
    """Return the convex hull of the shapes' corners [m]; of many, the farthest out by direction.

    These are taken where there are more than :data:`CORNERS`, in many directions; ``None`` where
    all span no volume.
    """
    points = np.vstack([shape.corners for shape in shapes])
    # One format welds corners that another repeats.
    cells = np.rint((points - grid.start) / (ROUNDING * grid.size)).astype(np.int64)
    points = points[np.unique(cells, axis=0, return_index=True)[1]]
    if len(points) > CORNERS:
        cells = np.rint((points[:, :2] - grid.start[:2]) / grid.size).astype(np.int64)
        columns = cells @ [grid.shape[1], 1]
        order = np.lexsort((points[:, 2], columns))
        starts = np.flatnonzero(np.diff(columns[order], prepend=-1))
        ends = np.concatenate([starts[1:], [len(order)]]) - 1
        points = points[order[np.concatenate([starts, ends])]]
        directions = np.vstack([spread_directions(CORNERS), np.eye(3), -np.eye(3)])
        points = points[np.unique(np.argmax(points @ directions.T, axis=0))]
    return find_hull(points)


def _reached(room: BoolArray) -> BoolArray:
    """Return the voxels of some room that are reached from outside without leaving it."""
    return ndimage.binary_propagation(np.zeros_like(room), mask=room, border_value=1)


def _walled(surface: BoolArray, down: FloatArray) -> BoolArray:
    """Return voxels that meet the surface below and along :data:`WALLED` half-axes or more."""
    met = np.zeros(surface.shape, dtype=np.int8)
    floor = np.zeros(surface.shape, dtype=bool)
    lowest = int(np.argmax(np.abs(down)))
    for axis in range(3):
        behind = np.logical_or.accumulate(surface, axis=axis)
        ahead = np.flip(np.logical_or.accumulate(np.flip(surface, axis), axis=axis), axis)
        met += behind
        met += ahead
        if axis == lowest:
            floor = ahead if down[axis] > 0.0 else behind
    return floor & (met >= WALLED)


def _kept(space: BoolArray, filled: BoolArray) -> float:
    return round(1.0 - float((space & filled).sum()) / float(space.sum()), 4)


def _rasterised(hull: CollisionHull, grid: _Grid) -> BoolArray:
    """Return voxels whose centre is in the hull: for each column along z, the range of heights."""
    inside = np.zeros(grid.shape, dtype=bool)
    normals = hull.normals
    offsets = (hull.offsets - normals @ grid.start) / grid.size
    low, high = (hull.bounds - grid.start) / grid.size
    i0, j0 = (max(0, int(np.ceil(low[k]))) for k in (0, 1))
    i1, j1 = (min(grid.shape[k] - 1, int(np.floor(high[k]))) for k in (0, 1))
    if i0 > i1 or j0 > j1:
        return inside
    i, j = np.meshgrid(np.arange(i0, i1 + 1), np.arange(j0, j1 + 1), indexing="ij")
    room = offsets - i[..., None] * normals[:, 0] - j[..., None] * normals[:, 1]
    up = normals[:, 2] > LEVEL
    down = normals[:, 2] < -LEVEL
    top = (room[..., up] / normals[up, 2]).min(axis=-1)
    bottom = (room[..., down] / normals[down, 2]).max(axis=-1)
    bottom[(room[..., ~(up | down)] < 0.0).any(axis=-1)] = np.inf
    k = np.arange(grid.shape[2])
    inside[i0 : i1 + 1, j0 : j1 + 1] = (k >= bottom[..., None]) & (k <= top[..., None])
    return inside
