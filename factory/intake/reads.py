"""Which files an input was made of: those read, and those looked for but missing."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from asset_factory.sim_checks.read.regular import open_regular

from ..runtime.store import digest_bytes, digest_file

Reads = dict[str, str]
"""Path relative to the input's folder -> SHA-256 of the content, or :data:`ABSENT`."""

ABSENT = ""
#: In place of a digest: a link leads out of the input's folder, and nothing was read.
OUTSIDE = "outside"

#: A larger file is refused before it is read, and a sparse one of any size costs nothing [bytes].
MOST_DIGESTED = 4 * 2**30
_HEAD_BYTES = 2**20

_OPEN: ContextVar[dict[Path, str] | None] = ContextVar("reads", default=None)


def note_read(path: Path, digest: str) -> None:
    """Record that ``path`` was read, with its SHA-256; ``ABSENT``: the file was not there."""
    noted = _OPEN.get()
    if noted is not None:
        # What was seen first is what the input was made of, unless it was not there then.
        noted[path] = noted.get(path, ABSENT) or digest


def note_link_out(path: Path, folder: Path) -> None:
    """Record that a link in an input's folder leads out of it; a real file may replace it."""
    if "\0" not in str(path) and Path(os.path.normpath(path)).is_relative_to(folder):
        note_read(path, OUTSIDE)


def digest_read(path: Path) -> str:
    """Return the SHA-256 of a file, noted as read. Raises OSError if it cannot be read."""
    digest = digest_file(path)
    note_read(path, digest)
    return digest


@contextmanager
def recorded(source: Path) -> Iterator[Reads]:
    """Record what is read for the input ``source``; filled on exit, also on errors."""
    noted: dict[Path, str] = {}
    reads: Reads = {}
    token = _OPEN.set(noted)
    try:
        yield reads
    finally:
        _OPEN.reset(token)
        folder = source.absolute().parent
        real = source.parent.resolve()
        for path, digest in noted.items():
            whole = path.absolute()
            base = folder if whole.is_relative_to(folder) else real
            reads[os.path.relpath(whole, base)] = digest


def unchanged(source: Path, reads: Mapping[str, str]) -> bool:
    """Return whether every file still is what it was, or still is not there."""
    return all(digest_now(source, name) == digest for name, digest in reads.items())


def digest_now(source: Path, name: str) -> str:
    """Return what one file of an input is now.

    Args:
        source: the input, which may itself be a link to anywhere.
        name: path relative to its folder, as in :data:`Reads`.
    """
    return OUTSIDE if leads_out(source, name) else content_digest(source.parent / name)


def leads_out(source: Path, name: str) -> bool:
    """Return whether a file of an input is a link to outside its folder; arguments as above."""
    if name == source.name:
        return False
    real = Path(os.path.realpath(source.parent / name))
    return not real.is_relative_to(os.path.realpath(source.parent))


def content_digest(path: Path) -> str:
    """Return the SHA-256 of a file as it is now; ``ABSENT`` if none is there or can be read.

    Of more than :data:`MOST_DIGESTED`, it is that of the size, and of how the file begins.
    """
    try:
        with open_regular(path) as file:
            size = os.fstat(file.fileno()).st_size
            if size > MOST_DIGESTED:
                return digest_bytes(f"{size} bytes ".encode() + file.read(_HEAD_BYTES))
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ABSENT
