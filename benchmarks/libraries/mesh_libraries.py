"""Readers of mesh libraries beside ours, for mesh_readers.py, and how far two agree."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.files import InputFiles
from asset_factory.factory.intake.formats.catalog import format_of
from asset_factory.factory.mesh import Material

OURS = "ours"
Array = Any


@dataclass(frozen=True)
class Seen:
    """What a reader says of a file, face by face.

    Attributes:
        corners: shape [face_count, 3, 3].
        uv, normals: shape [face_count, 3, 2] and [face_count, 3, 3], or ``None``.
        colours: 0 to 255, shape [face_count, 4].
        pictures: digest of the pixels of each face's texture, shape [face_count].
    """

    corners: Array
    uv: Array | None = None
    normals: Array | None = None
    colours: Array | None = None
    pictures: Array | None = None


def _pixels(image: Any) -> str:
    return hashlib.sha256(image.convert("RGBA").tobytes()).hexdigest()[:16]


def ours(path: Path, root: Path) -> Seen:
    """Our own reader, as intake calls it."""
    from PIL import Image

    files = InputFiles(root, IntakeConfig())
    with np.errstate(all="ignore"):
        soup = format_of(path).read(files.read(path), path, files)
    looks = [
        _pixels(Image.open(io.BytesIO(each.texture.data))) if each.texture else ""
        for each in soup.materials
    ]
    colours = np.array([each.color for each in soup.materials]) * 255.0
    return Seen(
        soup.corners,
        soup.uv,
        soup.normals,
        colours[soup.face_material],
        np.array(looks)[soup.face_material],
    )


class _Resolver:
    """What trimesh asks for referenced files: below the folder, or not at all."""

    def __init__(self, path: Path, files: InputFiles) -> None:
        self._folder = path.parent
        self._files = files

    def get(self, name: str) -> bytes:
        return self._files.read_reference(name, self._folder)

    __getitem__ = get


def by_trimesh(path: Path, root: Path) -> Seen:
    """From a stream, told to leave vertices alone, every instance of the scene placed."""
    import trimesh

    files = InputFiles(root, IntakeConfig())
    suffix = path.suffix.lower().removeprefix(".")
    options = {"maintain_order": True, "split_object": False} if suffix == "obj" else {}
    scene = trimesh.load_scene(
        io.BytesIO(files.read(path)),
        file_type=suffix,
        resolver=_Resolver(path, files),
        process=False,
        **options,
    )
    pieces = []
    for node in scene.graph.nodes_geometry:
        matrix, key = scene.graph[node]
        mesh = scene.geometry[key]
        if not hasattr(mesh, "faces"):
            continue
        pieces.append(_placed(mesh, np.asarray(matrix)))
    if not pieces:
        return Seen(np.zeros((0, 3, 3)))
    return Seen(*(_joined(name, pieces) for name in _FIELDS))


_FIELDS = ("corners", "uv", "normals", "colours", "pictures")
_PLAIN = np.array(Material("plain").color) * 255.0
_MISSING = {"colours": _PLAIN, "pictures": ""}


def _joined(name: str, pieces: list[Seen]) -> Any:
    parts = [getattr(piece, name) for piece in pieces]
    if all(part is None for part in parts):
        return None
    shape = next(part for part in parts if part is not None).shape[1:]
    filled = [
        np.full((len(piece.corners), *shape), _MISSING.get(name, np.nan)) if part is None else part
        for part, piece in zip(parts, pieces, strict=True)
    ]
    return np.concatenate(filled)


def _placed(mesh: Any, matrix: Array) -> Seen:
    faces = np.asarray(mesh.faces)
    linear = matrix[:3, :3]
    if np.linalg.det(linear) < 0:
        faces = faces[:, [0, 2, 1]]
    uv = getattr(mesh.visual, "uv", None)
    material = getattr(mesh.visual, "material", None)
    blank = material is None
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    colour = getattr(material, "baseColorFactor", None)
    if colour is None:
        colour = getattr(material, "diffuse", None)
    if colour is None or image is not None:
        colour = (255, 255, 255, 255)
    kept = "vertex_normals" in mesh._cache.cache
    return Seen(
        (np.asarray(mesh.vertices) @ linear.T + matrix[:3, 3])[faces],
        None if uv is None else np.asarray(uv, dtype=float)[faces][..., :2],
        np.asarray(mesh.vertex_normals)[faces] @ np.linalg.inv(linear) if kept else None,
        None if blank else np.tile(np.asarray(colour, dtype=float), (len(faces), 1)),
        None if blank else np.full(len(faces), _pixels(image) if image is not None else ""),
    )


def by_meshio(path: Path, root: Path) -> Seen:
    """Points and faces; it knows no materials."""
    import meshio

    mesh = meshio.read(path)
    corners = [
        np.concatenate([cells.data[:, [0, k, k + 1]] for k in range(1, cells.data.shape[1] - 1)])
        for cells in mesh.cells
        if cells.type in ("triangle", "quad", "polygon")
    ]
    return Seen(np.asarray(mesh.points)[np.concatenate(corners)][..., :3])


def by_plyfile(path: Path, root: Path) -> Seen:
    """The tables; what they mean is left to the caller, here to a fan of each polygon."""
    from plyfile import PlyData

    data = PlyData.read(io.BytesIO(path.read_bytes()))
    vertex = data["vertex"]
    face = data["face"]
    points = np.stack([vertex[axis] for axis in "xyz"], axis=1).astype(float)
    names = [each.name for each in face.properties]
    rows = face["vertex_indices" if "vertex_indices" in names else "vertex_index"]
    faces = [(row[0], row[k], row[k + 1]) for row in rows for k in range(1, len(row) - 1)]
    return Seen(points[np.array(faces, dtype=np.int64).reshape(-1, 3)])


def by_pygltflib(path: Path, root: Path) -> Seen:
    """The document as objects; accessors, buffers, scenes and images are left to the caller."""
    from pygltflib import GLTF2

    document = GLTF2.load_from_bytes(path.read_bytes())
    counts = [
        document.accessors[primitive.indices].count // 3
        for mesh in document.meshes
        for primitive in mesh.primitives
        if primitive.indices is not None
    ]
    return Seen(np.zeros((sum(counts), 3, 3)))


def by_path(path: Path, root: Path) -> Seen:
    """As one would without a second thought: trimesh finds what it wants by itself."""
    import trimesh

    return Seen(trimesh.load_scene(path).to_mesh().triangles)


READERS: dict[str, Callable[[Path, Path], Seen]] = {
    OURS: ours,
    "trimesh": by_trimesh,
    "trimesh by path": by_path,
    "meshio": by_meshio,
    "plyfile": by_plyfile,
    "pygltflib": by_pygltflib,
}


def agreed(mine: Seen, other: Seen) -> Iterator[str]:
    """What two readers agree on."""
    if len(mine.corners) != len(other.corners):
        return
    yield "faces"
    size = float(np.nanmax(np.abs(mine.corners), initial=0.0)) or 1.0
    if not np.allclose(mine.corners, other.corners, rtol=0, atol=1e-6 * size, equal_nan=True):
        return
    yield "order"
    for name, tolerance in _TOLERANCE.items():
        first = getattr(mine, name)
        second = getattr(other, name)
        if first is None:
            yield name
            continue
        if second is None:
            second = _PLAIN if name == "colours" else np.full_like(first, np.nan)
        if name == "normals":
            first = _unit(first)
            second = _unit(second)
        if np.allclose(first, second, rtol=0, atol=tolerance, equal_nan=True):
            yield name
    if (mine.pictures == ("" if other.pictures is None else other.pictures)).all():
        yield "pictures"


_TOLERANCE = {"uv": 1e-5, "normals": 1e-3, "colours": 1.01}


def _unit(vectors: Array) -> Array:
    with np.errstate(all="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def awkward_files() -> Iterator[tuple[str, bytes]]:
    """Sound files that are rarely met: name and content."""
    corner = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n"
    faces = "3 0 1 4\n4 0 1 2 3\n3 1 2 4\n4 0 3 2 1\n3 2 3 4\n5 0 1 2 3 4\n" * 20
    yield "mixed.off", f"OFF\n5 120 0\n{corner}{faces}".encode()
    head = "ply\nformat {} 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
    head += (
        "property float z\nelement face 120\nproperty list uchar int vertex_indices\nend_header\n"
    )
    yield "mixed_text.ply", (head.format("ascii") + corner + faces).encode()
    points = np.array(corner.split(), "<f4").tobytes()
    rows = [np.array(line.split(), int) for line in faces.splitlines()]
    packed = b"".join(bytes([row[0]]) + row[1:].astype("<i4").tobytes() for row in rows)
    yield "mixed_binary.ply", head.format("binary_little_endian").encode() + points + packed
    facet = "facet normal 0 0 1\nouter loop\n" + "vertex {} 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    facet += "endloop\nendfacet\n"
    solids = "".join(
        f"solid {name}\n{''.join(facet.format(k) for k in range(60))}endsolid {name}\n"
        for name in "ab"
    )
    yield "two_solids.stl", solids.encode()
