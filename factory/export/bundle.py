"""Asset -> Bundle: one folder of URDF, MJCF, meshes, manifest, and its model for pages."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, replace
from pathlib import Path

from ..asset import Asset
from ..display.glb import glb_of
from ..display.made import scene_of, scene_of_mesh
from ..intake.intake import Provenance
from ..mesh import Mesh
from ..runtime.layout import MANIFEST, MESHES, MJCF, MODEL, URDF
from .described import manifest_of
from .formats import formats_named
from .links import Layout, lay_out
from .manifest import Manifest
from .text import write_text


@dataclass(frozen=True)
class Bundle:
    """The files written.

    Attributes:
        folder: holds everything; nothing in it points outside.
        urdf, mjcf: the two descriptions.
        manifest: the content of ``asset.json``.
        layout: what all of it says.
    """

    folder: Path
    urdf: Path
    mjcf: Path
    manifest: Manifest
    layout: Layout


def export_bundle(
    asset: Asset,
    provenance: Provenance,
    folder: Path,
    excluded_pairs: tuple[tuple[str, str], ...] = (),
    formats: tuple[str, ...] = (),
) -> Bundle:
    """Write ``asset.urdf``, ``asset.xml``, ``asset.json`` and ``meshes/`` into ``folder``.

    Link frames have the object frame's axes and their origin at the joint's; joint value 0 is the
    input pose and ``lower`` is closed.

    An earlier bundle in the folder is replaced. MuJoCo collides no ``excluded_pairs`` of parts,
    which overlap on purpose. ``formats`` are names of further ones in :data:`.formats.FORMATS`.

    Raises:
        ConfigError: a format that is not there, or that cannot be written here.
        ValueError: an excluded pair names a part that is not there.
        OSError: the folder cannot be written.
    """
    chosen = formats_named(formats)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(folder / MESHES, ignore_errors=True)
    layout = lay_out(asset, folder, excluded_pairs)
    manifest = manifest_of(layout, provenance)
    for each in chosen:
        each.write(layout, folder / each.file)
    write_text(folder / MANIFEST, manifest.to_json())
    return Bundle(folder, folder / URDF, folder / MJCF, manifest, layout)


def with_manifest_of(bundle: Bundle, asset: Asset, provenance: Provenance) -> Bundle:
    """Return a bundle with a new ``asset.json``, of the same asset with other targets."""
    layout = replace(bundle.layout, asset=asset)
    manifest = manifest_of(layout, provenance)
    write_text(bundle.folder / MANIFEST, manifest.to_json())
    return replace(bundle, manifest=manifest, layout=layout)


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
