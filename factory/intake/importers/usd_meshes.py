"""Surfaces of a USD stage as triangles, where the stage puts them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...errors import InputRejected
from ...geometry.clean import clean
from ...geometry.soup import plain_soup
from ...mesh import IntArray, Material, Mesh
from ..limits import unreadable
from . import primitives

PLAIN = Material("default")
_TO_AXIS = {"X": (2, 0, 1), "Y": (1, 2, 0), "Z": (0, 1, 2)}
"""From a shape along z to one along another axis: which of its coordinates becomes x, y and z."""


def mesh_of(prim: Any, cache: Any) -> Mesh | None:
    """A mesh or a primitive in the stage's frame, units, at its first time; ``None`` if unseen.

    Args:
        prim: of a type derived from ``UsdGeom.Gprim``.
        cache: a ``UsdGeom.XformCache``.

    Raises:
        InputRejected: ``unreadable``: points and faces do not fit.
    """
    from pxr import UsdGeom

    shape = _polygons(prim) if prim.IsA(UsdGeom.Mesh) else _primitive(prim)
    if shape is None or not len(shape.faces):
        return None
    matrix = np.array(cache.GetLocalToWorldTransform(prim), dtype=np.float64).T
    placed = shape.transformed(matrix)
    try:
        return clean(plain_soup(placed.vertices[placed.faces], material=PLAIN), prim.GetName()).mesh
    except InputRejected as error:
        if error.code in ("empty", "zero_size"):
            return None
        raise


def _value(attribute: Any) -> Any:
    """As authored; of what moves by time samples, the first."""
    from pxr import Usd

    value = attribute.Get()
    return attribute.Get(Usd.TimeCode.EarliestTime()) if value is None else value


def _polygons(prim: Any) -> Mesh | None:
    from pxr import UsdGeom

    mesh = UsdGeom.Mesh(prim)
    given = [
        _value(a)
        for a in (
            mesh.GetPointsAttr(),
            mesh.GetFaceVertexCountsAttr(),
            mesh.GetFaceVertexIndicesAttr(),
        )
    ]
    if any(value is None or not len(value) for value in given):
        return None
    points = np.array(given[0], dtype=np.float64).reshape(-1, 3)
    counts, indices = (np.array(value, dtype=np.int64).reshape(-1) for value in given[1:])
    where = f"mesh {prim.GetName()!r}"
    if counts.min() < 0 or counts.sum() != len(indices):
        raise unreadable(where, f"its faces count {counts.sum()} corners and it has {len(indices)}")
    if not 0 <= indices.min() <= indices.max() < len(points):
        raise unreadable(where, f"a corner is outside its {len(points)} points")
    if not np.isfinite(points).all():
        raise unreadable(where, "a point is not finite")
    holes = _value(mesh.GetHoleIndicesAttr())
    solid = np.ones(len(counts), dtype=np.bool_)
    if holes is not None and len(holes):
        listed = np.array(holes, dtype=np.int64)
        solid[listed[(listed >= 0) & (listed < len(counts))]] = False
    triangles = fanned(counts, indices, solid)
    if _value(mesh.GetOrientationAttr()) == UsdGeom.Tokens.leftHanded:
        triangles = triangles[:, [0, 2, 1]]
    return Mesh.from_triangles(points, triangles, PLAIN)


def fanned(counts: IntArray, corners: IntArray, wanted: np.ndarray) -> IntArray:
    """Return the polygons as triangles around their first corners, shape [triangle_count, 3].

    Args:
        counts: corners of each polygon, shape [polygon_count].
        corners: of all polygons in order, shape [sum of ``counts``].
        wanted: which polygons, shape [polygon_count].
    """
    each = np.where(wanted, np.maximum(counts - 2, 0), 0)
    polygon = np.repeat(np.arange(len(counts)), each)
    first = (np.cumsum(counts) - counts)[polygon]
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(each) - each, each)
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)


def _primitive(prim: Any) -> Mesh | None:
    """Boxes and round shapes by their own parameters; all other prims have no surface here."""
    from pxr import UsdGeom

    def number(attribute: Any) -> float:
        return float(_value(attribute))

    if prim.IsA(UsdGeom.Cube):
        return primitives.box([number(UsdGeom.Cube(prim).GetSizeAttr())] * 3, PLAIN)
    if prim.IsA(UsdGeom.Sphere):
        return primitives.ellipsoid([number(UsdGeom.Sphere(prim).GetRadiusAttr())] * 3, PLAIN)
    for kind, made in (
        (UsdGeom.Cylinder, primitives.cylinder),
        (UsdGeom.Capsule, primitives.capsule),
    ):
        if prim.IsA(kind):
            schema = kind(prim)
            shape = made(number(schema.GetRadiusAttr()), number(schema.GetHeightAttr()), PLAIN)
            order = _TO_AXIS[str(_value(schema.GetAxisAttr()))]
            return Mesh.from_triangles(shape.vertices[:, order], shape.faces, PLAIN)
    return None
