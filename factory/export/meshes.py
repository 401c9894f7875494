"""Deterministic OBJ and MTL text for visual pieces and collision hulls."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..asset import Hull
from ..geometry.rows import distinct_rows
from ..geometry.triangles import doubled_normals
from ..mesh import FloatArray, IntArray, Material, Mesh
from .text import DECIMALS_UNIT, number, vector, vectors

#: MuJoCo refuses meshes of fewer vertices, even those that nothing collides with.
FEWEST_VERTICES = 4


def hull_obj(hull: Hull, origin: FloatArray) -> str:
    """Return a convex piece as OBJ, in a link frame at ``origin`` [m] in the object frame."""
    return _lines([*vectors("v", hull.vertices - origin), *_faces(hull.faces, None, None)])


def visual_obj(mesh: Mesh, origin: FloatArray, material: str) -> str:
    """Return a mesh of one material as OBJ, with its texture coordinates and normals.

    Args:
        mesh: in the object frame at rest [m].
        origin: the link frame's origin [m], object frame, shape [3].
        material: its name, in an MTL of that name beside the OBJ.
    """
    vertices = mesh.vertices - origin
    if 0 < len(vertices) < FEWEST_VERTICES:
        more = np.repeat(vertices[:1], FEWEST_VERTICES - len(vertices), axis=0)
        vertices = np.concatenate([vertices, more])
    uv, uv_index = _corner_table(mesh.corner_uv, np.zeros(2))
    normals, normal_index = _corner_table(filled_normals(mesh), np.zeros(3))
    rows = [*vectors("v", vertices), *vectors("vt", uv, DECIMALS_UNIT)]
    rows += vectors("vn", normals, DECIMALS_UNIT)
    faces = _faces(mesh.faces, uv_index, normal_index)
    return _lines([f"mtllib {material}.mtl", *rows, f"usemtl {material}", *faces])


def material_mtl(material: Material, name: str, texture: str | None) -> str:
    """Return one material as MTL; ``texture`` is an image file beside it."""
    red, green, blue, alpha = material.color
    lines = [
        f"newmtl {name}",
        f"Kd {vector((red, green, blue), DECIMALS_UNIT)}",
        "Ks 0 0 0",
        f"d {number(alpha, DECIMALS_UNIT)}",
        "illum 1",
    ]
    if texture is not None:
        lines.append(f"map_Kd {texture}")
    return _lines(lines)


def _lines(lines: list[str]) -> str:
    return "\n".join(lines) + "\n"


def _corner_table(
    corners: FloatArray | None, missing: FloatArray
) -> tuple[FloatArray, IntArray | None]:
    """Return distinct rounded corner values, sorted, and each corner's index, [face_count, 3]."""
    if corners is None or not np.isfinite(corners).any():
        return np.zeros((0, len(missing))), None
    complete = np.where(np.isfinite(corners).all(axis=-1, keepdims=True), corners, missing)
    flat = np.round(complete.reshape(-1, complete.shape[-1]), DECIMALS_UNIT) + 0.0
    first, index = distinct_rows(flat)
    return np.asarray(flat[first]), index.reshape(-1, 3)


def filled_normals(mesh: Mesh) -> FloatArray:
    """Return corner normals; where the input had none the face's own, so edges stay sharp there."""
    corners = mesh.vertices[mesh.faces]
    cross = doubled_normals(corners)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    unit = np.where(length > 0.0, cross / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0])
    flat = np.broadcast_to(unit[:, None, :], (len(mesh.faces), 3, 3))
    if mesh.corner_normals is None:
        return flat
    given = np.isfinite(mesh.corner_normals).all(axis=-1, keepdims=True)
    return np.where(given, mesh.corner_normals, flat)


def _faces(faces: IntArray, uv: IntArray | None, normals: IntArray | None) -> list[str]:
    columns: list[npt.NDArray[np.int64]] = [faces + 1]
    columns += [index + 1 for index in (uv, normals) if index is not None]
    pattern = "/".join(["{}"] * len(columns)) if uv is not None or normals is None else "{}//{}"
    line = " ".join(["f", pattern, pattern, pattern])
    rows = np.stack(columns, axis=-1).reshape(len(faces), -1).tolist()
    return [line.format(*row) for row in rows]
