"""The asset as one GLB file: what it looks like, its hulls, and how it moves."""

from __future__ import annotations

from pathlib import Path

from ..asset import Asset
from ..runtime.layout import MODEL
from ..scene.glb import glb_of
from ..scene.made import scene_of


def write_model(asset: Asset, folder: Path) -> None:
    """Write ``asset.glb`` into a bundle's folder: the same bytes for the same asset."""
    (folder / MODEL).write_bytes(glb_of(scene_of(asset)))
