"""Entries in and out of the database."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass

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
    """A column of the table compared with a value.

    Attributes:
        column: of our own: an entry's field, ``gpu_ready``, or ``tag`` for one of its tags.
        operator: of SQL, by which they are compared.
        value: to compare with.
    """

    column: str
    operator: str
    value: str | int


def having(**values: str | None) -> tuple[Condition, ...]:
    """Return the conditions that columns have these values; ``None`` lets everything pass."""
    asked = values.items()
    return tuple(Condition(column, "=", value) for column, value in asked if value is not None)


def _query(conditions: Sequence[Condition]) -> tuple[str, list[str | int]]:
    """Return what follows SELECT columns: the tables, the conditions, and their values."""
    equal = frozenset(each.column for each in conditions if each.operator == "=")
    of_tags = ("tag", "id") if "tag" in equal else ()
    said = [
        f"{'tags' if each.column in of_tags else 'assets'}.{each.column} {each.operator} ?"
        for each in conditions
    ]
    where = f" WHERE {' AND '.join(said)}" if said else ""
    return f" FROM {_walked(equal)}{where}", [each.value for each in conditions]


def _walked(equal: frozenset[str]) -> str:
    """Name the table, and its narrowest index that gives rows in the order of ids."""
    if "tag" in equal:
        return "tags CROSS JOIN assets ON assets.id = tags.id"
    index = next((names for names in INDICES if equal.issuperset(names)), None)
    if index is not None:
        return f"assets INDEXED BY {index_name(index)}"
    # Left alone, SQLite may take an index that it has to sort.
    return "assets NOT INDEXED" if equal else "assets"


def insert(connection: sqlite3.Connection, record: RegistryRow) -> None:
    """Write a row, over that of the same id."""
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
    connection: sqlite3.Connection, wanted: Sequence[Condition], *, limit: int | None, after: str
) -> tuple[Entry, ...]:
    """Return the entries that pass, by id, those after an id, at most so many."""
    later = (Condition("id", ">", after),) if after else ()
    query, values = _query((*wanted, *later))
    # The table that is walked comes in this order.
    walked = "tags" if any(each.column == "tag" for each in wanted) else "assets"
    ordered = f"{_SELECT}{query} ORDER BY {walked}.id LIMIT ?"
    found = connection.execute(ordered, (*values, -1 if limit is None else limit))
    return tuple(_entry(row) for row in found)


def count(connection: sqlite3.Connection, conditions: Sequence[Condition]) -> int:
    """Return how many entries pass."""
    if any(each.operator != "=" or each.column not in COUNTED for each in conditions):
        query, values = _query(conditions)
        return int(connection.execute(f"SELECT count(*){query}", values).fetchone()[0])
    where = " AND ".join(f"{each.column} = ?" for each in conditions) or "1"
    kept = f"SELECT coalesce(sum(number), 0) FROM counts WHERE {where}"  # noqa: S608 - our own names
    found = connection.execute(kept, [each.value for each in conditions])
    return int(found.fetchone()[0])


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
