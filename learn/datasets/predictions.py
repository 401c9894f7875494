"""Meshes with a ``pred.npz``: generated objects, Particulate's predictions, third-party labels.

The labels are those that the mesh's sidecar names, else ``<stem>.pred.npz`` or ``<stem>.npz``
beside it, else ``pred.npz`` in a folder with a single mesh.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from asset_factory.factory.articulate.stage import hypotheses_of
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.formats.catalog import is_mesh
from asset_factory.factory.intake.load import load

from .item import SourceItem, find_items
from .settings import SourceSettings

LONE = "pred.npz"


def find_predictions(root: Path) -> tuple[SourceItem, ...]:
    """Return every mesh with labels; in ``root`` itself an object each, below it one per folder."""
    found = find_items(root, _mains)
    return tuple(_alone(item) if item.folder == root else item for item in found)


def read_prediction_item(item: SourceItem, settings: SourceSettings) -> Articulation:
    """Return a mesh with its labels, turned and scaled as in intake. Raises InputRejected."""
    intake = load(item.main, settings.intake)
    if intake.annotation_path is None:
        labels = labels_beside(item.main, item.files)
        if labels is None:
            wanted = f"want {item.main.stem}.pred.npz"
            raise InputRejected("no_annotation", f"{item.main.name}: has no labels; {wanted}")
        intake = replace(intake, annotation_path=labels)
    return hypotheses_of(intake, BuildConfig(articulator="annotated"))[0]


def labels_beside(mesh: Path, files: Sequence[Path]) -> Path | None:
    """Return the labels of a mesh among files of its folder, unless its sidecar names them."""
    there = {path.name: path for path in files if path.parent == mesh.parent}
    lone = sum(is_mesh(path) for path in there.values()) == 1
    for name in (f"{mesh.stem}.pred.npz", f"{mesh.stem}.npz", *([LONE] if lone else [])):
        if name in there:
            return there[name]
    return None


def _mains(files: Sequence[Path]) -> list[Path]:
    return [path for path in files if is_mesh(path) and _has_labels(path, files)]


def _has_labels(mesh: Path, files: Sequence[Path]) -> bool:
    if labels_beside(mesh, files) is not None:
        return True
    names = {path.name: path for path in files}
    sidecar = names.get(f"{mesh.name}.toml") or names.get(f"{mesh.stem}.toml")
    try:
        return sidecar is not None and "annotation" in sidecar.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False


def _alone(item: SourceItem) -> SourceItem:
    """Keep, of a folder of many objects, the files named like this one or like all."""
    start = f"{item.main.stem}."
    own = (path for path in item.files if path.name.startswith(start) or path.name == LONE)
    return replace(item, files=tuple(own))
