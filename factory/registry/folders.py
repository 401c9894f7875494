"""What the folders say: the truth that rows are made from."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from asset_factory.sim_checks import Status

from ..errors import RegistryError
from ..runtime.layout import ASSETS, REJECTED, REPORT
from ..runtime.store import NOT_A_FILE, digest_bytes
from .entry import entry_from, is_id
from .notes import note_path, read_note
from .rows import RegistryRow

_MAX_JSON_BYTES = 256_000_000
_HEX_DIGITS = 64


def all_ids(root: Path) -> list[str]:
    """Names of everything that has a folder, sorted."""
    found = set()
    for place in (ASSETS, REJECTED):
        if (root / place).is_dir():
            with os.scandir(root / place) as items:
                found |= {
                    item.name
                    for item in items
                    if is_id(item.name) and item.is_dir(follow_symlinks=False)
                }
    return sorted(found)


def records(root: Path, ids: Sequence[str]) -> Iterator[RegistryRow | RegistryError]:
    """A record for each id, or what is wrong with its folder."""
    for asset_id in ids:
        try:
            yield read_record(current_folder(root, asset_id), note_path(root, asset_id))
        except RegistryError as error:
            yield error


def current_folder(root: Path, asset_id: str) -> Path:
    """Where an asset lies: with those that passed, or with the others.

    It lies in both only if a process died between putting it in one and taking it out of the other:
        the newer counts,
    and in doubt the rejection.
    """
    passed, rejected = (root / place / asset_id for place in (ASSETS, REJECTED))
    if not rejected.is_dir():
        return passed
    return passed if _written(passed) > _written(rejected) else rejected


def read_record(folder: Path, note: Path) -> RegistryRow:
    """The row of one folder.

    Raises:
        RegistryError: its report cannot be read, or is of another asset or place.
    """
    report, digest = read_report(folder)
    try:
        files = registered_files(report)
        noted = read_note(note)
        data = report["entry"]
        entry = entry_from(data, tags=noted.tags, solved=noted.solved_with(files))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RegistryError(f"{folder / REPORT}: {error}") from error
    if entry.id != folder.name:
        raise RegistryError(f"{folder / REPORT}: is of {entry.id!r}, not of its folder")
    if (entry.status is Status.PASSED) != (folder.parent.name == ASSETS):
        raise RegistryError(f"{folder}: is {entry.status}, which belongs in another folder")
    return RegistryRow(entry, digest)


def read_report(folder: Path) -> tuple[dict[str, Any], str]:
    """A folder's report and the SHA-256 of its file. Raises RegistryError if it cannot be read."""
    data, digest = _read_json(folder / REPORT)
    return data, digest


def registered_files(report: dict[str, Any]) -> dict[str, str]:
    """SHA-256 of an asset's files when it was registered, by path.

    Raises:
        ValueError: it has none, or they are no digests.
    """
    files = report.get("files")
    if not isinstance(files, dict) or not all(_is_digest(digest) for digest in files.values()):
        raise ValueError("its files are no digests")
    return files


def _is_digest(text: object) -> bool:
    return (
        isinstance(text, str) and len(text) == _HEX_DIGITS and set(text) <= set("0123456789abcdef")
    )


def _read_json(path: Path) -> tuple[dict[str, Any], str]:
    try:
        if path.is_symlink() or path.stat().st_size > _MAX_JSON_BYTES:
            raise RegistryError(
                f"{path}: {NOT_A_FILE} of at most {_MAX_JSON_BYTES // 1_000_000} MB"
            )
        content = path.read_bytes()
        data = json.loads(content, parse_constant=_no_number)
    except (OSError, ValueError, RecursionError) as error:
        raise RegistryError(f"{path}: cannot be read ({error})") from error
    if not isinstance(data, dict):
        raise RegistryError(f"{path}: is {type(data).__name__}, want an object")
    return data, digest_bytes(content)


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no JSON")


def _written(folder: Path) -> int:
    try:
        return (folder / REPORT).stat().st_mtime_ns
    except OSError:
        return -1
