"""Surfaces of a USD stage as triangles in their body's frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...description import DescriptionError, FloatArray, IntArray
from .. import primitives

#: What turns a shape along z so that it lies along a USD axis, shape [3, 3] each.
ALONG = {
    "X": np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
    "Y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
    "Z": np.eye(3),
}


@dataclass(frozen=True)
class PhysicsSurface:
    """Triangles.

    Attributes:
        name: of the prim.
        vertices: body frame [m], shape [n, 3].
        faces: shape [m, 3].
    """

    name: str
    vertices: FloatArray
    faces: IntArray


def read_surface(prim: Any, place: FloatArray) -> PhysicsSurface | None:
    """Return a mesh, box, ball, cylinder or capsule as triangles; ``None`` for any other thing.

    Args:
        prim: a ``UsdGeom.Gprim``.
        place: of it in its body's frame, metres and scale included, shape [4, 4].

    Raises:
        DescriptionError: ``unreadable_mesh``.
    """
    from pxr import UsdGeom

    found = _mesh(UsdGeom.Mesh(prim)) if prim.IsA(UsdGeom.Mesh) else _primitive(prim)
    if found is None or not len(found[1]):
        return None
    vertices, faces = found
    return PhysicsSurface(str(prim.GetName()), vertices @ place[:3, :3].T + place[:3, 3], faces)


def _mesh(mesh: Any) -> tuple[FloatArray, IntArray]:
    points = np.array(mesh.GetPointsAttr().Get() or (), dtype=np.float64).reshape(-1, 3)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get() or (), dtype=np.int64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get() or (), dtype=np.int64)
    if (
        counts.sum() != len(corners)
        or (counts < 0).any()
        or (len(corners) and not 0 <= corners.min() <= corners.max() < len(points))
    ):
        raise DescriptionError(
            "unreadable_mesh",
            f"{mesh.GetPrim().GetName()}: its faces name points that it does not have",
        )
    # Fans: the first corner of each polygon with every two that follow one another.
    first = np.repeat(np.cumsum(counts) - counts, np.maximum(counts - 2, 0))
    ends = np.cumsum(np.maximum(counts - 2, 0))
    step = np.arange(len(first)) - np.repeat(
        ends - np.maximum(counts - 2, 0), np.maximum(counts - 2, 0)
    )
    faces = (
        np.column_stack([corners[first], corners[first + step + 1], corners[first + step + 2]])
        if len(first)
        else np.zeros((0, 3), dtype=np.int64)
    )
    return points, faces


def _primitive(prim: Any) -> tuple[FloatArray, IntArray] | None:
    from pxr import UsdGeom

    if prim.IsA(UsdGeom.Cube):
        return primitives.box(np.full(3, float(UsdGeom.Cube(prim).GetSizeAttr().Get())))
    if prim.IsA(UsdGeom.Sphere):
        return primitives.ellipsoid(np.full(3, float(UsdGeom.Sphere(prim).GetRadiusAttr().Get())))
    for schema, make in (
        (UsdGeom.Cylinder, primitives.cylinder),
        (UsdGeom.Capsule, primitives.capsule),
    ):
        if prim.IsA(schema):
            shape = schema(prim)
            vertices, faces = make(
                float(shape.GetRadiusAttr().Get()), float(shape.GetHeightAttr().Get())
            )
            return vertices @ ALONG[str(shape.GetAxisAttr().Get())].T, faces
    return None
