"""Mesh files as plain triangles."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..description import DescriptionError, FloatArray, IntArray
from .document import refuse_doctype

MESH_SUFFIXES = (".obj", ".stl", ".dae", ".glb", ".ply", ".off")
MAX_MESH_BYTES = 512 * 2**20


def read_mesh(path: Path) -> tuple[FloatArray, IntArray]:
    """Return all triangles of a mesh file, scene transforms applied.

    Returns:
        vertices [m or whatever the file has], shape [vertex_count, 3]; faces, shape [face_count,
        3].

    Raises:
        DescriptionError: ``unsupported_mesh``, ``too_large``, ``unreadable_mesh``, ``empty_mesh``,
            ``not_finite``, ``forbidden_doctype`` or ``invalid_xml``.
    """
    if path.suffix.lower() not in MESH_SUFFIXES:
        message = f"{path.name}: want one of {', '.join(MESH_SUFFIXES)}"
        raise DescriptionError("unsupported_mesh", message)
    if (size := path.stat().st_size) > MAX_MESH_BYTES:
        message = f"{path.name}: {size} bytes, at most {MAX_MESH_BYTES}"
        raise DescriptionError("too_large", message)
    if path.suffix.lower() == ".dae":
        refuse_doctype(path.read_bytes(), path.name)
    vertices, faces = _load(path)
    if len(faces) == 0:
        raise DescriptionError("empty_mesh", f"{path.name}: holds no triangle")
    if not np.isfinite(vertices[np.unique(faces)]).all():
        raise DescriptionError("not_finite", f"{path.name}: a vertex is NaN or infinite")
    return vertices, faces


def fan_polygons(sizes: IntArray) -> IntArray:
    """Return polygons as triangles around their first corners, shape [triangle_count, 3].

    Corners are counted through all polygons, one after the other; one of fewer than three has no
    triangle.

    Args:
        sizes: corners of each polygon, shape [polygon_count].
    """
    counts = np.maximum(sizes - 2, 0)
    polygon = np.repeat(np.arange(len(sizes)), counts)
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(counts) - counts, counts)
    first = (np.cumsum(sizes) - sizes)[polygon]
    return np.column_stack([first, first + step + 1, first + step + 2])


def _load(path: Path) -> tuple[FloatArray, IntArray]:
    import trimesh

    try:
        # A bare stream: by a path, it would find and read other files too.
        with path.open("rb") as stream:
            suffix = path.suffix.lower().removeprefix(".")
            scene = trimesh.load_scene(stream, file_type=suffix, process=False, skip_materials=True)
        meshes = [item for item in scene.dump() if isinstance(item, trimesh.Trimesh)]
    except Exception as error:
        # A mesh library meets strangers' files: whatever it raises, the file is at fault.
        message = f"{path.name}: {type(error).__name__}: {error}"
        raise DescriptionError("unreadable_mesh", message) from error
    if not meshes:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    vertices = np.vstack([np.asarray(mesh.vertices, dtype=np.float64) for mesh in meshes])
    pairs = zip(meshes, starts, strict=True)
    faces = np.vstack([np.asarray(mesh.faces, dtype=np.int64) + start for mesh, start in pairs])
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        message = f"{path.name}: a face names a vertex that the file does not have"
        raise DescriptionError("unreadable_mesh", message)
    return vertices, faces
