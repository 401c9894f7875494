"""Databases of older versions, brought up to this one."""

from __future__ import annotations

from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import REPORT
from ..runtime.store import write_json
from .database import SCHEMA_VERSION, create_indices, create_tables, schema_version, writing
from .entry import lasting_data
from .folders import current_folder, read_record, read_report
from .notes import note_path
from .rows import Record, insert

_FIRST_COLUMNS = ("id", "name", "category", "status", "reason", "parts", "joints", "hulls")


def migrate(root: Path) -> None:
    """From version 1, which had fewer columns and no entry in its reports, to this one."""
    with writing(root) as connection:
        if schema_version(connection) >= SCHEMA_VERSION:
            return
        rows = connection.execute(
            f"SELECT {', '.join(_FIRST_COLUMNS)} FROM assets ORDER BY id"
        ).fetchall()
        records = [record for row in rows if (record := _completed(root, row)) is not None]
        connection.execute("DROP TABLE assets")
        create_tables(connection)
        create_indices(connection)
        insert(connection, records)


def _completed(root: Path, row: tuple[str | int, ...]) -> Record | None:
    """The row with what its folder knows, which is told the row; ``None`` if the folder is gone."""
    known = dict(zip(_FIRST_COLUMNS, row, strict=True))
    folder = current_folder(root, str(known["id"]))
    try:
        derived, report = read_record(folder, note_path(root, folder.name)), read_report(folder)[0]
    except RegistryError:
        return None
    if "entry" not in report:
        write_json(
            folder / REPORT,
            {**report, "entry": {**lasting_data(derived.entry), **known}},
            lasting=True,
        )
    return read_record(folder, note_path(root, folder.name))
