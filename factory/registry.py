"""The permanent list: what passed, what was rejected and why.

A registry is a folder::

    registry.db              one row per input that has been judged
    assets/<id>/             a bundle that passed, with its report.json
    rejected/<id>/           the report of one that did not
    .staging/                half-made things; never read, removed when done

Publishing is one rename from the staging folder, then one row: a reader sees a whole asset or none.
"""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from asset_factory.sim_checks import Report

from .errors import RegistryError

SCHEMA_VERSION = 1
BUSY_TIMEOUT_S = 30.0


@dataclass(frozen=True)
class Entry:
    """One row: what became of one input.

    Attributes:
        id: name and the first digits of the input's digest.
        name: the input's name.
        category: of the object; empty if unknown.
        status: ``passed``, ``rejected`` or ``unjudged``.
        reason: code of the first hard finding; empty if it passed.
        parts, joints, hulls: how many parts, movable joints and convex pieces.
    """

    id: str
    name: str
    category: str
    status: str
    reason: str
    parts: int
    joints: int
    hulls: int


class Registry:
    """A folder of judged assets.

    Args:
        root: the output directory.
        create: make it if it is not there; otherwise a missing one raises RegistryError.
    """

    def __init__(self, root: Path, *, create: bool = False) -> None:
        self.root = root
        self._database = root / "registry.db"
        if create:
            for folder in (self.assets, self.rejected, self.staging):
                folder.mkdir(parents=True, exist_ok=True)
            with self._connect() as connection:
                _create_table(connection)
        elif not self._database.is_file():
            raise RegistryError(f"{root}: no registry here; `factory build --output {root} ...` makes one")

    @property
    def assets(self) -> Path:
        """Bundles that passed."""
        return self.root / "assets"

    @property
    def rejected(self) -> Path:
        """Reports of those that did not."""
        return self.root / "rejected"

    @property
    def staging(self) -> Path:
        """Half-made things, on the same file system as ``assets``."""
        return self.root / ".staging"

    @contextmanager
    def staging_folder(self) -> Iterator[Path]:
        """A fresh folder to build in; whatever is still in it afterwards is removed."""
        self.staging.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(dir=self.staging))
        folder.chmod(0o755)
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def publish(self, entry: Entry, bundle: Path, report: dict[str, Any]) -> Path:
        """Move a finished bundle into ``assets`` and list it.

        Args:
            entry: its row; ``status`` must be ``passed``.
            bundle: a folder from :meth:`staging_folder`; gone afterwards.
            report: JSON data, written into the bundle first.

        Returns:
            The asset's folder.
        """
        if entry.status != "passed":
            raise RegistryError(f"asset {entry.id!r}: status is {entry.status!r}, only 'passed' is published")
        write_json(bundle / "report.json", report)
        _sync_tree(bundle)
        folder = self.assets / entry.id
        self._replace(folder, bundle)
        self._discard(self.rejected / entry.id)
        self._record(entry)
        return folder

    def reject(self, entry: Entry, report: dict[str, Any]) -> Path:
        """Keep the report of an input that did not pass, and list it. Returns the report's folder."""
        with self.staging_folder() as staging:
            content = staging / entry.id
            content.mkdir()
            write_json(content / "report.json", report)
            _sync_tree(content)
            folder = self.rejected / entry.id
            self._replace(folder, content)
        self._discard(self.assets / entry.id)
        self._record(entry)
        return folder

    def forget(self, asset_id: str, *, except_id: str = "") -> None:
        """Drop an entry and its files, if there is one and it is not ``except_id``."""
        if asset_id == except_id:
            return
        with self._connect() as connection:
            connection.execute("DELETE FROM assets WHERE id = ?", (asset_id,))
        self._discard(self.assets / asset_id)
        self._discard(self.rejected / asset_id)

    def entries(self) -> tuple[Entry, ...]:
        """All rows, by id."""
        columns = ", ".join(field.name for field in fields(Entry))
        with self._connect() as connection:
            rows = connection.execute(f"SELECT {columns} FROM assets ORDER BY id").fetchall()  # noqa: S608
        return tuple(Entry(*row) for row in rows)

    def entry(self, asset_id: str) -> Entry:
        """The row of that id. Raises RegistryError that names similar ids."""
        entries = {entry.id: entry for entry in self.entries()}
        if asset_id not in entries:
            near = [known for known in entries if known.startswith(asset_id) or asset_id.startswith(known)]
            hint = f"; did you mean {', '.join(near[:3])}?" if near else f"; `factory list` shows all {len(entries)}"
            raise RegistryError(f"no asset {asset_id!r} in {self.root}{hint}")
        return entries[asset_id]

    def folder(self, entry: Entry) -> Path:
        """Where an entry's files lie."""
        return (self.assets if entry.status == "passed" else self.rejected) / entry.id

    def report(self, entry: Entry) -> Report:
        """The report an entry was judged by."""
        return Report.from_dict(json.loads((self.folder(entry) / "report.json").read_text()))

    @contextmanager
    def _connect(self) -> Iterator[sqlite3.Connection]:
        with closing(sqlite3.connect(self._database, timeout=BUSY_TIMEOUT_S)) as connection, connection:
            connection.execute("PRAGMA journal_mode=WAL")
            yield connection

    def _record(self, entry: Entry) -> None:
        row = asdict(entry)
        names, marks = ", ".join(row), ", ".join("?" for _ in row)
        with self._connect() as connection:
            connection.execute(f"INSERT OR REPLACE INTO assets ({names}) VALUES ({marks})", tuple(row.values()))  # noqa: S608

    def _replace(self, folder: Path, content: Path) -> None:
        self._discard(folder)
        os.rename(content, folder)
        _sync_folder(folder.parent)

    def _discard(self, folder: Path) -> None:
        """Take a folder out of sight in one rename, then remove it."""
        if folder.exists():
            with self.staging_folder() as staging:
                os.rename(folder, staging / folder.name)


def write_json(path: Path, data: object) -> None:
    """Write JSON so that a reader sees the old file or the new one, never half of it."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".writing-")
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(json.dumps(data, indent=2, allow_nan=False) + "\n")
    Path(temporary).chmod(0o644)
    os.replace(temporary, path)


def _create_table(connection: sqlite3.Connection) -> None:
    connection.execute(
        "CREATE TABLE IF NOT EXISTS assets (id TEXT PRIMARY KEY, name TEXT NOT NULL, category TEXT NOT NULL, "
        "status TEXT NOT NULL, reason TEXT NOT NULL, parts INTEGER NOT NULL, joints INTEGER NOT NULL, "
        "hulls INTEGER NOT NULL)"
    )
    connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION}")


def _sync_tree(folder: Path) -> None:
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())
    _sync_folder(folder)


def _sync_folder(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
