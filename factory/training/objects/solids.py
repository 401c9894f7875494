"""Closed convex solids: everything an object is built of."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray, Material, Mesh

#: Lower and upper end along one axis [m].
Span = tuple[float, float]

#: A texture repeats after this length [m].
TEXTURE_PERIOD_M = 0.5


def prism(axis: int, profile: npt.ArrayLike, span: Span, material: Material) -> Mesh:
    """A convex profile swept along a coordinate axis.

    Args:
        axis: 0, 1 or 2; the profile's plane is spanned by the next two axes in cyclic order.
        profile: convex, counter-clockwise seen from ``+axis`` [m], shape [corner_count, 2].
        span: where the sweep starts and ends along ``axis`` [m].
        material: its look; with a texture, texture coordinates are laid over each face to scale.

    Returns:
        A closed mesh with outward faces; the caps are fans without a vertex in their middle.
    """
    outline = np.asarray(profile, dtype=np.float64)
    count = len(outline)
    vertices = np.zeros((2 * count, 3))
    vertices[:, (axis + 1) % 3] = np.tile(outline[:, 0], 2)
    vertices[:, (axis + 2) % 3] = np.tile(outline[:, 1], 2)
    vertices[:count, axis], vertices[count:, axis] = span
    faces = [(0, i + 1, i) for i in range(1, count - 1)]
    faces += [(count, count + i, count + i + 1) for i in range(1, count - 1)]
    for i in range(count):
        j = (i + 1) % count
        faces += [(i, j, count + j), (i, count + j, count + i)]
    triangles = np.array(faces, dtype=np.int64)
    return Mesh(
        vertices=vertices,
        faces=triangles,
        corner_uv=None if material.texture is None else _laid_over(vertices[triangles]),
        corner_normals=None,
        face_material=np.zeros(len(triangles), dtype=np.int64),
        materials=(material,),
    )


def box(x: Span, y: Span, z: Span, material: Material) -> Mesh:
    """An axis-aligned box given by its spans [m]."""
    return prism(2, [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])], z, material)


def cylinder(
    axis: int,
    center: tuple[float, float],
    radius: float,
    span: Span,
    material: Material,
    sides: int = 20,
) -> Mesh:
    """A cylinder along a coordinate axis; ``center`` in the next two axes in cyclic order [m]."""
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    circle = np.stack(
        [center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)], axis=1
    )
    return prism(axis, circle, span, material)


def _laid_over(corners: FloatArray) -> FloatArray:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    dominant = np.abs(normal).argmax(axis=1)
    # The grain runs along u: along z on upright faces, along x on lying ones.
    across = np.array([[2, 1], [2, 0], [0, 1]])[dominant]
    rows = np.arange(len(corners))[:, None]
    u, v = corners[rows, [[0, 1, 2]], across[:, :1]], corners[rows, [[0, 1, 2]], across[:, 1:]]
    return np.asarray(np.stack([u, v], axis=-1) / TEXTURE_PERIOD_M)
