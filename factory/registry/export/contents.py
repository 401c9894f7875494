"""The files of an export, in a fixed order."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...errors import RegistryError
from ...runtime.layout import MANIFEST, NOTES, REPORT
from ...runtime.store import digest_bytes
from ..entry import Entry
from ..folders import read_record
from ..names import is_safe_path
from ..notes import note_path
from ..registry import Registry
from ..report_file import read_report
from .card import card_text, licenses_text
from .metadata import described, metadata_files

#: ``plain``: assets and lists. ``huggingface``: the same with a card and tables as its hub shows
#: them.
LAYOUTS = ("plain", "huggingface")
ENTRIES_NAME = "entries.jsonl"
SUMS_NAME = "SHA256SUMS"
LICENSES_NAME = "LICENSES.md"
CARD_NAME = "README.md"
#: Everything that an export may begin with.
TOP_NAMES = (
    "assets",
    "rejected",
    NOTES,
    "metadata",
    ENTRIES_NAME,
    SUMS_NAME,
    LICENSES_NAME,
    CARD_NAME,
)
_TRIES = 3


def contents(
    registry: Registry, entries: Iterable[Entry], layout: str = "plain"
) -> Iterator[tuple[str, bytes]]:
    """Yield an export's files, path and content; the last, ``SHA256SUMS``, has all digests.

    Others may use the registry meanwhile; assets no longer in it, or no longer passing, are left
    out.

    Raises:
        RegistryError: a file differs from the published one.
    """
    sums: list[tuple[str, str]] = []
    for name, data in _files(registry, entries, layout):
        sums.append((digest_bytes(data), name))
        yield name, data
    yield SUMS_NAME, "".join(f"{digest}  {name}\n" for digest, name in sums).encode()


def _files(
    registry: Registry, entries: Iterable[Entry], layout: str
) -> Iterator[tuple[str, bytes]]:
    exported: list[Entry] = []
    rows: list[dict[str, Any]] = []
    for listed in entries:
        found = _asset(registry, listed)
        if found is None:
            continue
        entry, files = found
        where = registry.folder(entry).relative_to(registry.root).as_posix()
        exported.append(entry)
        if layout == "huggingface":
            rows.append(described(entry, where, files.get(MANIFEST)))
        for name in sorted(files):
            yield f"{where}/{name}", files[name]
        note = note_path(registry.root, entry.id)
        if note.is_file():
            yield f"{NOTES}/{note.name}", note.read_bytes()
    yield ENTRIES_NAME, "".join(json.dumps(asdict(entry)) + "\n" for entry in exported).encode()
    tables = metadata_files(rows) if layout == "huggingface" else {}
    yield from sorted(tables.items())
    yield LICENSES_NAME, licenses_text(exported).encode()
    yield CARD_NAME, card_text(exported, tables).encode()


def _asset(registry: Registry, listed: Entry) -> tuple[Entry, dict[str, bytes]] | None:
    """Return the entry as its folder has it, and the content of each of its files."""
    for attempt in range(_TRIES):
        folder = registry.folder(listed)
        if not folder.is_dir():
            return None
        try:
            return read_record(folder, note_path(registry.root, listed.id)).entry, _whole(folder)
        except (RegistryError, OSError) as error:
            # Somebody may have published it anew between two files.
            if attempt == _TRIES - 1:
                raise RegistryError(f"{listed.id} cannot be exported: {error}") from error
    return None


def _whole(folder: Path) -> dict[str, bytes]:
    stored = read_report(folder)
    registered = {**stored.files, REPORT: stored.digest}
    files = {name: _content(folder, name) for name in registered}
    altered = sorted(name for name in files if digest_bytes(files[name]) != registered[name])
    if altered:
        raise RegistryError(f"{folder / altered[0]}: is not what was published (SHA-256)")
    return files


def _content(folder: Path, name: str) -> bytes:
    path = folder / name
    if not is_safe_path(name) or path.is_symlink():
        raise RegistryError(f"{path}: is no file of this asset")
    return path.read_bytes()
