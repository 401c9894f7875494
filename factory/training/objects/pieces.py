"""Closed pieces, cheap to make by the hundred: blocks are six numbers until the whole mesh is built."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray, IntArray, Material
from .solids import Span


class Block(NamedTuple):
    """An axis-aligned box.

    Attributes:
        x, y, z: spans [m].
        material: its look.
    """

    x: Span
    y: Span
    z: Span
    material: Material


class Form(NamedTuple):
    """Any closed surface with outward faces.

    Attributes:
        vertices: corners [m], shape [vertex_count, 3].
        faces: vertex indices, shape [face_count, 3].
        material: its look.
    """

    vertices: FloatArray
    faces: IntArray
    material: Material


Piece = Block | Form


@cache
def _circle(sides: int) -> FloatArray:
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


@cache
def _ring_faces(rings: int, sides: int, closed: bool) -> IntArray:
    """Quads between consecutive rings, and fans over the first and the last unless the rings close."""
    low = np.arange(rings if closed else rings - 1)[:, None] * sides
    high = (low + sides) % (rings * sides)
    i = np.arange(sides)
    j = (i + 1) % sides
    sheet = np.stack([low + i, low + j, high + j, low + i, high + j, high + i], axis=-1).reshape(
        -1, 3
    )
    if closed:
        return sheet
    fan = np.stack(
        [np.zeros(sides - 2, dtype=np.int64), np.arange(2, sides), np.arange(1, sides - 1)], axis=1
    )
    last = (rings - 1) * sides + fan[:, ::-1]
    return np.concatenate([sheet, fan, last])


def turned(
    axis: int,
    center: tuple[float, float],
    profile: Sequence[tuple[float, float]],
    material: Material,
    sides: int = 16,
) -> Form:
    """A profile turned about a coordinate axis, as on a lathe.

    Args:
        axis: 0, 1 or 2.
        center: of the axis in the next two axes in cyclic order [m].
        profile: ``(along, radius)`` pairs [m], ``along`` never falling; radii above zero. The ends
            are capped.
        material: its look.
        sides: of every ring.
    """
    along, radius = np.array(profile).T
    vertices = np.empty((len(along), sides, 3))
    vertices[..., axis] = along[:, None]
    circle = _circle(sides)
    for k in (0, 1):
        vertices[..., (axis + 1 + k) % 3] = center[k] + radius[:, None] * circle[:, k]
    return Form(vertices.reshape(-1, 3), _ring_faces(len(along), sides, False), material)


def rod(
    axis: int,
    center: tuple[float, float],
    radius: float,
    span: Span,
    material: Material,
    sides: int = 12,
) -> Form:
    """A cylinder along a coordinate axis; arguments as in :func:`turned`."""
    return turned(axis, center, ((span[0], radius), (span[1], radius)), material, sides)


def hoop(
    axis: int,
    center: tuple[float, float],
    radii: Span,
    span: Span,
    material: Material,
    sides: int = 24,
) -> Form:
    """A flat ring about a coordinate axis, between two radii [m]; other arguments as in :func:`turned`."""
    inner, outer = radii
    loop = np.array([(span[0], inner), (span[0], outer), (span[1], outer), (span[1], inner)])
    vertices = np.empty((4, sides, 3))
    vertices[..., axis] = loop[:, :1]
    circle = _circle(sides)
    for k in (0, 1):
        vertices[..., (axis + 1 + k) % 3] = center[k] + loop[:, 1:] * circle[:, k]
    return Form(vertices.reshape(-1, 3), _ring_faces(4, sides, True), material)


def pipe(path: npt.ArrayLike, radius: float, material: Material, sides: int = 8) -> Form:
    """A round bar along a polyline without sharp bends.

    Args:
        path: points [m], shape [point_count, 3].
        radius: of the bar [m].
        material: its look.
        sides: of its cross-section.
    """
    points = np.asarray(path, dtype=np.float64)
    tangent = np.gradient(points, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    # Handles are flat curves: one fixed normal to their plane keeps the rings from twisting.
    plane = np.cross(tangent[0], tangent[len(tangent) // 2])
    if np.linalg.norm(plane) < 1e-9:
        plane = np.cross(
            tangent[0], [0.0, 0.0, 1.0] if abs(tangent[0, 2]) < 0.9 else [1.0, 0.0, 0.0]
        )
    plane /= np.linalg.norm(plane)
    side = np.cross(plane, tangent)
    circle = radius * _circle(sides)
    vertices = points[:, None] + circle[:, :1] * side[:, None] + circle[:, 1:] * plane
    # The circle runs from `side` to `plane`; with `tangent` they are left-handed, so faces are
    # reversed.
    faces = _ring_faces(len(points), sides, False)
    return Form(
        vertices.reshape(-1, 3),
        faces if _is_outward(side[0], plane, tangent[0]) else faces[:, ::-1],
        material,
    )


def _is_outward(first: FloatArray, second: FloatArray, along: FloatArray) -> bool:
    return bool(np.cross(first, second) @ along > 0)


def extruded(axis: int, profile: npt.ArrayLike, span: Span, material: Material) -> Form:
    """A convex profile, counter-clockwise seen from ``+axis``, swept along a coordinate axis.

    Args:
        axis: 0, 1 or 2; the profile lies in the next two axes in cyclic order.
        profile: [m], shape [corner_count, 2].
        span: along the axis [m].
        material: its look.
    """
    outline = np.asarray(profile, dtype=np.float64)
    vertices = np.empty((2, len(outline), 3))
    vertices[0, :, axis], vertices[1, :, axis] = span
    vertices[..., (axis + 1) % 3] = outline[:, 0]
    vertices[..., (axis + 2) % 3] = outline[:, 1]
    return Form(vertices.reshape(-1, 3), _ring_faces(2, len(outline), False), material)


def frustum(
    axis: int, lower: tuple[Span, Span], upper: tuple[Span, Span], span: Span, material: Material
) -> Form:
    """A four-sided solid whose two ends are rectangles.

    Args:
        axis: 0, 1 or 2; the rectangles lie in the next two axes in cyclic order.
        lower: spans of the rectangle at ``span[0]`` [m].
        upper: spans of the rectangle at ``span[1]`` [m].
        span: along the axis [m].
        material: its look.
    """
    vertices = np.empty((2, 4, 3))
    for k, (u, v) in enumerate((lower, upper)):
        vertices[k, :, axis] = span[k]
        vertices[k, :, (axis + 1) % 3] = (u[0], u[1], u[1], u[0])
        vertices[k, :, (axis + 2) % 3] = (v[0], v[0], v[1], v[1])
    return Form(vertices.reshape(-1, 3), _ring_faces(2, 4, False), material)


def holed(
    x: Span, z: Span, center: tuple[float, float], radius: float, y: Span, material: Material
) -> Form:
    """An upright plate with a round hole.

    Args:
        x: of the plate [m].
        z: of the plate [m].
        center: of the hole, x and z [m].
        radius: of the hole [m].
        y: front and back of the plate [m].
        material: its look.
    """
    corners = np.array([(x[i], z[k]) for i in (0, 1) for k in (0, 1)]) - center
    angle = np.sort(
        np.concatenate(
            [np.arctan2(corners[:, 1], corners[:, 0]), np.linspace(-np.pi, np.pi, 33)[:-1] + 0.05]
        )
    )
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    with np.errstate(divide="ignore"):
        ends = np.where(
            way > 0,
            (np.array([x[1], z[1]]) - center) / way,
            (np.array([x[0], z[0]]) - center) / way,
        )
    rim, edge = center + radius * way, center + ends.min(axis=1)[:, None] * way
    vertices = np.empty((4, len(angle), 3))
    for k, (ring, depth) in enumerate(((rim, y[0]), (edge, y[0]), (edge, y[1]), (rim, y[1]))):
        vertices[k, :, 0], vertices[k, :, 1], vertices[k, :, 2] = ring[:, 0], depth, ring[:, 1]
    return Form(vertices.reshape(-1, 3), _ring_faces(4, len(angle), True)[:, ::-1], material)
