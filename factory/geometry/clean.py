"""From a triangle soup to a mesh: bad faces dropped and counted, vertices welded by position."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import InputRejected
from ..mesh import BoolArray, FloatArray, IntArray, Mesh
from .rows import number_by_appearance, weld_points
from .soup import Soup

WELD_FRACTION = 1e-8
"""Share of the diagonal within which vertices are one, and up to which a face has no area."""

_LARGEST_COORDINATE = 1e30
_SMALLEST_DIAGONAL = 1e-30


@dataclass(frozen=True)
class Cleaned:
    """A mesh without unusable faces.

    Attributes:
        mesh: input units and frame.
        source_faces: index of each face in the soup, ascending, shape [face_count].
        dropped_degenerate, dropped_non_finite: how many faces are missing, by reason.
    """

    mesh: Mesh
    source_faces: IntArray
    dropped_degenerate: int
    dropped_non_finite: int


def clean(soup: Soup, name: str) -> Cleaned:
    """Weld ``soup`` and drop faces that are not finite or have no area.

    Raises:
        InputRejected: ``empty`` (no faces), ``not_finite`` (no finite face), ``zero_size`` (no face
            with an area, or the whole is a point or a line).
    """
    if not len(soup.corners):
        raise InputRejected(
            "empty", f"{name}: has no triangles, want a surface mesh", value=0.0, unit="faces"
        )
    usable = _is_finite(soup.corners)
    if not usable.any():
        raise InputRejected(
            "not_finite",
            f"{name}: none of its {len(usable)} faces has three finite corners",
            value=float(len(usable)),
            unit="faces",
        )
    kept = np.flatnonzero(usable)
    points = soup.corners[kept].reshape(-1, 3)
    diagonal = _diagonal(points, name)
    welded = weld_points(points, points.min(axis=0), WELD_FRACTION * diagonal)
    first, faces = number_by_appearance(*welded)
    vertices = points[first]
    faces = faces.reshape(-1, 3)
    solid = _has_area(vertices, faces, WELD_FRACTION * diagonal)
    if not solid.any():
        raise InputRejected(
            "zero_size", f"{name}: none of its {len(solid)} faces has an area", value=0.0, unit="m2"
        )
    source = kept[solid]
    return Cleaned(
        mesh=_assemble(soup, vertices, faces[solid], source),
        source_faces=source,
        dropped_degenerate=int((~solid).sum()),
        dropped_non_finite=int((~usable).sum()),
    )


def _is_finite(corners: FloatArray) -> BoolArray:
    # A comparison with NaN is false, so this finds NaN, infinity and what overflows when squared.
    return np.asarray((np.abs(corners) < _LARGEST_COORDINATE).all(axis=(1, 2)))


def _diagonal(points: FloatArray, name: str) -> float:
    extents = points.max(axis=0) - points.min(axis=0)
    longest = float(extents.max())
    flat = int((extents <= WELD_FRACTION * longest).sum())
    if longest < _SMALLEST_DIAGONAL or flat > 1:
        raise InputRejected(
            "zero_size",
            f"{name}: measures {extents[0]:.3g} x {extents[1]:.3g} x {extents[2]:.3g}, "
            "a point or a line, no surface",
            value=longest,
        )
    return float(np.linalg.norm(extents))


def _has_area(vertices: FloatArray, faces: IntArray, tolerance: float) -> BoolArray:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.sqrt(np.maximum(np.maximum(_square(b - a), _square(c - b)), _square(a - c)))
    return np.asarray(double_area > tolerance * longest)


def _square(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", vectors, vectors))


def _assemble(soup: Soup, vertices: FloatArray, faces: IntArray, source: IntArray) -> Mesh:
    used, compact = np.unique(faces, return_inverse=True)
    materials, face_material = np.unique(soup.face_material[source], return_inverse=True)
    return Mesh(
        vertices=vertices[used],
        faces=compact.reshape(-1, 3),
        corner_uv=_finite_rows(None if soup.uv is None else soup.uv[source]),
        corner_normals=_unit_rows(None if soup.normals is None else soup.normals[source]),
        face_material=face_material.reshape(-1),
        materials=tuple(soup.materials[i] for i in materials),
    )


def _finite_rows(values: FloatArray | None) -> FloatArray | None:
    """Make rows with a number that is not finite NaN altogether; ``None`` if no row is left."""
    if values is None:
        return None
    good = np.asarray(np.isfinite(values)).all(axis=-1, keepdims=True)
    return np.where(good, values, np.nan) if good.any() else None


def _unit_rows(values: FloatArray | None) -> FloatArray | None:
    if values is None:
        return None
    finite = np.where(np.isfinite(values) & (np.abs(values) < _LARGEST_COORDINATE), values, 0.0)
    length = np.linalg.norm(finite, axis=-1, keepdims=True)
    good = length > _SMALLEST_DIAGONAL
    if not good.any():
        return None
    return np.where(good, finite / np.where(good, length, 1.0), np.nan)
