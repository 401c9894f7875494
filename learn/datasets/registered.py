"""The assets of a registry folder that passed, as the URDF files they were registered with."""

import sqlite3
from pathlib import Path

from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.layout import URDF
from asset_factory.sim_checks import Status

from .item import SourceItem, files_below


def find_registered(root: Path) -> tuple[SourceItem, ...]:
    """Return one object per asset that passed, by id.

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
            found.append(SourceItem(entry.id, entry.category, folder / URDF, files_below(folder)))
    return tuple(found)
