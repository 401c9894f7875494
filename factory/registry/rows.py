"""Entries in and out of the database."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from dataclasses import dataclass, fields

from .database import COLUMNS, COUNTED, ENTRY_COLUMNS, INDICES, index_name
from .entry import Entry

_SELECT = (
    f"SELECT {', '.join(f'assets.{name}' for name in ENTRY_COLUMNS)}, "  # noqa: S608
    "(SELECT group_concat(own.tag) FROM tags AS own WHERE own.id = assets.id)"
)
_TAKEN_OVER = ", ".join(f"{name} = excluded.{name}" for name in COLUMNS[1:])
# Replacing would count rows twice: it drops the old one without telling triggers.
_INSERT = (
    f"INSERT INTO assets ({', '.join(COLUMNS)}) VALUES ({', '.join('?' for _ in COLUMNS)}) "  # noqa: S608 - our own names
    f"ON CONFLICT (id) DO UPDATE SET {_TAKEN_OVER}"
)
_NEAR = 100
_HIGHEST = "\U0010ffff"


@dataclass(frozen=True)
class RegistryRow:
    """An entry, and what else is known of it.

    Attributes:
        entry: the entry.
        digest: SHA-256 of the report.json that it was read from.
        gpu_ready: ``yes`` or ``no``: whether PhysX takes its hulls on a GPU; empty if it was not
            validated, or did not pass.
    """

    entry: Entry
    digest: str
    gpu_ready: str = ""


@dataclass(frozen=True)
class Condition:
    """A column of the table compared with a value."""

    column: str
    operator: str
    value: str | int


@dataclass(frozen=True)
class Filters:
    """Which entries are wanted; ``None`` lets everything pass.

    Attributes:
        status, category, reason, split, solved, license, name: as the entry has it.
        tag: one of its tags.
        gpu_ready: as the row has it.
        others: what else must hold, of our own columns and operators.
    """

    status: str | None = None
    category: str | None = None
    reason: str | None = None
    tag: str | None = None
    split: str | None = None
    solved: str | None = None
    license: str | None = None
    gpu_ready: str | None = None
    name: str | None = None
    others: tuple[Condition, ...] = ()

    def query(self, *, after: str = "") -> tuple[str, list[str | int]]:
        """Return what follows SELECT columns: the tables, the conditions, and their values."""
        said = {item.name: getattr(self, item.name) for item in fields(self)}
        del said["others"]
        asked = {name: value for name, value in said.items() if value is not None}
        conditions = [f"{'tags' if name == 'tag' else 'assets'}.{name} = ?" for name in asked]
        conditions += [f"assets.{each.column} {each.operator} ?" for each in self.others]
        values = [*asked.values(), *(each.value for each in self.others)]
        if after:
            conditions = [*conditions, f"{self.order} > ?"]
            values = [*values, after]
        where = f" WHERE {' AND '.join(conditions)}" if conditions else ""
        return f" FROM {_walked(frozenset(asked))}{where}", values

    @property
    def order(self) -> str:
        """Return the column that the rows of :meth:`query` are found in the order of."""
        return "assets.id" if self.tag is None else "tags.id"


def _walked(asked: frozenset[str]) -> str:
    """Name the table, and its narrowest index that gives rows in the order of ids."""
    if "tag" in asked:
        return "tags CROSS JOIN assets ON assets.id = tags.id"
    index = next((names for names in INDICES if asked.issuperset(names)), None)
    if index is not None:
        return f"assets INDEXED BY {index_name(index)}"
    # Left alone, SQLite may take an index that it has to sort.
    return "assets NOT INDEXED" if asked else "assets"


def insert(connection: sqlite3.Connection, records: Iterable[RegistryRow]) -> None:
    """Write rows, over those of the same ids."""
    for record in records:
        entry = record.entry
        own = (getattr(entry, name) for name in ENTRY_COLUMNS)
        connection.execute(_INSERT, [*own, record.gpu_ready, record.digest])
        connection.execute("DELETE FROM tags WHERE id = ?", (entry.id,))
        tags = [(tag, entry.id) for tag in entry.tags]
        connection.executemany("INSERT INTO tags (tag, id) VALUES (?, ?)", tags)


def delete(connection: sqlite3.Connection, asset_id: str) -> None:
    """Drop a row, if it is there."""
    connection.execute("DELETE FROM assets WHERE id = ?", (asset_id,))
    connection.execute("DELETE FROM tags WHERE id = ?", (asset_id,))


def find(connection: sqlite3.Connection, column: str, value: str) -> Entry | None:
    """Return the first entry with that value in a column of the table."""
    query = f"{_SELECT} FROM assets WHERE {column} = ? ORDER BY id LIMIT 1"
    row = connection.execute(query, (value,)).fetchone()
    return None if row is None else _entry(row)


def report_digest(connection: sqlite3.Connection, asset_id: str) -> str:
    """Return SHA-256 of an entry's report.json when it was listed; empty if it is not."""
    row = connection.execute("SELECT digest FROM assets WHERE id = ?", (asset_id,)).fetchone()
    return "" if row is None else str(row[0])


def select(
    connection: sqlite3.Connection, filters: Filters, *, limit: int | None, after: str
) -> tuple[Entry, ...]:
    """Return the entries that pass, by id, those after an id, at most so many."""
    query, values = filters.query(after=after)
    ordered = f"{_SELECT}{query} ORDER BY {filters.order} LIMIT ?"
    found = connection.execute(ordered, (*values, -1 if limit is None else limit))
    return tuple(_entry(row) for row in found)


def count(connection: sqlite3.Connection, filters: Filters) -> int:
    """Return how many entries pass."""
    if filters.tag is not None or filters.name is not None or filters.others:
        query, values = filters.query()
        return int(connection.execute(f"SELECT count(*){query}", values).fetchone()[0])
    asked = {name: getattr(filters, name) for name in COUNTED}
    wanted = {name: value for name, value in asked.items() if value is not None}
    where = " AND ".join(f"{name} = ?" for name in wanted) or "1"
    kept = f"SELECT coalesce(sum(number), 0) FROM counts WHERE {where}"  # noqa: S608 - our own names
    return int(connection.execute(kept, tuple(wanted.values())).fetchone()[0])


def near(connection: sqlite3.Connection, asset_id: str) -> tuple[str, ...]:
    """Find up to 100 ids that share the longest prefix, of at least three letters, with this."""
    starts = [asset_id[:length] for length in range(len(asset_id), 2, -1)] or [asset_id]
    marks = ", ".join("?" for _ in starts)
    statement = f"SELECT id FROM assets WHERE id IN ({marks}) ORDER BY id DESC LIMIT 1"  # noqa: S608 - question marks
    shorter = connection.execute(statement, starts)
    found = [str(row[0]) for row in shorter]
    for start in starts:
        query = "SELECT id FROM assets WHERE id >= ? AND id < ? ORDER BY id LIMIT ?"
        rows = connection.execute(query, (start, start + _HIGHEST, _NEAR))
        longer = [str(row[0]) for row in rows]
        if longer:
            return (*found, *(each for each in longer if each not in found))
    return tuple(found)


def _entry(row: tuple[str | int | None, ...]) -> Entry:
    named = dict(zip(ENTRY_COLUMNS, row[:-1], strict=True))
    del named["split"]
    tags = str(row[-1]).split(",") if row[-1] is not None else ()
    return Entry(**named, tags=tuple(tags))  # type: ignore[arg-type]


def distinct(connection: sqlite3.Connection, column: str) -> tuple[str, ...]:
    """Return every value there is in a column of ours, sorted, but the empty one."""
    table = "tags" if column == "tag" else "assets"
    found = connection.execute(
        f"SELECT DISTINCT {column} FROM {table} WHERE {column} != '' ORDER BY {column}"  # noqa: S608 - our own names
    )
    return tuple(row[0] for row in found)
