"""Folders with a URDF or an MJCF each, through the project's own importers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from asset_factory.factory.articulate.stage import articulate
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake.discover import is_description
from asset_factory.factory.intake.load import load

from .categories import categories_of
from .item import SourceItem, find_items
from .settings import SourceSettings


def find_descriptions(root: Path) -> tuple[SourceItem, ...]:
    """Return the objects of a folder of folders."""
    return find_items(root, _mains, categories_of(root))


def read_description(item: SourceItem, settings: SourceSettings) -> Articulation:
    """Return one object, fixed parts joined to parents, lower = closed. Raises InputRejected."""
    return articulate(load(item.main, settings.intake), BuildConfig(articulator="annotated"))


def _mains(files: Sequence[Path]) -> list[Path]:
    """Sort URDF before MJCF, the file called like its folder first."""

    def rank(path: Path) -> tuple[bool, bool, str]:
        return path.suffix.lower() != ".urdf", path.stem != path.parent.name, path.name

    return sorted((path for path in files if is_description(path)), key=rank)
