"""Opening a registry, and its database rebuilt from the folders."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import ASSETS, CLAIMS, DATABASE, REJECTED, STAGING
from ..runtime.store import sync_folder
from .claims import alone, held_folder
from .database import (
    CACHE_KIB,
    SCHEMA_VERSION,
    DamagedDatabaseError,
    connected,
    create_indices,
    create_tables,
    damaged,
    schema_version,
    writing,
)
from .folders import all_ids, folders_of, known_ids, read_record
from .placing import remove, sync_tree
from .rows import delete, insert

#: What SQLite keeps beside a database.
_COMPANIONS = ("-wal", "-shm", "-journal")
#: Rows written at once: others wait that long.
_CHUNK = 200


def make_registry(root: Path) -> None:
    """Make the folders and the database that are not there; the rows of assets that are.

    Of several that do so at once one makes them.

    Raises:
        RegistryError: it cannot be made or used.
    """
    folders = [root / name for name in (ASSETS, REJECTED, STAGING)]
    try:
        if not ((root / DATABASE).exists() and all(folder.is_dir() for folder in folders)):
            for folder in folders:
                folder.mkdir(parents=True, exist_ok=True)
            with alone(root / CLAIMS, "registry"):
                if not (root / DATABASE).exists():
                    rebuild(root)
        open_registry(root)
    except OSError as error:
        why = f"{error.strerror}; want a folder to write in"
        raise RegistryError(f"{root}: no registry can be made here: {why}") from error


def open_registry(root: Path) -> None:
    """Make sure that the database is of this program's version; the folders give an older one anew.

    Raises:
        RegistryError: there is none, it is damaged, or a newer program made it.
    """
    if not (root / DATABASE).is_file():
        if (root / ASSETS).is_dir() and all_ids(root):
            advice = f"`factory registry rebuild --output {root}` makes it from the folders"
            raise RegistryError(f"{root}: no {DATABASE}; {advice}")
        advice = f"`factory build --output {root} ...` makes one"
        raise RegistryError(f"{root}: no registry here; {advice}")
    version = schema_version(root)
    if version == 0:
        raise damaged(root, "it has no tables")
    if version < SCHEMA_VERSION:
        rebuild(root)


def rebuild(root: Path) -> list[str]:
    """Write every row anew from the folders and notes; half-done moves of dead processes finish.

    Others may go on reading and writing: rows are never missing in between, and corrected a few at
    a time. A database that cannot be read is replaced by a whole new one.

    Returns a sentence for each folder that is none of an asset; it is left where it is.

    Raises:
        RegistryError: no registry there, or its database is a newer program's.
    """
    if not (root / ASSETS).is_dir():
        raise RegistryError(f"{root}: no registry here, for want of a folder {ASSETS!r}")
    with alone(root / CLAIMS, "database"):
        if not _usable(root):
            return _replace_database(root)
    return write_rows(root, known_ids(root))


def _usable(root: Path) -> bool:
    """Return whether the database can be corrected. Raises RegistryError for a newer program's."""
    if not (root / DATABASE).is_file():
        return False
    try:
        version = schema_version(root)
        with connected(root) as connection:
            tables = {row[0] for row in connection.execute("SELECT name FROM sqlite_master")}
            sound = connection.execute("PRAGMA quick_check(1)").fetchone() == ("ok",)
    except DamagedDatabaseError:
        return False
    return sound and "assets" in tables and version == SCHEMA_VERSION


def _replace_database(root: Path) -> list[str]:
    path = root / DATABASE
    with held_folder(root / STAGING) as staging:
        with new_database(staging / DATABASE) as connection:
            unreadable = _write_rows(connection, root, all_ids(root))
        for companion in _COMPANIONS:
            remove(path.with_name(path.name + companion))
        os.replace(staging / DATABASE, path)
    sync_folder(root)
    return unreadable


@contextmanager
def new_database(path: Path) -> Iterator[sqlite3.Connection]:
    """Yield a database that is not there yet, to be filled: on the disk afterwards.

    It is useless if interrupted.
    """
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA journal_mode=OFF")
        connection.execute("PRAGMA synchronous=OFF")
        connection.execute(f"PRAGMA cache_size = -{CACHE_KIB}")
        connection.execute("BEGIN")
        create_tables(connection)
        yield connection
        create_indices(connection)
        connection.execute("COMMIT")
        connection.execute("PRAGMA synchronous=FULL")
        connection.execute("PRAGMA journal_mode=WAL")
    sync_tree(path.parent)


def write_rows(root: Path, ids: Sequence[str]) -> list[str]:
    """Bring the rows of some ids in line with their folders; one without a folder has none.

    Returns a sentence for each folder that is none of an asset.
    """
    unreadable: list[str] = []
    for start in range(0, len(ids), _CHUNK):
        # Folders are put in place under the same lock, so that what is read here is what is there.
        with writing(root) as connection:
            unreadable += _write_rows(connection, root, ids[start : start + _CHUNK])
    return unreadable


def _write_rows(connection: sqlite3.Connection, root: Path, ids: Sequence[str]) -> list[str]:
    unreadable = []
    for asset_id in ids:
        folders = folders_of(root, asset_id)
        try:
            found = read_record(folders[0]) if folders else None
        except RegistryError as error:
            found = None
            unreadable.append(str(error))
        if found is None:
            delete(connection, asset_id)
            continue
        insert(connection, found)
        # A process that died had begun to take it out of there.
        for other in folders[1:]:
            with held_folder(root / STAGING) as staging:
                os.rename(other, staging / asset_id)
    return unreadable
