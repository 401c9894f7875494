"""What pages and pictures show of an asset, as one GLB file: its looks, its hulls, its joints."""

from __future__ import annotations

from pathlib import Path

from ..asset import Asset
from ..display.glb import glb_of
from ..display.made import scene_of, scene_of_mesh
from ..mesh import Mesh
from ..runtime.layout import MODEL


def write_input(mesh: Mesh, folder: Path) -> Path:
    """Write ``view.glb`` of an input that became no asset; returns its new folder."""
    folder.mkdir()
    (folder / MODEL).write_bytes(glb_of(scene_of_mesh("input", mesh)))
    return folder


def write_model(asset: Asset, folder: Path, before: Asset | None = None) -> None:
    """Write ``view.glb`` into a bundle's folder: the same bytes for the same asset.

    ``before`` is what the asset was before repairs, if there were any.
    """
    (folder / MODEL).write_bytes(glb_of(scene_of(asset, before)))
