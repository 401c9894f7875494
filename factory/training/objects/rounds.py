"""Round and bent solids: what a lathe turns, what a pipe bender bends, what a mould rounds off.

Each is one closed surface with outward faces, as an artist would model it; unlike those of
solids.py it need not be convex (a pot's wall and floor are one surface, as in real meshes).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from ...articulation import rotation_about
from ...mesh import FloatArray, IntArray, Material, Mesh
from .solids import Span


def loft(rings: npt.ArrayLike, material: Material, looped: bool = False) -> Mesh:
    """A skin over rings of equally many corners, closed by a fan over the first and the last ring.

    Args:
        rings: corners [m], shape [ring_count, corner_count, 3]; first and last ring flat and
            convex.
        material: its look.
        looped: the last ring is joined to the first one instead of closing both.

    Returns:
        A closed mesh with outward faces, whichever way round the rings are given.
    """
    corners = np.asarray(rings, dtype=np.float64)
    vertices = corners.reshape(-1, 3)
    faces = _skin(corners.shape[0], corners.shape[1], looped)
    if np.linalg.det(vertices[faces]).sum() < 0.0:
        faces = faces[:, ::-1]
    return Mesh(vertices, faces, None, None, np.zeros(len(faces), dtype=np.int64), (material,))


@lru_cache(maxsize=256)
def _skin(ring_count: int, corner_count: int, looped: bool) -> IntArray:
    i = np.arange(corner_count)
    j = (i + 1) % corner_count
    faces = []
    for ring in range(ring_count if looped else ring_count - 1):
        low, high = ring * corner_count, (ring + 1) % ring_count * corner_count
        faces += [
            np.stack([low + i, low + j, high + j], axis=1),
            np.stack([low + i, high + j, high + i], axis=1),
        ]
    if not looped:
        k = np.arange(1, corner_count - 1)
        last = (ring_count - 1) * corner_count
        faces += [np.stack([0 * k, k + 1, k], axis=1), last + np.stack([0 * k, k, k + 1], axis=1)]
    return np.concatenate(faces)


def swept(axis: int, outline: npt.ArrayLike, heights: npt.ArrayLike) -> FloatArray:
    """Rings for :func:`loft`: outlines in the plane of the two axes that follow ``axis`` in cyclic order.

    Args:
        axis: 0, 1 or 2.
        outline: shape [corner_count, 2] for all rings, or [ring_count, corner_count, 2] [m].
        heights: of the rings along ``axis`` [m], shape [ring_count].

    Returns:
        Corners [m], shape [ring_count, corner_count, 3].
    """
    levels = np.asarray(heights, dtype=np.float64)
    flat = np.asarray(outline, dtype=np.float64)
    rings = np.empty((len(levels), flat.shape[-2], 3))
    rings[..., (axis + 1) % 3] = flat[..., 0]
    rings[..., (axis + 2) % 3] = flat[..., 1]
    rings[..., axis] = levels[:, None]
    return rings


def lathe(
    axis: int,
    center: npt.ArrayLike,
    profile: Sequence[tuple[float, float]],
    material: Material,
    sides: int = 24,
    stretch: tuple[float, float] = (1.0, 1.0),
    looped: bool = False,
) -> Mesh:
    """A solid of revolution.

    Args:
        axis: 0, 1 or 2.
        center: a point [m] on the turning axis; heights count from it.
        profile: radius and height of each ring [m], radii above 0. Up the outside and down the
            inside, a vessel comes out; the first and the last ring are closed.
        material: its look.
        sides: corners of each ring.
        stretch: factors on the two axes that follow ``axis`` in cyclic order.
        looped: close the profile on itself instead, for a ring.
    """
    radius, height = np.asarray(profile, dtype=np.float64).T
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    circle = np.stack([stretch[0] * np.cos(angle), stretch[1] * np.sin(angle)], axis=1)
    return loft(
        swept(axis, radius[:, None, None] * circle, height) + np.asarray(center), material, looped
    )


def pipe(
    path: npt.ArrayLike,
    radius: npt.ArrayLike,
    material: Material,
    sides: int = 10,
    looped: bool = False,
    up: tuple[float, float, float] = (0.0, 0.0, 1.0),
    flat: float = 1.0,
) -> Mesh:
    """A round or flattened bar along a path.

    Args:
        path: its middle line [m], shape [point_count, 3]; never along ``up``.
        radius: one, or one per point of the path [m].
        material: its look.
        sides: corners of each ring; 4 makes a square bar.
        looped: the end of the path is joined to its start.
        up: unit vector; the section's second direction leans towards it.
        flat: how high the section is, as a share of how wide.
    """
    points = np.asarray(path, dtype=np.float64)
    ahead = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    if not looped:
        ahead[0], ahead[-1] = points[1] - points[0], points[-1] - points[-2]
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    side = _cross(ahead, np.asarray(up, dtype=np.float64))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    above = _cross(side, ahead)
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    # Half a step makes a square of four corners upright.
    across = side[:, None] * np.cos(angle)[:, None] + flat * above[:, None] * np.sin(angle)[:, None]
    reach = np.broadcast_to(np.asarray(radius, dtype=np.float64), len(points))
    return loft(points[:, None] + reach[:, None, None] * across, material, looped)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """What numpy's own does, for rows of three, in a fifth of the time."""
    return np.asarray(a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]])


def ribbon(
    axis: int,
    left: npt.ArrayLike,
    right: npt.ArrayLike,
    span: Span,
    material: Material,
    looped: bool = False,
) -> Mesh:
    """A plate of any outline: what lies between two lines, swept along an axis.

    Args:
        axis: 0, 1 or 2; lines lie in the plane of the next two axes in cyclic order.
        left: one edge [m], shape [point_count, 2].
        right: the other edge, point by point across from ``left``.
        span: thickness, from where to where along ``axis`` [m].
        material: its look.
        looped: the lines are closed ones, for a frame around a hole.
    """
    a, b = np.asarray(left, dtype=np.float64), np.asarray(right, dtype=np.float64)
    corners = np.empty((len(a), 4, 3))
    for i, (line, height) in enumerate(((a, span[0]), (b, span[0]), (b, span[1]), (a, span[1]))):
        corners[:, i, (axis + 1) % 3], corners[:, i, (axis + 2) % 3], corners[:, i, axis] = (
            *line.T,
            height,
        )
    return loft(corners, material, looped)


def arc(
    center: tuple[float, float], radius: float, start: float, stop: float, count: int
) -> FloatArray:
    """Points on a circle [m], shape [count, 2], from one angle to another [rad], both included."""
    angle = np.linspace(start, stop, count)
    return np.stack(
        [center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)], axis=1
    )


def rounded(x: Span, y: Span, radius: float, steps: int = 4) -> FloatArray:
    """A rectangle with rounded corners, counter-clockwise [m], shape [4 steps, 2]."""
    r = min(radius, 0.499 * (x[1] - x[0]), 0.499 * (y[1] - y[0]))
    centers = (
        (x[1] - r, y[1] - r),
        (x[0] + r, y[1] - r),
        (x[0] + r, y[0] + r),
        (x[1] - r, y[0] + r),
    )
    turns = [(i * np.pi / 2, (i + 1) * np.pi / 2) for i in range(4)]
    return np.concatenate(
        [arc(c, r, a, b, steps) for c, (a, b) in zip(centers, turns, strict=True)]
    )


def block(
    axis: int,
    x: Span,
    y: Span,
    span: Span,
    material: Material,
    radius: float,
    bevel: float = 0.0,
    taper: float = 1.0,
) -> Mesh:
    """A box with rounded upright edges.

    Args:
        axis: 0, 1 or 2: along which its rounded outline is swept.
        x: outer span along the next axis in cyclic order [m].
        y: outer span along the one after [m].
        span: outer span along ``axis`` [m].
        material: its look.
        radius: of the edges along ``axis`` [m].
        bevel: chamfer of the edges around both ends [m]; less than ``radius``.
        taper: size of the end at ``span[0]`` as a share of that at ``span[1]``.
    """
    middle = np.array([(x[0] + x[1]) / 2, (y[0] + y[1]) / 2])
    outline = rounded(x, y, radius) - middle
    inset = (
        rounded(
            (x[0] + bevel, x[1] - bevel), (y[0] + bevel, y[1] - bevel), max(radius - bevel, 1e-4)
        )
        - middle
    )
    if bevel > 0.0:
        outlines = [taper * inset, taper * outline, outline, inset]
        heights = [span[0], span[0] + bevel, span[1] - bevel, span[1]]
    else:
        outlines, heights = [taper * outline, outline], list(span)
    return loft(swept(axis, np.array(outlines) + middle, heights), material)


def ball(
    center: npt.ArrayLike, radius: float, material: Material, sides: int = 12, squash: float = 1.0
) -> Mesh:
    """A ball around ``center`` [m], ``squash`` times as high as wide, blunt at its poles."""
    angle = np.linspace(-0.46 * np.pi, 0.46 * np.pi, max(5, sides // 2))
    profile = [(radius * float(np.cos(a)), squash * radius * float(np.sin(a))) for a in angle]
    return lathe(2, center, profile, material, sides)


def turned(
    solids: Sequence[Mesh], axis: npt.ArrayLike, angle: float, origin: npt.ArrayLike
) -> list[Mesh]:
    """The solids turned by ``angle`` [rad] about a unit axis through ``origin`` [m]."""
    rotation = rotation_about(axis, angle)
    pivot = np.asarray(origin, dtype=np.float64)
    return [_carried(s, (s.vertices - pivot) @ rotation.T + pivot) for s in solids]


def shifted(solids: Sequence[Mesh], offset: npt.ArrayLike) -> list[Mesh]:
    """The solids moved by ``offset`` [m]."""
    return [_carried(s, s.vertices + np.asarray(offset)) for s in solids]


def _carried(solid: Mesh, vertices: FloatArray) -> Mesh:
    return Mesh(vertices, solid.faces, solid.corner_uv, None, solid.face_material, solid.materials)
