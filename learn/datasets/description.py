"""Objects with a URDF, an MJCF or a USD asset each: in folders of folders, or in a registry."""

from __future__ import annotations

import importlib.util
import sqlite3
from collections.abc import Sequence
from pathlib import Path

from asset_factory.factory.articulate.stage import hypotheses_of
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.intake.discover import MAIN_LAYERS, is_description
from asset_factory.factory.intake.load import load
from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.layout import URDF
from asset_factory.sim_checks import Status
from asset_factory.sim_checks.read.usd.layers import is_usd

from .item import SourceItem, files_below, find_items
from .settings import SourceSettings

#: Of PartNet-Mobility's folders, whose objects look along -X.
PARTNET_MAIN = "mobility.urdf"


def read_description(item: SourceItem, settings: SourceSettings) -> Articulation:
    """Return one object, fixed parts joined to parents, lower = closed. Raises InputRejected."""
    (found,) = hypotheses_of(load(item.main, settings.intake), BuildConfig(articulator="annotated"))
    return found


def find_descriptions(root: Path) -> tuple[SourceItem, ...]:
    """Return the objects of a folder of folders."""
    return find_items(root, _mains)


def _mains(files: Sequence[Path]) -> list[Path]:
    """Sort URDF before MJCF, the file called like its folder first."""

    def rank(path: Path) -> tuple[bool, bool, str]:
        return path.suffix.lower() != ".urdf", path.stem != path.parent.name, path.name

    return sorted((path for path in files if is_description(path)), key=rank)


def find_partnet(root: Path) -> tuple[SourceItem, ...]:
    """Return the objects of a folder of PartNet-Mobility folders, called by their numbers."""

    def mains(files: Sequence[Path]) -> list[Path]:
        return [path for path in files if path.name == PARTNET_MAIN]

    return find_items(root, mains)


def find_usd(root: Path) -> tuple[SourceItem, ...]:
    """Return the objects of a folder of folders, or of a folder of files complete in themselves.

    Raises:
        ConfigError: the library that reads USD is not installed.
    """
    if importlib.util.find_spec("pxr") is None:
        raise ConfigError("reading USD needs usd-core: pip install 'asset-factory[train]'")
    return find_items(root, _usd_mains)


def _usd_mains(files: Sequence[Path]) -> list[Path]:
    """Return the file called like its folder first, then the names that asset packs use."""

    def rank(path: Path) -> tuple[bool, int, str]:
        place = (*MAIN_LAYERS, path.stem).index(path.stem)
        return path.stem != path.parent.name, place, path.name

    return sorted((path for path in files if is_usd(path)), key=rank)


def find_registered(root: Path) -> tuple[SourceItem, ...]:
    """Return one object per asset of a registry folder that passed, by id.

    Raises:
        ConfigError: the folder is no registry.
    """
    try:
        registry = Registry(root)
        entries = registry.entries()
    except RegistryError as error:
        raise ConfigError(str(error)) from error
    except sqlite3.Error as error:
        raise ConfigError(f"{root}: its registry.db cannot be read: {error}") from error
    found = []
    for entry in entries:
        folder = registry.folder(entry)
        if entry.status is Status.PASSED and (folder / URDF).is_file():
            found.append(SourceItem(entry.id, folder / URDF, files_below(folder)))
    return tuple(found)
