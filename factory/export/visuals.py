"""Visual geometry: each part's faces, split into pieces of one material, handles apart."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..asset import Asset
from ..mesh import IntArray, Material, Mesh
from .meshes import material_mtl, visual_obj
from .textures import TextureFolder

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
    asset: Asset, folder: Path, textures: TextureFolder
) -> tuple[tuple[VisualPiece, ...], ...]:
    """Write OBJ, MTL and textures of every part below ``folder``; one tuple of pieces per part."""
    return tuple(
        _write_part(asset, part, folder, textures) for part in range(len(asset.articulation.parts))
    )


def _write_part(
    asset: Asset, part: int, folder: Path, textures: TextureFolder
) -> tuple[VisualPiece, ...]:
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
        (folder / file).write_text(
            visual_obj(mesh, origin, f"{stem}.mtl", stem), encoding="utf-8", newline="\n"
        )
        library = material_mtl(material, stem, texture)
        (folder / file.with_suffix(".mtl")).write_text(library, encoding="utf-8", newline="\n")
        visual_name = f"handle_{stem}" if is_handle else f"visual_{stem}"
        pieces.append(
            VisualPiece(
                visual_name,
                file,
                mesh,
                material,
                None if texture is None else VISUAL_FOLDER / texture,
            )
        )
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
