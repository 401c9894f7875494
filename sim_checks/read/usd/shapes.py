"""Surfaces of a USD stage as triangles in their body's frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...description import DescriptionError, FloatArray, IntArray
from ...geometry.placing import placed
from .. import primitives
from ..meshes import fan_polygons

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
        path: of the prim.
        body: path of the body that it is part of.
        seen, touched: whether it is shown, and whether it collides.
        vertices: body frame [m], shape [n, 3].
        faces: shape [m, 3].
    """

    path: str
    body: str
    seen: bool
    touched: bool
    vertices: FloatArray
    faces: IntArray

    @property
    def name(self) -> str:
        """Return the name of the prim."""
        return self.path.rpartition("/")[2]


def read_triangles(prim: Any, place: FloatArray) -> tuple[FloatArray, IntArray] | None:
    """Return a mesh, box, ball, cylinder or capsule as triangles; ``None`` for any other thing.

    Args:
        prim: a ``UsdGeom.Gprim``; of a prim that moves by time samples, its first shape is taken.
        place: of it in its body's frame, metres and scale included, shape [4, 4].

    Raises:
        DescriptionError: ``unreadable_mesh``, ``not_finite``.
    """
    from pxr import UsdGeom

    found = _mesh(UsdGeom.Mesh(prim)) if prim.IsA(UsdGeom.Mesh) else _primitive(prim)
    if found is None or not len(found[1]):
        return None
    vertices, faces = found
    if np.linalg.det(place[:3, :3]) < 0.0:
        faces = faces[:, [0, 2, 1]]
    return placed(vertices, place), faces


def _value(attribute: Any) -> Any:
    """Return a value as authored; of time samples, the first."""
    from pxr import Usd

    value = attribute.Get()
    return attribute.Get(Usd.TimeCode.EarliestTime()) if value is None else value


def _array(attribute: Any, dtype: type) -> Any:
    value = _value(attribute)
    return np.array(() if value is None else value, dtype=dtype)


def _mesh(mesh: Any) -> tuple[FloatArray, IntArray]:
    from pxr import UsdGeom

    points = _array(mesh.GetPointsAttr(), float).reshape(-1, 3)
    counts = _array(mesh.GetFaceVertexCountsAttr(), np.int64)
    corners = _array(mesh.GetFaceVertexIndicesAttr(), np.int64)
    where = f"mesh {mesh.GetPrim().GetName()!r}"
    if not (len(points) and len(counts) and len(corners)):
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    if counts.min() < 0 or counts.sum() != len(corners):
        message = f"{where}: its faces count {counts.sum()} corners and it has {len(corners)}"
        raise DescriptionError("unreadable_mesh", message)
    if not 0 <= corners.min() <= corners.max() < len(points):
        message = f"{where}: its faces name points outside the {len(points)} that it has"
        raise DescriptionError("unreadable_mesh", message)
    if not np.isfinite(points).all():
        raise DescriptionError("not_finite", f"{where}: a point is not finite")
    holes = _array(mesh.GetHoleIndicesAttr(), np.int64)
    solid = np.ones(len(counts), dtype=np.bool_)
    solid[holes[(holes >= 0) & (holes < len(counts))]] = False
    faces = corners[fan_polygons(counts)[np.repeat(solid, np.maximum(counts - 2, 0))]]
    if _value(mesh.GetOrientationAttr()) == UsdGeom.Tokens.leftHanded:
        faces = faces[:, [0, 2, 1]]
    return points, faces


def _primitive(prim: Any) -> tuple[FloatArray, IntArray] | None:
    from pxr import UsdGeom

    def number(attribute: Any) -> float:
        return float(_value(attribute))

    if prim.IsA(UsdGeom.Cube):
        return primitives.box(np.full(3, number(UsdGeom.Cube(prim).GetSizeAttr())))
    if prim.IsA(UsdGeom.Sphere):
        return primitives.ellipsoid(np.full(3, number(UsdGeom.Sphere(prim).GetRadiusAttr())))
    round_ones = {UsdGeom.Cylinder: primitives.cylinder, UsdGeom.Capsule: primitives.capsule}
    for schema, make in round_ones.items():
        if prim.IsA(schema):
            shape = schema(prim)
            vertices, faces = make(number(shape.GetRadiusAttr()), number(shape.GetHeightAttr()))
            return vertices @ ALONG[str(_value(shape.GetAxisAttr()))].T, faces
    return None
