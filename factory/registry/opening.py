"""Opening a registry: missing, old, new or newer than this program."""

from __future__ import annotations

from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import ASSETS, CLAIMS, DATABASE, REJECTED, STAGING
from .claims import alone
from .database import SCHEMA_VERSION, connected, damaged, require_known, schema_version
from .folders import all_ids
from .rebuild import rebuild


def make_registry(root: Path) -> None:
    """Make the folders and the database that are not there; the rows of assets that are.

    Of several that do so at once one makes them.

    Raises:
        RegistryError: it cannot be made or used.
    """
    try:
        _make(root)
        open_registry(root)
    except OSError as error:
        raise RegistryError(
            f"{root}: no registry can be made here: {error.strerror}; want a folder to write in"
        ) from error


def _make(root: Path) -> None:
    folders = [root / name for name in (ASSETS, REJECTED, STAGING)]
    if (root / DATABASE).exists() and all(folder.is_dir() for folder in folders):
        return
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
    with alone(root / CLAIMS, "registry"):
        if not (root / DATABASE).exists():
            rebuild(root)


def open_registry(root: Path) -> None:
    """Make sure that the database is of this program's version; the folders give an older one anew.

    Raises:
        RegistryError: there is none, it is damaged, or a newer program made it.
    """
    if not (root / DATABASE).is_file():
        if (root / ASSETS).is_dir() and all_ids(root):
            raise RegistryError(
                f"{root}: no {DATABASE}; `factory registry rebuild --output {root}` makes it "
                "from the folders"
            )
        raise RegistryError(
            f"{root}: no registry here; `factory build --output {root} ...` makes one"
        )
    with connected(root) as connection:
        version = schema_version(connection)
    if version == 0:
        raise damaged(root, "it has no tables")
    require_known(root, version)
    if version < SCHEMA_VERSION:
        rebuild(root)
