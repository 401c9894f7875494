"""Work on an edited mesh, in a child process: a file of anybody's may take any time.

Whatever it raises is an AssetFactoryError that says why.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from msgspec import structs, to_builtins

from asset_factory.sim_checks import Severity, Status

from ..articulate.stage import hypotheses_of
from ..articulate.stated import StatedArticulator
from ..articulate.stated.seen import SeenMesh
from ..config import BuildConfig
from ..display.glb import glb_of, read_model, scene_from
from ..display.made import scene_of_articulation, scene_of_mesh
from ..errors import ConfigError, InputRejected
from ..intake.intake import Intake
from ..intake.loading import load_mesh
from ..intake.stated import Stated
from ..part import PartKind
from ..registry import Registry
from ..registry.registry import read_manifest
from ..report.site.told import about, asset_page
from ..runtime.layout import MODEL
from .found import found_parts
from .pictures import SidePicture, side_pictures

#: Link of the part that is stated at a place in the list, in a light preview.
PREVIEW_NAME = "stated.{}"
#: What the page shows of the report's.
SHOWN_DATA = ("excess", "ignored", "places", "start")


@dataclass(frozen=True)
class ShownModel:
    """A GLB for the page, empty without, and JSON data on it."""

    model: bytes
    told: dict[str, Any]


def open_mesh(mesh: Path, config: BuildConfig, asset: Path | None) -> ShownModel:
    """Load a mesh, and tell the parts that were made of it before, as a statement's JSON data.

    Empty data if there are none, or nobody can say where.

    Args:
        mesh: its file.
        config: how it is read.
        asset: the folder of the asset made of it, if that is known.

    Raises:
        InputRejected: it cannot be loaded.
    """
    intake = _loaded(mesh, config)
    model = glb_of(scene_of_mesh(intake.name, intake.mesh))
    return ShownModel(model, {} if asset is None else _found_in(asset, intake))


def pictures_of(mesh: Path, config: BuildConfig, front: str) -> tuple[SidePicture, ...]:
    """Return the sides of a mesh, as seen by somebody who stands before a stated front."""
    return side_pictures(_seen(mesh, config, front).mesh)


def look(mesh: Path, config: BuildConfig, front: str) -> None:
    """Look for the seams on the sides of a mesh, so that the first preview need not."""
    _seen(mesh, config, front).look()


def preview(mesh: Path, config: BuildConfig, stated: Stated) -> bytes:
    """Return a GLB of the parts as they are stated, without solids; links: ``PREVIEW_NAME``.

    Raises:
        InputRejected: a stated part is not found.
    """
    intake = _loaded(mesh, config)
    seen = _seen(mesh, config, stated.front)
    named = [
        structs.replace(part, name=part.name or PREVIEW_NAME.format(place))
        for place, part in enumerate(stated.parts)
    ]
    if not named:
        return glb_of(scene_of_mesh(intake.name, intake.mesh))
    told = structs.replace(stated, parts=tuple(named))
    try:
        made = StatedArticulator(told, seen=seen).articulate(intake.mesh)
    except InputRejected:
        # Whoever reads why knows its parts by their own names.
        made = StatedArticulator(stated, seen=seen).articulate(intake.mesh)
    return glb_of(scene_of_articulation(intake.name, made))


def guess(mesh: Path, config: BuildConfig) -> dict[str, Any]:
    """Return what opens as the articulators see it, as a statement's JSON data; empty: nothing."""
    intake = _loaded(mesh, config)
    try:
        (made, *_) = hypotheses_of(intake, config)
    except InputRejected:
        return {}
    kinds = {part.name: part.kind for part in made.parts}
    scene = scene_of_articulation(intake.name, made)
    return _plain(found_parts(intake.mesh, scene, kinds))


def verdict_of(output: Path, asset_id: str) -> ShownModel:
    """Return what the registry says of a build.

    Raises:
        RegistryError: it is not there, or cannot be read.
    """
    entry = Registry(output).entry(asset_id)
    page = asset_page(output, entry)
    groups = [
        {
            "code": group.code,
            "error": group.severity is Severity.ERROR,
            "meaning": group.meaning,
            "findings": [[each.finding.message, each.place] for each in group.findings],
        }
        for group in page.groups
    ]
    told = {
        "id": entry.id,
        "status": str(entry.status),
        "passed": entry.status is Status.PASSED,
        "reason": entry.reason,
        "message": entry.message,
        "about": about(entry),
        "groups": groups,
        "repairs": [repair.sentence for repair in page.repairs],
        "shown": {name: value for name, value in page.data.items() if name in SHOWN_DATA},
    }
    return ShownModel(page.model, told)


def _found_in(asset: Path, intake: Intake) -> dict[str, Any]:
    """Return the parts of an asset, of a registered or a rejected one, where they can be seen."""
    manifest = read_manifest(asset)
    if manifest is not None and manifest.provenance.up != intake.provenance.up:
        # It was stood up: its frame is not the one in which parts are stated.
        return {}
    try:
        scene = scene_from(read_model(asset / MODEL))
    except (OSError, ValueError):
        return {}
    proposed = {} if manifest is None else manifest.proposed
    told = {name: each.kind for name, each in proposed.items()}
    kinds = {name: PartKind(kind) for name, kind in told.items() if kind in set(PartKind)}
    return _plain(found_parts(intake.mesh, scene, kinds))


def _plain(stated: Stated) -> dict[str, Any]:
    data: dict[str, Any] = to_builtins(stated)
    return data if stated.parts else {}


@lru_cache(maxsize=1)
def _loaded(mesh: Path, config: BuildConfig) -> Intake:
    """Return a mesh without the statement beside it, which is being changed."""
    try:
        return load_mesh(mesh, config.intake, stated=False)
    except (TimeoutError, ChildProcessError) as error:
        raise ConfigError(f"{mesh}: {error}") from error


@lru_cache(maxsize=1)
def _seen(mesh: Path, config: BuildConfig, front: str) -> SeenMesh:
    return SeenMesh.of(_loaded(mesh, config).mesh, front)
