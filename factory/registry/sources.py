"""Lists of entries, wherever they are written: a registry, an export's folder or archive."""

from __future__ import annotations

import json
import tarfile
from pathlib import Path
from typing import IO

from ..errors import RegistryError
from ..runtime.layout import DATABASE
from .entry import Entry, entry_from
from .export.contents import ENTRIES_NAME
from .registry import Registry

_MAX_LINE = 1_000_000


def entries_of(path: Path) -> tuple[Entry, ...]:
    """Return every entry, by id, of a registry's folder or an export's folder, archive or list.

    Raises:
        RegistryError: it is none of these, or cannot be read.
    """
    if (path / DATABASE).is_file():
        return tuple(Registry(path).walk())
    try:
        if (path / ENTRIES_NAME).is_file():
            path = path / ENTRIES_NAME
        if path.is_file() and path.suffix == ".jsonl":
            with path.open("rb") as stream:
                return _parsed(path, stream)
        if path.is_file():
            return _from_archive(path)
    except (OSError, EOFError, tarfile.TarError) as error:
        why = error.strerror if isinstance(error, OSError) else "no whole archive"
        raise RegistryError(f"{path}: cannot be read ({why})") from error
    raise RegistryError(f"{path}: neither a registry nor an export of one")


def _from_archive(path: Path) -> tuple[Entry, ...]:
    with tarfile.open(path) as archive:
        for member in archive:
            content = archive.extractfile(member) if member.name == ENTRIES_NAME else None
            if content is not None:
                with content:
                    return _parsed(path, content)
    want = "want an export as `factory registry export` writes it"
    raise RegistryError(f"{path}: no {ENTRIES_NAME} in it; {want}")


def _parsed(path: Path, stream: IO[bytes]) -> tuple[Entry, ...]:
    entries = []
    for number, line in enumerate(iter(lambda: stream.readline(_MAX_LINE + 1), b""), start=1):
        try:
            if len(line) > _MAX_LINE:
                raise ValueError("too long")
            entries.append(entry_from(json.loads(line)))
        except (ValueError, RecursionError) as error:
            raise RegistryError(f"{path}: entry {number} cannot be read ({error})") from error
    return tuple(sorted(entries, key=lambda entry: entry.id))
