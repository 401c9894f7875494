"""The files of an export, in a fixed order, with tables that can be read without the assets."""

from __future__ import annotations

import importlib
import io
import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any, Literal

from ...errors import RegistryError
from ...runtime.layout import ASSETS, MANIFEST, NOTES, REJECTED, REPORT
from ...runtime.store import digest_bytes
from ..entry import SPLITS, Entry
from ..folders import read_record
from ..notes import note_path
from ..registry import Registry
from ..report_file import read_report
from .card import card_text, licenses_text

#: ``plain``: assets and lists. ``huggingface``: the same with a card and tables as its hub shows
#: them.
Layout = Literal["plain", "huggingface"]
ENTRIES_NAME = "entries.jsonl"
SUMS_NAME = "SHA256SUMS"
LICENSES_NAME = "LICENSES.md"
CARD_NAME = "README.md"
_LISTS = (ENTRIES_NAME, SUMS_NAME, LICENSES_NAME, CARD_NAME)
#: Everything that an export may begin with.
TOP_NAMES = (ASSETS, REJECTED, NOTES, "metadata", *_LISTS)
_TRIES = 3
#: Longest name of a file or folder in an export, and longest path.
MAX_NAME = 255
MAX_PATH = 1024
#: What a row has of its entry.
_COLUMNS = (
    *("id", "name", "category", "split", "status", "reason", "message", "parts", "joints", "hulls"),
    *("license", "solved", "tags", "key"),
)


def contents(
    registry: Registry, entries: Iterable[Entry], layout: Layout = "plain"
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
    registry: Registry, entries: Iterable[Entry], layout: Layout
) -> Iterator[tuple[str, bytes]]:
    exported: list[Entry] = []
    rows: list[dict[str, Any]] = []
    for listed in entries:
        found = _asset(registry, listed)
        if found is None:
            continue
        entry, files = found
        exported.append(entry)
        if layout == "huggingface":
            rows.append(described(entry, files.get(MANIFEST)))
        for name, data in files.items():
            yield f"{entry.folder}/{name}", data
        note = note_path(registry.root, entry.id)
        if note.is_file():
            yield f"{NOTES}/{note.name}", note.read_bytes()
    yield ENTRIES_NAME, "".join(json.dumps(asdict(entry)) + "\n" for entry in exported).encode()
    tables = metadata_files(rows) if layout == "huggingface" else {}
    yield from sorted(tables.items())
    yield LICENSES_NAME, licenses_text(exported).encode()
    yield CARD_NAME, card_text(exported, tables).encode()


def _asset(registry: Registry, listed: Entry) -> tuple[Entry, dict[str, bytes]] | None:
    """Return the entry as its folder has it, and the content of each of its files, by name."""
    for attempt in range(_TRIES):
        folder = registry.folder(listed)
        if not folder.is_dir():
            return None
        try:
            return read_record(folder).entry, _whole(folder)
        except (RegistryError, OSError) as error:
            # Somebody may have published it anew between two files.
            if attempt == _TRIES - 1:
                raise RegistryError(f"{listed.id} cannot be exported: {error}") from error
    return None


def _whole(folder: Path) -> dict[str, bytes]:
    stored = read_report(folder)
    registered = {**stored.files, REPORT: stored.digest}
    files = {}
    for name, digest in sorted(registered.items()):
        path = folder / name
        if not is_safe_path(name) or path.is_symlink():
            raise RegistryError(f"{path}: is no file of this asset")
        files[name] = path.read_bytes()
        if digest_bytes(files[name]) != digest:
            raise RegistryError(f"{path}: is not what was published (SHA-256)")
    return files


def is_safe_path(name: str) -> bool:
    """Return whether a path stays in the folder that it is put into, on every system.

    Relative, with ``/`` between its parts, none of them empty, ``.`` or ``..``; no backslash, colon
    or control character.
    """
    if not 0 < len(name.encode("utf-8", "replace")) <= MAX_PATH or "\\" in name or ":" in name:
        return False
    if not name.isprintable():
        return False
    return all(
        part not in ("", ".", "..") and len(part.encode()) <= MAX_NAME for part in name.split("/")
    )


def described(entry: Entry, manifest: bytes | None) -> dict[str, Any]:
    """Return one row: the entry, where its files are in the export, and its manifest's physics."""
    folder = entry.folder
    data: dict[str, Any] = json.loads(manifest) if manifest is not None else {}
    lower, upper = data.get("closed_bounds") or ([0.0] * 3, [0.0] * 3)
    moving = [joint["kind"] for joint in data.get("joints", ()) if joint["kind"] != "fixed"]
    values = asdict(entry)
    return {
        **{name: list(values[name]) if name == "tags" else values[name] for name in _COLUMNS},
        "folder": folder,
        "urdf": f"{folder}/{data['urdf']}" if "urdf" in data else "",
        "mjcf": f"{folder}/{data['mjcf']}" if data.get("mjcf") else "",
        "joint_types": moving,
        "mass_kg": float(data.get("mass", 0.0)),
        "size_m": [round(b - a, 6) for a, b in zip(lower, upper, strict=True)],
    }


def metadata_files(rows: list[dict[str, Any]]) -> dict[str, bytes]:
    """Return one table per split that has assets: Parquet with pyarrow, else JSON lines."""
    try:
        writer: Any = importlib.import_module("pyarrow.parquet")
        arrow: Any = importlib.import_module("pyarrow")
    except ImportError:
        writer = arrow = None
    files = {}
    for split in SPLITS:
        chosen = [row for row in rows if row["split"] == split]
        if not chosen:
            continue
        if arrow is None:
            lines = "".join(json.dumps(row) + "\n" for row in chosen)
            files[f"metadata/{split}.jsonl"] = lines.encode()
        else:
            buffer = io.BytesIO()
            writer.write_table(arrow.Table.from_pylist(chosen, schema=_schema(arrow)), buffer)
            files[f"metadata/{split}.parquet"] = buffer.getvalue()
    return files


def _schema(arrow: Any) -> Any:
    """Return the types that do not depend on what the first rows happen to hold."""
    text = arrow.string()
    texts = arrow.list_(arrow.string())
    special = {
        **dict.fromkeys(("parts", "joints", "hulls"), arrow.int64()),
        **dict.fromkeys(("tags", "joint_types"), texts),
        "mass_kg": arrow.float64(),
        "size_m": arrow.list_(arrow.float64()),
    }
    names = (*_COLUMNS, "folder", "urdf", "mjcf", "joint_types", "mass_kg", "size_m")
    return arrow.schema([(name, special.get(name, text)) for name in names])
