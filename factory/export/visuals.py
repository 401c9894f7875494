"""Visual geometry: each part's faces by material, handles apart, and their textures as PNG."""

from __future__ import annotations

import hashlib
import io
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from PIL import Image

from ..asset import Asset
from ..intake.images import encode_png
from ..mesh import IntArray, Material, Mesh, Texture
from .meshes import material_mtl, visual_obj
from .text import write_text

#: Pixel layouts that every simulator's PNG reader takes as they are.
PLAIN_MODES = frozenset({"L", "RGB", "RGBA"})


class TextureFolder:
    """Writes each image once and remembers where.

    MuJoCo reads no JPEG, so everything becomes PNG: one file serves all simulators.

    Attributes:
        notes: a sentence per image that could not be decoded; its material stays a plain colour.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._names: dict[Texture, str | None] = {}
        self.notes: list[str] = []

    def file_name(self, material: Material) -> str | None:
        """Return the PNG of ``material``, written on first use; ``None`` for a plain colour."""
        texture = material.texture
        if texture is None:
            return None
        if texture not in self._names:
            self._names[texture] = self._write(texture, material.name)
        return self._names[texture]

    def _write(self, texture: Texture, material: str) -> str | None:
        try:
            data = png_bytes(texture)
        except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
            broken = f"texture of material {material!r} cannot be decoded ({error})"
            self.notes.append(f"{broken}; its plain colour is used")
            return None
        name = f"texture_{hashlib.sha256(data).hexdigest()[:16]}.png"
        (self._folder / name).write_bytes(data)
        return name


def png_bytes(texture: Texture) -> bytes:
    """Return the image as an 8-bit PNG; a PNG that already is one keeps its bytes.

    Raises:
        OSError, ValueError, SyntaxError: Pillow cannot decode it.
    """
    with Image.open(io.BytesIO(texture.data)) as image:
        image.load()
        if image.format == "PNG" and image.mode in PLAIN_MODES:
            return texture.data
        return encode_png(image)


VISUAL_FOLDER = Path("meshes/visual")


@dataclass(frozen=True)
class VisualPiece:
    """One visual file: MuJoCo takes one material per mesh, so nobody gets more.

    Attributes:
        name: unique in the asset; starts with ``handle_`` for handle geometry, by which ManiSkill
            finds it.
        file: OBJ, relative to the bundle.
        mesh: its content, object frame at rest [m].
        material: how it looks.
        texture: PNG, relative to the bundle; ``None`` for a plain colour.
    """

    name: str
    file: Path
    mesh: Mesh = field(repr=False)
    material: Material
    texture: Path | None


def write_visuals(
    asset: Asset, part: int, folder: Path, textures: TextureFolder
) -> tuple[VisualPiece, ...]:
    """Write OBJ, MTL and textures of a part below ``folder``."""
    articulation = asset.articulation
    name = articulation.parts[part].name
    origin = articulation.link_frame(part)
    pieces = []
    for index, (faces, is_handle) in enumerate(_groups(asset, part)):
        stem = f"{name}_{index}"
        mesh = articulation.mesh.submesh(faces)
        material = mesh.materials[0]
        texture = textures.file_name(material)
        file = VISUAL_FOLDER / f"{stem}.obj"
        write_text(folder / file, visual_obj(mesh, origin, stem))
        write_text(folder / file.with_suffix(".mtl"), material_mtl(material, stem, texture))
        name_shown = f"handle_{stem}" if is_handle else f"visual_{stem}"
        image = None if texture is None else VISUAL_FOLDER / texture
        pieces.append(VisualPiece(name_shown, file, mesh, material, image))
    return tuple(pieces)


def _groups(asset: Asset, part: int) -> list[tuple[IntArray, bool]]:
    """Return the faces of a part by (handle or not, material), body first."""
    faces = asset.articulation.parts[part].faces
    # A handle may be a part of its own, fixed to the one that moves.
    on_handle = np.zeros(len(faces), dtype=bool)
    for body in asset.bodies:
        if body.handle is not None:
            on_handle |= np.isin(faces, body.handle.faces)
    material = asset.articulation.mesh.face_material[faces]
    groups = []
    for is_handle in (False, True):
        for index in np.unique(material[on_handle == is_handle]):
            groups.append((faces[(on_handle == is_handle) & (material == index)], is_handle))
    return groups
