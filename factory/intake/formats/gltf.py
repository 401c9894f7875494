"""glTF 2.0, text or binary: every instance of every mesh of the default scene, transforms applied.

Faces come node by node, depth first in the order the scene and its nodes list their children, then
primitive by primitive, then in the order of the primitive's indices.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ...geometry.soup import Soup, plain_soup, unique_names
from ...mesh import FloatArray, IntArray, Material, Texture, stack_corners
from ..files import InputFiles
from ..images import read_texture
from ..limits import require_at_most, unreadable
from .gltf_document import GltfDocument

_TRIANGLES = 4
_STRIP = 5
_FAN = 6
_LETTERS_OF_LICENSE = 1000
#: Of one scene; each takes time, whether or not it has anything to show.
_MOST_NODES = 200_000
_MOST_PRIMITIVES = 100_000


@dataclass(frozen=True)
class _Primitive:
    """Corners of one primitive in its mesh's frame, as in :class:`Soup`."""

    corners: FloatArray
    uv: FloatArray | None
    normals: FloatArray | None
    material: int
    tint: tuple[float, ...] | None


def read_gltf(data: bytes, path: Path, files: InputFiles) -> Soup:
    """Return the triangles of a ``.glb`` or ``.gltf`` file, in its own frame (y up) and units.

    Raises:
        InputRejected: ``unreadable``, ``unsupported``, ``too_large`` or ``external_reference``.
    """
    document = GltfDocument(data, path, files)
    materials = read_materials(document)
    cache: dict[int, list[_Primitive]] = {}
    placed: list[tuple[_Primitive, FloatArray]] = []
    face_count = 0
    every = f"{document.name}, all instances"
    for node, matrix in _instances(document):
        mesh = int(node["mesh"])
        if mesh not in cache:
            cache[mesh] = _read_mesh(document, mesh, materials, face_count)
        if "skin" in node:
            document.notes.append(f"A skin is not applied; mesh {mesh} stands in its rest pose.")
        face_count += sum(len(p.corners) for p in cache[mesh])
        require_at_most(every, face_count, files.limits.max_faces, "faces")
        placed.extend((primitive, matrix) for primitive in cache[mesh])
        require_at_most(every, len(placed), _MOST_PRIMITIVES, "primitives")
    return _assemble(document, placed, [m.material for m in materials])


def _instances(document: GltfDocument) -> Iterator[tuple[dict[str, Any], FloatArray]]:
    """Yield every node of the default scene that shows a mesh, and its world matrix."""
    nodes = document.items("nodes")
    require_at_most(document.name, len(nodes), _MOST_NODES, "nodes")
    scenes = document.items("scenes")
    if scenes:
        roots = document.get("scenes", int(document.json.get("scene", 0))).get("nodes", [])
    else:
        children = {c for node in nodes for c in node.get("children", [])}
        roots = [i for i in range(len(nodes)) if i not in children]
    stack = [(index, np.eye(4)) for index in reversed(roots)]
    seen: set[int] = set()
    while stack:
        index, parent = stack.pop()
        node = document.get("nodes", index)
        if index in seen:
            raise unreadable(document.name, f"nodes[{index}] has two parents, want a tree")
        seen.add(index)
        matrix = parent @ _local_matrix(node)
        if "mesh" in node:
            yield node, matrix
        stack.extend((child, matrix) for child in reversed(node.get("children", [])))


def _local_matrix(node: dict[str, Any]) -> FloatArray:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    quaternion = np.array(node.get("rotation", (0, 0, 0, 1)), dtype=np.float64).reshape(4)
    if np.linalg.norm(quaternion) > 0.0:
        matrix[:3, :3] = Rotation.from_quat(quaternion).as_matrix()
    matrix[:3, :3] *= np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


def _read_mesh(
    document: GltfDocument, index: int, materials: list[GltfMaterial], face_count: int
) -> list[_Primitive]:
    notes = document.notes
    result: list[_Primitive] = []
    entries = document.get("meshes", index).get("primitives", [])
    require_at_most(f"{document.name}, mesh {index}", len(entries), _MOST_PRIMITIVES, "primitives")
    for entry in entries:
        mode = entry.get("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN):
            notes.append(f"Points or lines of mesh {index} were left out; only surfaces are used.")
            continue
        if "POSITION" not in entry.get("attributes", {}):
            notes.append(f"A primitive of mesh {index} has no positions and was left out.")
            continue
        primitive = _read_primitive(document, entry, mode, materials, face_count)
        face_count += len(primitive.corners)
        if len(primitive.corners):
            result.append(primitive)
    return result


def _read_primitive(
    document: GltfDocument,
    entry: dict[str, Any],
    mode: int,
    materials: list[GltfMaterial],
    face_count: int,
) -> _Primitive:
    attributes = entry["attributes"]
    positions = document.accessor(attributes["POSITION"])
    if positions.shape[1] != 3:
        raise unreadable(document.name, f"positions have {positions.shape[1]} coordinates, want 3")
    if "indices" in entry:
        indices = document.accessor(entry["indices"]).reshape(-1).astype(np.int64)
    else:
        indices = np.arange(len(positions))
    faces = _triangles(indices, mode)
    most = document.files.limits.max_faces
    require_at_most(document.name, face_count + len(faces), most, "faces")
    if len(faces) and not 0 <= faces.min() <= faces.max() < len(positions):
        wrong = f"a face uses vertex {faces.max()}, but there are {len(positions)}"
        raise unreadable(document.name, wrong)

    def corners_of(attribute: str, width: int) -> FloatArray | None:
        if attribute not in attributes:
            return None
        values = document.accessor(attributes[attribute])
        if len(values) != len(positions) or values.shape[1] < width:
            return None
        return values[faces][..., :width].astype(np.float64)

    material = int(entry.get("material", -1))
    style = materials[material] if 0 <= material < len(materials) else None
    uv = corners_of(f"TEXCOORD_{style.uv_set if style else 0}", 2)
    colors = corners_of("COLOR_0", 3)
    return _Primitive(
        corners=positions[faces].astype(np.float64),
        uv=None if uv is None else _bottom_left(uv, style),
        normals=corners_of("NORMAL", 3),
        material=material if style else -1,
        tint=None if colors is None or not len(colors) else _tint(colors),
    )


def _triangles(indices: IntArray, mode: int) -> IntArray:
    if mode == _TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    count = max(len(indices) - 2, 0)
    step = np.arange(count)
    if mode == _FAN:
        first = np.broadcast_to(indices[:1], count)
        return np.stack([first, indices[1 : count + 1], indices[2:]], axis=1)
    odd = step % 2
    return np.stack([indices[step], indices[step + 1 + odd], indices[step + 2 - odd]], axis=1)


def _bottom_left(uv: FloatArray, style: GltfMaterial | None) -> FloatArray:
    if style is not None:
        uv = uv @ style.uv_transform[:2, :2].T + style.uv_transform[:2, 2]
    return np.stack([uv[..., 0], 1.0 - uv[..., 1]], axis=-1)


def _tint(colors: FloatArray) -> tuple[float, ...]:
    mean = np.nan_to_num(colors.reshape(-1, 3)).mean(axis=0)
    return tuple(round(float(c), 6) for c in np.clip(mean, 0.0, 1.0))


def _assemble(
    document: GltfDocument, placed: list[tuple[_Primitive, FloatArray]], materials: list[Material]
) -> Soup:
    stated = " ".join(str(document.json.get("asset", {}).get("copyright") or "").split())
    if not placed:
        return plain_soup(np.zeros((0, 3, 3)))
    looks: dict[tuple[int, tuple[float, ...] | None], int] = {}
    face_material = [
        np.full(len(p.corners), looks.setdefault((p.material, p.tint), len(looks)), dtype=np.int64)
        for p, _ in placed
    ]
    counts = [len(p.corners) for p, _ in placed]
    moved = [_move(p, matrix) for p, matrix in placed]
    if any(tint is not None for _, tint in looks):
        document.notes.append("Vertex colours were averaged to one colour per primitive.")
    names = unique_names(materials[index].name if index >= 0 else "default" for index, _ in looks)
    return Soup(
        corners=np.concatenate([m.corners for m in moved]),
        uv=stack_corners([m.uv for m in moved], counts, 2),
        normals=stack_corners([m.normals for m in moved], counts, 3),
        face_material=np.concatenate(face_material),
        materials=tuple(
            _look(materials[index] if index >= 0 else None, tint, name)
            for (index, tint), name in zip(looks, names, strict=True)
        ),
        license=stated[:_LETTERS_OF_LICENSE] or None,
        notes=tuple(dict.fromkeys(document.notes)),
    )


def _look(material: Material | None, tint: tuple[float, ...] | None, name: str) -> Material:
    if material is None:
        return Material(name, (*tint[:3], 1.0)) if tint is not None else Material(name)  # type: ignore[arg-type]
    r, g, b = tint or (1.0, 1.0, 1.0)
    red, green, blue, alpha = material.color
    return Material(name, (red * r, green * g, blue * b, alpha), material.texture)


def _move(primitive: _Primitive, matrix: FloatArray) -> _Primitive:
    """Return the primitive in the scene's frame; a mirroring matrix reverses the winding."""
    linear = matrix[:3, :3]
    with np.errstate(all="ignore"):
        determinant = np.linalg.det(linear)
        order = [0, 2, 1] if determinant < 0 else [0, 1, 2]
        corners = primitive.corners @ linear.T + matrix[:3, 3]
        normals = primitive.normals
        if normals is not None:
            usable = np.isfinite(determinant) and determinant != 0.0
            normals = normals @ np.linalg.inv(linear) if usable else np.full_like(normals, np.nan)
    return replace(
        primitive,
        corners=corners[:, order],
        uv=None if primitive.uv is None else primitive.uv[:, order],
        normals=None if normals is None else normals[:, order],
    )


@dataclass(frozen=True)
class GltfMaterial:
    """A material and how its texture coordinates are made.

    Attributes:
        material: name, colour and texture.
        uv_set: which ``TEXCOORD_n`` the texture uses.
        uv_transform: applied to homogeneous glTF coordinates (origin top left), shape [3, 3].
    """

    material: Material
    uv_set: int
    uv_transform: FloatArray


def read_materials(document: GltfDocument) -> list[GltfMaterial]:
    """Return all materials in order."""
    entries = document.items("materials")
    names = unique_names(str(entry.get("name", f"material_{i}")) for i, entry in enumerate(entries))
    textures: dict[int, Texture | None] = {}
    return [_material(document, e, n, textures) for e, n in zip(entries, names, strict=True)]


def _material(
    document: GltfDocument, entry: dict[str, Any], name: str, textures: dict[int, Texture | None]
) -> GltfMaterial:
    glossy = entry.get("extensions", {}).get("KHR_materials_pbrSpecularGlossiness")
    if "pbrMetallicRoughness" not in entry and glossy is not None:
        factor = glossy.get("diffuseFactor")
        reference = glossy.get("diffuseTexture")
    else:
        rough = entry.get("pbrMetallicRoughness", {})
        factor = rough.get("baseColorFactor")
        reference = rough.get("baseColorTexture")
    color = [min(max(float(c), 0.0), 1.0) for c in (factor or (1.0, 1.0, 1.0, 1.0))]
    if len(color) != 4 or not np.isfinite(color).all():
        wrong = f"Material {name} has the base colour {factor}, which is no RGBA"
        document.notes.append(f"{wrong}; white was taken.")
        color = [1.0, 1.0, 1.0, 1.0]
    if entry.get("alphaMode", "OPAQUE") == "OPAQUE":
        color[3] = 1.0
    texture = None
    if reference is not None:
        texture = _texture(document, int(reference["index"]), textures)
    material = Material(name, (color[0], color[1], color[2], color[3]), texture)
    return GltfMaterial(material, *_coordinates(reference or {}))


def _coordinates(reference: dict[str, Any]) -> tuple[int, FloatArray]:
    """Return coordinate set and transform, by the extension KHR_texture_transform."""
    transform = reference.get("extensions", {}).get("KHR_texture_transform", {})
    (offset_u, offset_v) = transform.get("offset", (0.0, 0.0))
    (scale_u, scale_v) = transform.get("scale", (1.0, 1.0))
    angle = float(transform.get("rotation", 0.0))
    cos = np.cos(angle)
    sin = np.sin(angle)
    across = [cos * scale_u, sin * scale_v, offset_u]
    down = [-sin * scale_u, cos * scale_v, offset_v]
    matrix = np.array([across, down, [0.0, 0.0, 1.0]])
    return int(transform.get("texCoord", reference.get("texCoord", 0))), matrix


def _texture(
    document: GltfDocument, index: int, textures: dict[int, Texture | None]
) -> Texture | None:
    entry = document.get("textures", index)
    webp = entry.get("extensions", {}).get("EXT_texture_webp", {})
    image = entry.get("source", webp.get("source"))
    if image is None:
        lacks = f"Texture {index} has no image in a format that is read"
        document.notes.append(f"{lacks}; the plain base colour was kept.")
        return None
    if image not in textures:
        encoded = partial(document.image_bytes, int(image))
        textures[image] = read_texture(f"image {image}", encoded, document.files, document.notes)
    return textures[image]
