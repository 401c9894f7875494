"""Closed surfaces with outward faces: boxes, prisms, what a lathe turns and a pipe bender bends.

Units and the order of coordinates are those of :mod:`.spans`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.mesh import FloatArray, IntArray, cross

from .axes import Point, Y, Z
from .outlines import circle, raised, rounded
from .spans import Flat, Span, mid, within

#: The two axes across each axis.
_PLANE = ((1, 2), (0, 2), (0, 1))
#: Corners of a box, which end of each span; and its outward faces.
_CORNERS: IntArray = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)
_BOX_FACES: IntArray = np.array([
    (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
    (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7),
])  # fmt: skip
_XYZ = np.arange(3)


class Form(NamedTuple):
    """A closed surface of vertices [m], shape [n, 3], and outward faces, shape [m, 3]."""

    vertices: FloatArray
    faces: IntArray

    def moved(self, motion: FloatArray) -> Form:
        """Carry the form along by a rigid motion, shape [4, 4]."""
        return Form(self.vertices @ motion[:3, :3].T + motion[:3, 3], self.faces)

    def shifted(self, offset: npt.ArrayLike) -> Form:
        """Move the form by ``offset`` [m], shape [3]."""
        return Form(self.vertices + np.asarray(offset), self.faces)

    def turned(self, axis: npt.ArrayLike, angle: float, origin: Point = (0.0, 0.0, 0.0)) -> Form:
        """Turn the form by ``angle`` [rad] about a unit axis through ``origin`` [m]."""
        rotation = rotation_about(axis, angle)
        return Form((self.vertices - np.array(origin)) @ rotation.T + np.array(origin), self.faces)

    def mirrored(self) -> Form:
        """Mirror the form left for right: x negated."""
        return Form(self.vertices * (-1.0, 1.0, 1.0), self.faces[:, ::-1])


def both(*forms: Form) -> list[Form]:
    """Return forms and their mirror images, left for right."""
    return [*forms, *(form.mirrored() for form in forms)]


def box(x: Span, y: Span, z: Span) -> Form:
    """Return an axis-aligned box."""
    return Form(np.array((x, y, z))[_XYZ, _CORNERS], _BOX_FACES)


def loft(rings: npt.ArrayLike, looped: bool = False) -> Form:
    """Build a surface over rings of equally many corners, closed by a fan at either end.

    Rings have shape [ring_count, corner_count, 3] [m], the first and the last one flat and convex;
    ``looped``, the last is joined to the first. Faces look outwards, whichever way rings go.
    """
    corners = np.asarray(rings, dtype=np.float64)
    vertices = corners.reshape(-1, 3)
    faces = _skin(corners.shape[0], corners.shape[1], looped, False)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = vertices[faces].transpose(1, 2, 0)
    volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    if volume.sum() < 0.0:
        faces = _skin(corners.shape[0], corners.shape[1], looped, True)
    return Form(vertices, faces)


@lru_cache(maxsize=512)
def _skin(rings: int, corners: int, looped: bool, flipped: bool) -> IntArray:
    """Return two triangles between neighbouring corners of neighbouring rings, and two fans."""
    i = np.arange(corners)
    j = (i + 1) % corners
    low = np.arange(rings if looped else rings - 1)[:, None] * corners
    high = (low + corners) % (rings * corners)
    sides = np.stack([low + i, low + j, high + j, low + i, high + j, high + i], axis=-1)
    faces = [sides.reshape(-1, 3)]
    if not looped:
        k = np.arange(1, corners - 1)
        last = (rings - 1) * corners
        faces += [np.stack([0 * k, k + 1, k], axis=1), last + np.stack([0 * k, k, k + 1], axis=1)]
    joined = np.concatenate(faces)
    return joined[:, ::-1] if flipped else joined


def stack(sections: Sequence[tuple[npt.ArrayLike, float]], axis: int = Z) -> Form:
    """Return a skin over outlines, shape [corner_count, 2], each with its height along an axis."""
    return loft([raised(outline, height, axis) for outline, height in sections])


def prism(outline: npt.ArrayLike, along: Span, axis: int = Z) -> Form:
    """Return a convex outline, shape [corner_count, 2], swept along an axis."""
    return stack([(outline, along[0]), (outline, along[1])], axis)


def frustum(lower: tuple[Span, Span], upper: tuple[Span, Span], along: Span, axis: int = Z) -> Form:
    """Return a form along an axis whose two ends are rectangles, each given by its spans."""
    ends = [[(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])] for u, v in (lower, upper)]
    return stack([(ends[0], along[0]), (ends[1], along[1])], axis)


def lathe(
    profile: npt.ArrayLike,
    at: Point = (0.0, 0.0, 0.0),
    axis: int = Z,
    sides: int = 24,
    looped: bool = False,
    stretch: Flat = (1.0, 1.0),
) -> Form:
    """Return a solid of revolution.

    Args:
        profile: radius and height of each ring, shape [ring_count, 2], radii above 0. Up the
            outside and down the inside, a vessel comes out; the first and the last ring are closed.
        at: a point on the turning axis; heights count from it.
        axis: along which heights run.
        sides: corners of each ring.
        looped: close the profile on itself instead, for a ring.
        stretch: factors on the two axes across.
    """
    points = np.asarray(profile, dtype=np.float64)
    radius, height = points.T
    first, second = _PLANE[axis]
    cosine, sine = circle(sides)
    vertices = np.empty((len(points), sides, 3))
    vertices[..., first] = at[first] + radius[:, None] * (stretch[0] * cosine)
    vertices[..., second] = at[second] + radius[:, None] * (stretch[1] * sine)
    vertices[..., axis] = at[axis] + height[:, None]
    line = points.tolist()
    steps = pairwise([*line, line[0]] if looped else line)
    volume = sum((r * r + r * s + s * s) * (v - u) for (r, u), (s, v) in steps)
    # Across y, x and z in this order are a left-handed pair.
    flipped = (volume < 0.0) != (axis == Y)
    return Form(vertices.reshape(-1, 3), _skin(len(points), sides, looped, flipped))


def cylinder(axis: int, center: Flat, radius: float, along: Span, sides: int = 16) -> Form:
    """Return a cylinder along a coordinate axis; ``center`` lies in the plane across it."""
    at = (*center[:axis], 0.0, *center[axis:])
    return lathe([(radius, along[0]), (radius, along[1])], at, axis, sides)  # type: ignore[arg-type]


def hoop(axis: int, center: Flat, radii: Span, along: Span, sides: int = 24) -> Form:
    """Return a flat ring about a coordinate axis, between two radii; else as :func:`cylinder`."""
    at = (*center[:axis], 0.0, *center[axis:])
    inner, outer = ([(radius, end) for end in along] for radius in radii)
    profile = [inner[0], *outer, inner[1]]
    return lathe(profile, at, axis, sides, looped=True)  # type: ignore[arg-type]


def ball(center: Point, radius: float, sides: int = 12) -> Form:
    """Return a ball, blunt at its poles."""
    angle = np.linspace(-0.46 * np.pi, 0.46 * np.pi, max(5, sides // 2))
    profile = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1).tolist()
    return lathe(profile, center, Z, sides)


def pipe(
    path: npt.ArrayLike,
    radius: npt.ArrayLike,
    sides: int = 10,
    looped: bool = False,
    up: Point | None = None,
    flat: float = 1.0,
) -> Form:
    """Return a round or flattened bar along a path.

    Args:
        path: its middle line, shape [point_count, 3].
        radius: one, or one per point of the path.
        sides: corners of each ring; 4 makes a square bar.
        looped: the end of the path is joined to its start.
        up: the section's second direction leans towards it; by default, across the path's plane.
        flat: how high the section is in that direction, as a share of how wide.
    """
    points = np.asarray(path, dtype=np.float64)
    ahead = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    if not looped:
        ahead[0] = points[1] - points[0]
        ahead[-1] = points[-1] - points[-2]
    ahead /= np.sqrt(np.square(ahead).sum(axis=1, keepdims=True))
    lean = _across(ahead) if up is None else np.asarray(up, dtype=np.float64)
    side = cross(ahead, lean)
    side /= np.sqrt(np.square(side).sum(axis=1, keepdims=True))
    above = cross(side, ahead)
    cosine, sine = circle(sides)
    reach = np.broadcast_to(np.asarray(radius, dtype=np.float64), len(points))[:, None, None]
    section = side[:, None] * cosine[:, None] + flat * above[:, None] * sine[:, None]
    rings = points[:, None] + reach * section
    return Form(rings.reshape(-1, 3), _skin(len(points), sides, looped, True))


def _across(ahead: FloatArray) -> FloatArray:
    """Return a direction that the path of these directions never takes, if it lies in one plane."""
    normal = cross(np.broadcast_to(ahead[0], ahead.shape), ahead)
    length = np.square(normal).sum(axis=1)
    widest = int(length.argmax())
    if length[widest] > 1e-6:
        return np.asarray(normal[widest])
    return np.array((0.0, 0.0, 1.0) if abs(ahead[0, 2]) < 0.9 else (1.0, 0.0, 0.0))


def ribbon(
    left: npt.ArrayLike, right: npt.ArrayLike, along: Span, axis: int = Z, looped: bool = False
) -> Form:
    """Return a plate of any outline: the area between two lines, swept along an axis.

    Lines, shape [point_count, 2], lie point by point across from each other; ``looped`` ones are
    closed, for a frame around a hole.
    """
    low, high = along
    edges = ((left, low), (right, low), (right, high), (left, high))
    return loft(np.stack([raised(line, at, axis) for line, at in edges], axis=1), looped)


def block(
    x: Span, y: Span, z: Span, radius: float, bevel: float = 0.0, axis: int = Z, taper: float = 1.0
) -> Form:
    """Return a box whose edges along an axis are rounded.

    Those around both ends are chamfered by ``bevel``, less than ``radius``; the lower end is
    ``taper`` times as large as the upper one.
    """
    spans = (x, y, z)
    low, high = spans[axis]
    u, v = (spans[k] for k in _PLANE[axis])
    outline = rounded(u, v, radius)
    center = (mid(u), mid(v))
    foot = (outline - center) * taper + center
    if bevel <= 0.0:
        return stack([(foot, low), (outline, high)], axis)
    inset = rounded(within(u, bevel), within(v, bevel), max(radius - bevel, 1e-4))
    small = (inset - center) * taper + center
    return stack([(small, low), (foot, low + bevel), (outline, high - bevel), (inset, high)], axis)
