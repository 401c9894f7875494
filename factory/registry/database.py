"""The table of contents: SQLite, opened per query, rebuilt from the folders when it is lost."""

from __future__ import annotations

import errno
import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import fields
from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import DATABASE
from .entry import Entry

#: Raised when a table's columns change; older databases are brought up to it, newer ones refused.
SCHEMA_VERSION = 5
BUSY_TIMEOUT_S = 30.0
#: Memory that a connection may use for pages [KiB].
CACHE_KIB = 65_536

#: An entry's columns; tags have a table of their own.
ENTRY_COLUMNS = tuple(each.name for each in fields(Entry) if each.name != "tags")
#: ``gpu_ready`` is ``yes``, ``no`` or empty; ``digest`` the SHA-256 of the asset's report.json.
COLUMNS = (*ENTRY_COLUMNS, "gpu_ready", "digest")
# Without row ids every index ends with the id: what an index finds comes out sorted as lists are.
_OTHERS = ", ".join(f"{name} NOT NULL" for name in COLUMNS[1:])
_TABLES = (
    f"CREATE TABLE assets (id TEXT PRIMARY KEY, {_OTHERS}) WITHOUT ROWID",
    "CREATE TABLE tags (tag TEXT, id TEXT, PRIMARY KEY (tag, id)) WITHOUT ROWID",
)
#: Columns by which rows are found; of several that would do, the first is the narrowest.
INDICES = (
    *(("category", "reason"), ("category", "status"), ("reason",), ("category",)),
    *(("license",), ("solved",), ("gpu_ready",), ("status",), ("key",)),
)
#: Columns by which rows are counted.
COUNTED = ("status", "category", "reason", "split", "solved", "license", "gpu_ready")
_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_DISK_ERRORS = {sqlite3.SQLITE_FULL: errno.ENOSPC, sqlite3.SQLITE_IOERR: errno.EIO}
_PRIMARY_CODE = 0xFF


class DamagedDatabaseError(RegistryError):
    """The database file is not one any more; its folders may still be whole."""


@contextmanager
def connected(root: Path) -> Iterator[sqlite3.Connection]:
    """Yield the registry's database, closed afterwards; every statement is its own transaction.

    Raises:
        DamagedDatabaseError: it cannot be read; says what makes it anew.
        OSError: the disk is full or broken.
        RegistryError: it cannot be used for another reason: locked, no rights.
    """
    path = root / DATABASE
    # SQLite wants to write beside a database that it reads, unless told that nobody can.
    mode = "mode=rw" if os.access(root, os.W_OK) else "mode=ro&immutable=1"
    uri = f"{path.absolute().as_uri()}?{mode}"
    try:
        with closing(
            sqlite3.connect(uri, uri=True, timeout=BUSY_TIMEOUT_S, isolation_level=None)
        ) as connection:
            connection.execute(f"PRAGMA cache_size = -{CACHE_KIB}")
            yield connection
    except sqlite3.Error as error:
        code = getattr(error, "sqlite_errorcode", 0) & _PRIMARY_CODE
        if code in _DAMAGED:
            raise damaged(root, str(error)) from error
        if code in _DISK_ERRORS:
            number = errno.ENOSPC if _is_full(root) else _DISK_ERRORS[code]
            raise OSError(number, os.strerror(number), str(path)) from error
        raise RegistryError(f"{path}: {error}") from error


def _is_full(root: Path) -> bool:
    """Tell whether the disk is full; SQLite calls want of room for its map an I/O error."""
    try:
        room = os.statvfs(root)
    except OSError:
        return False
    return room.f_bavail == 0 or (room.f_files > 0 and room.f_favail == 0)


@contextmanager
def writing(root: Path) -> Iterator[sqlite3.Connection]:
    """Yield one transaction with the only right to write; undone if the body raises."""
    with connected(root) as connection:
        connection.execute("BEGIN IMMEDIATE")
        try:
            yield connection
        except BaseException:
            if connection.in_transaction:
                connection.execute("ROLLBACK")
            raise
        connection.execute("COMMIT")


def create_tables(connection: sqlite3.Connection) -> None:
    """Make the tables of this version in a database that has none."""
    for statement in _TABLES:
        connection.execute(statement)
    connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION}")


def create_indices(connection: sqlite3.Connection) -> None:
    """Make what finds and counts rows quickly; much faster once the rows are there."""
    connection.execute("CREATE INDEX tags_by_id ON tags (id)")
    for columns in INDICES:
        connection.execute(f"CREATE INDEX {index_name(columns)} ON assets ({', '.join(columns)})")
    _create_counts(connection)


def _create_counts(connection: sqlite3.Connection) -> None:
    """Keep how many rows there are of each kind, whoever writes: counting reads no row."""
    names = ", ".join(COUNTED)
    columns = f"{names}, number INTEGER NOT NULL, PRIMARY KEY ({names})"
    connection.execute(f"CREATE TABLE counts ({columns}) WITHOUT ROWID")
    connection.execute(
        f"INSERT INTO counts SELECT {names}, count(*) FROM assets GROUP BY {names}"  # noqa: S608 - our own names
    )
    steps = {
        "INSERT": _counted("new", 1),
        "DELETE": _counted("old", -1),
        f"UPDATE OF {names}": _counted("old", -1) + _counted("new", 1),
    }
    for number, (change, step) in enumerate(steps.items()):
        when = f"AFTER {change} ON assets"
        connection.execute(f"CREATE TRIGGER counted_{number} {when} BEGIN {step} END")


def _counted(row: str, by: int) -> str:
    """Return SQL that counts a row in or out, and drops kinds that no row is of any more."""
    names = ", ".join(COUNTED)
    values = ", ".join(f"{row}.{name}" for name in COUNTED)
    same = " AND ".join(f"{name} = {row}.{name}" for name in COUNTED)
    added = f"INSERT INTO counts VALUES ({values}, {by})"  # noqa: S608 - our own names
    summed = f"ON CONFLICT ({names}) DO UPDATE SET number = number + {by}"
    dropped = f"DELETE FROM counts WHERE {same} AND number = 0; "  # noqa: S608 - our own names
    return f"{added} {summed}; {dropped if by < 0 else ''}"


def index_name(columns: tuple[str, ...]) -> str:
    """Return what the index of some columns is called."""
    return f"assets_by_{'_'.join(columns)}"


def damaged(root: Path, why: str) -> DamagedDatabaseError:
    """Return what to say, and to do, about a database that cannot be read."""
    remedy = f"`factory registry rebuild --output {root}` makes it anew from the folders"
    return DamagedDatabaseError(f"{root / DATABASE}: damaged ({why}); {remedy}")


def schema_version(root: Path) -> int:
    """Return which version of the tables there is; 0 for none.

    Raises RegistryError for a database that a newer program made.
    """
    with connected(root) as connection:
        version = int(connection.execute("PRAGMA user_version").fetchone()[0])
    if version > SCHEMA_VERSION:
        known = f"version {version}, this program knows up to {SCHEMA_VERSION}"
        advice = "use the asset-factory that made it, or a newer one"
        raise RegistryError(f"{root / DATABASE}: {known}; {advice}")
    return version
