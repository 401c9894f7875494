"""The registry: validated assets in, validated assets out."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from asset_factory.sim_checks import Status

from ..errors import RegistryError
from ..runtime.layout import ASSETS, MANIFEST, REJECTED, REPORT, STAGING
from . import rows
from .claims import held_folder
from .database import connected, writing
from .entry import SOLVED, Entry, Solved, entry_from, lasting_data, require_tags
from .folders import folders_of, read_record
from .notes import fingerprint, note_path, read_note, write_note
from .placing import place, remove, sync_tree
from .rebuild import make_registry, open_registry
from .report_file import BuildReport, file_digests, read_report, write_report
from .rows import Condition

if TYPE_CHECKING:
    from ..export.manifest import Manifest

_PAGE = 1000
_TRIES = 3
_MAX_MANIFEST = 16_000_000


class Registry:
    """A folder of validated assets, which several processes may read and write at once.

    Args:
        create: make it if it is not there; otherwise a missing one raises RegistryError.

    Raises:
        RegistryError: no registry there, a damaged database, or one that a newer program made.
    """

    def __init__(self, root: Path, *, create: bool = False) -> None:
        self.root = root
        if create:
            make_registry(root)
        else:
            open_registry(root)

    @property
    def assets(self) -> Path:
        """Return the bundles that passed."""
        return self.root / ASSETS

    @property
    def rejected(self) -> Path:
        """Return the reports of those that did not."""
        return self.root / REJECTED

    def staging_folder(self) -> AbstractContextManager[Path]:
        """Return a fresh folder to build in; whatever is still in it afterwards is removed.

        It is on the file system of ``assets``, and locked while the process lives, so that
        ``factory gc`` can tell what dead ones left.
        """
        return held_folder(self.root / STAGING)

    def add(self, entry: Entry, told: BuildReport, content: Path | None = None) -> Path:
        """Keep an input's bundle or its rejection, by its status, and list it.

        The same bytes again change nothing. Others take the place of the old ones at once, so that
        a reader finds the old asset or the new one.

        Args:
            entry: its row. Its tags and ``solved`` are those that were noted.
            told: written into its folder with the digests of the files there and the entry.
            content: a folder from :meth:`staging_folder`, gone afterwards: the finished bundle of
                an input that passed; of another one the files to keep beside the report, if any.

        Returns:
            Its folder, in ``assets`` or ``rejected``. Raises RegistryError for an input that passed
            and has no content.
        """
        folder = self.folder(entry)
        other = (self.rejected if folder.parent == self.assets else self.assets) / entry.id
        with self.staging_folder() as staging:
            if content is None:
                if entry.status is Status.PASSED:
                    raise RegistryError(f"asset {entry.id!r}: has passed, and has no files")
                content = staging / "content"
                content.mkdir()
            files = file_digests(content)
            entry = _lasting(entry)
            write_report(content, entry, told, files)
            sync_tree(content)
            with writing(self.root) as connection:
                # The old place is emptied after the row points to the new one: a row's folder is
                # always there.
                if other.exists() or not _same(content, folder, files):
                    place(content, folder)
                rows.insert(connection, read_record(folder))
            remove(content)
            if other.exists():
                os.rename(other, staging / "other")
        return folder

    def note(
        self, asset_id: str, *, tags: Sequence[str] | None = None, solved: Solved | None = None
    ) -> Entry:
        """Note something of an asset; ``None`` leaves a field as it was.

        Args:
            asset_id: its id.
            tags: all that it shall have.
            solved: ``yes`` or ``no``: whether a robot opened one of its joints; empty for unknown.
                It is forgotten when the asset is published anew with other files.

        Returns:
            The entry as it is now. Raises RegistryError for an unknown id or a tag that cannot be
            one.
        """
        require_tags(tuple(tags or ()))
        if solved is not None and solved not in SOLVED:
            known = ", ".join(map(repr, SOLVED))
            raise RegistryError(f"solved must be one of {known}, not {solved!r}")
        with writing(self.root) as connection:
            folder = self.folder(self._entry(connection, asset_id))
            path = note_path(self.root, asset_id)
            noted = read_note(path)
            if tags is not None:
                noted = replace(noted, tags=tuple(tags))
            if solved is not None:
                tried = fingerprint(read_report(folder).files) if solved else ""
                noted = replace(noted, solved=solved, solved_files=tried)
            write_note(path, noted)
            record = read_record(folder)
            rows.insert(connection, record)
        return record.entry

    def forget(self, asset_id: str, *, except_id: str = "") -> None:
        """Drop an entry and its files, if there is one and it is not ``except_id``."""
        if asset_id == except_id or (
            self.find(asset_id) is None and not folders_of(self.root, asset_id)
        ):
            return
        with self.staging_folder() as staging, self.unlisted(asset_id) as folders:
            if folders is None:
                return
            for number, folder in enumerate(folders):
                os.rename(folder, staging / str(number))
            note_path(self.root, asset_id).unlink(missing_ok=True)

    @contextmanager
    def unlisted(self, asset_id: str) -> Iterator[list[Path] | None]:
        """Drop a row for good, and yield the asset's folders, to be moved while nobody publishes.

        ``None`` if somebody published it anew meanwhile. As the row goes first, no reader is sent
        to a folder that is gone.
        """
        with writing(self.root) as connection:
            rows.delete(connection, asset_id)
        with writing(self.root) as connection:
            again = rows.find(connection, "id", asset_id) is not None
            yield None if again else folders_of(self.root, asset_id)

    def entries(
        self,
        conditions: Sequence[Condition] = (),
        *,
        limit: int | None = None,
        after: str = "",
        **wanted: str,
    ) -> tuple[Entry, ...]:
        """Return the rows that meet every condition, by id; all of them by default.

        ``wanted`` are columns with the values that they shall have, see :class:`~.rows.Condition`;
        with ``limit``, and the last id as ``after``, rows come page by page.
        """
        with connected(self.root) as connection:
            asked = (*conditions, *rows.having(**wanted))
            return rows.select(connection, asked, limit=limit, after=after)

    def walk(self, conditions: Sequence[Condition] = ()) -> Iterator[Entry]:
        """Yield the same, one after the other, however many there are."""
        after = ""
        while page := self.entries(conditions, limit=_PAGE, after=after):
            yield from page
            after = page[-1].id

    def count(self, conditions: Sequence[Condition] = ()) -> int:
        """Return how many rows pass."""
        with connected(self.root) as connection:
            return rows.count(connection, conditions)

    def values(self, column: str) -> tuple[str, ...]:
        """Return every value that entries have in a column, sorted, but the empty one."""
        with connected(self.root) as connection:
            return rows.distinct(connection, column)

    def find(self, asset_id: str) -> Entry | None:
        """Return the row of that id, if there is one."""
        with connected(self.root) as connection:
            return rows.find(connection, "id", asset_id)

    def entry(self, asset_id: str) -> Entry:
        """Return the row of that id. Raises RegistryError that names similar ids."""
        with connected(self.root) as connection:
            return self._entry(connection, asset_id)

    def named(self, text: str) -> Entry:
        """Return the row of that id, or the only one whose id begins so.

        Raises:
            RegistryError: there is none, or there are several; names similar ids.
        """
        with connected(self.root) as connection:
            begun = [known for known in rows.near(connection, text) if known.startswith(text)]
            unique = len(begun) == 1 and text and text not in begun
            return self._entry(connection, begun[0] if unique else text)

    def known_keys(self, keys: Sequence[str]) -> dict[str, Entry]:
        """Find the entries that were made from exactly this, by key, if their files are there."""
        with connected(self.root) as connection:
            found = {key: rows.find(connection, "key", key) for key in keys if key}
        listed = ((key, entry) for key, entry in found.items() if entry is not None)
        return {key: e for key, e in listed if (self.folder(e) / REPORT).is_file()}

    def folder(self, entry: Entry) -> Path:
        """Return where an entry's files lie."""
        return self.root / entry.folder

    def told(self, entry: Entry) -> BuildReport:
        """Return an entry's report and repairs. Raises RegistryError if they are gone."""
        for _ in range(_TRIES):
            try:
                return read_report(self.folder(entry)).told
            except RegistryError:
                # It may have been validated again, and lie elsewhere now.
                entry = self.entry(entry.id)
        return read_report(self.folder(entry)).told

    def _entry(self, connection: sqlite3.Connection, asset_id: str) -> Entry:
        entry = rows.find(connection, "id", asset_id)
        if entry is not None:
            return entry
        candidates = rows.near(connection, asset_id)
        near = [c for c in candidates if c.startswith(asset_id) or asset_id.startswith(c)]
        near = near or get_close_matches(asset_id, candidates)
        hint = f"; did you mean {', '.join(near[:3])}?" if near else ""
        hint = hint or f"; `factory list` shows all {rows.count(connection, ())}"
        raise RegistryError(f"no asset {asset_id!r} in {self.root}{hint}")


def read_manifest(folder: Path) -> Manifest | None:
    """Return the manifest in an asset's folder; ``None`` where there is none that can be read."""
    # What writes assets loads SciPy, which `factory --help` has no need of.
    from ..export.manifest import Manifest

    path = folder / MANIFEST
    try:
        if path.is_symlink() or path.stat().st_size > _MAX_MANIFEST:
            return None
        return Manifest.from_json(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return None


def _lasting(entry: Entry) -> Entry:
    """Return an entry without its notes. Raises RegistryError if it cannot be one."""
    try:
        return entry_from(lasting_data(entry))
    except ValueError as error:
        raise RegistryError(str(error)) from error


def _same(content: Path, folder: Path, files: dict[str, str]) -> bool:
    """Return whether a folder already holds these very bytes."""
    try:
        if (folder / REPORT).read_bytes() != (content / REPORT).read_bytes():
            return False
        return file_digests(folder) == files
    except OSError:
        return False
