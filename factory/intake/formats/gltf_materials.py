"""Base colours and base colour textures of a glTF asset."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...geometry.soup import unique_names
from ...mesh import FloatArray, Material, Texture
from ..images import load_texture
from .gltf_document import GltfDocument


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


def read_materials(document: GltfDocument) -> tuple[list[GltfMaterial], list[str]]:
    """Return all materials in order, and notes on textures that had to be left out."""
    entries = document.items("materials")
    names = unique_names(str(entry.get("name", f"material_{i}")) for i, entry in enumerate(entries))
    notes: list[str] = []
    textures: dict[int, Texture | None] = {}
    return [
        _material(document, e, n, textures, notes) for e, n in zip(entries, names, strict=True)
    ], notes


def _material(
    document: GltfDocument,
    entry: dict[str, Any],
    name: str,
    textures: dict[int, Texture | None],
    notes: list[str],
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
        notes.append(
            f"Material {name} has the base colour {factor}, which is no RGBA; white was taken."
        )
        color = [1.0, 1.0, 1.0, 1.0]
    if entry.get("alphaMode", "OPAQUE") == "OPAQUE":
        color[3] = 1.0
    texture = (
        None if reference is None else _texture(document, int(reference["index"]), textures, notes)
    )
    return GltfMaterial(
        Material(name, (color[0], color[1], color[2], color[3]), texture),
        *_coordinates(reference or {}),
    )


def _coordinates(reference: dict[str, Any]) -> tuple[int, FloatArray]:
    """Return coordinate set and transform, by the extension KHR_texture_transform."""
    transform = reference.get("extensions", {}).get("KHR_texture_transform", {})
    (offset_u, offset_v) = transform.get("offset", (0.0, 0.0))
    (scale_u, scale_v) = transform.get("scale", (1.0, 1.0))
    angle = float(transform.get("rotation", 0.0))
    cos = np.cos(angle)
    sin = np.sin(angle)
    matrix = np.array(
        [
            [cos * scale_u, sin * scale_v, offset_u],
            [-sin * scale_u, cos * scale_v, offset_v],
            [0.0, 0.0, 1.0],
        ]
    )
    return int(transform.get("texCoord", reference.get("texCoord", 0))), matrix


def _texture(
    document: GltfDocument, index: int, textures: dict[int, Texture | None], notes: list[str]
) -> Texture | None:
    entry = document.get("textures", index)
    webp = entry.get("extensions", {}).get("EXT_texture_webp", {})
    image = entry.get("source", webp.get("source"))
    if image is None:
        notes.append(
            f"Texture {index} has no image in a format that is read; "
            "the plain base colour was kept."
        )
        return None
    if image not in textures:
        textures[image] = _image(document, int(image), notes)
    return textures[image]


def _image(document: GltfDocument, index: int, notes: list[str]) -> Texture | None:
    try:
        data = document.image_bytes(index)
    except FileNotFoundError:
        notes.append(f"The file of image {index} is missing; the plain base colour was kept.")
        return None
    texture = load_texture(data, f"image {index}", document.files)
    if texture is None:
        notes.append(
            f"Image {index} ({len(data)} bytes) cannot be decoded; the plain base colour was kept."
        )
    return texture
