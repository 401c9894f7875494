"""Which files an input was made of: those read, and those looked for but missing."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
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


class ReadLog:
    """The files that were read for one input, and those looked for but missing."""

    def __init__(self) -> None:
        self._digests: dict[Path, str] = {}

    def note(self, path: Path, digest: str) -> None:
        """Note that a file was read, with its SHA-256; ``ABSENT``: it was not there."""
        # What was seen first is what the input was made of, unless it was not there then.
        self._digests[path] = self._digests.get(path, ABSENT) or digest

    def note_link_out(self, path: Path, folder: Path) -> None:
        """Note that a link in an input's folder leads out of it; a real file may replace it."""
        if "\0" not in str(path) and Path(os.path.normpath(path)).is_relative_to(folder):
            self.note(path, OUTSIDE)

    def digest(self, path: Path) -> str:
        """Return SHA-256 of a file, and note it as read. Raises OSError if it cannot be read."""
        digest = digest_file(path)
        self.note(path, digest)
        return digest

    def reads_of(self, source: Path) -> Reads:
        """Return the notes, by paths relative to the folder of the input ``source``."""
        folder = source.absolute().parent
        real = source.parent.resolve()
        reads = {}
        for path, digest in self._digests.items():
            whole = path.absolute()
            base = folder if whole.is_relative_to(folder) else real
            reads[os.path.relpath(whole, base)] = digest
        return reads


def unchanged(source: Path, reads: Mapping[str, str]) -> bool:
    """Return whether every file still is what it was, or still is not there."""
    return all(digest_now(source, name) == digest for name, digest in reads.items())


def digest_now(source: Path, name: str) -> str:
    """Return what one file of an input, by its path relative to the input's folder, is now.

    The input itself may be a link to anywhere.
    """
    return OUTSIDE if leads_out(source, name) else content_digest(source.parent / name)


def leads_out(source: Path, name: str) -> bool:
    """Return whether a file of an input is a link to outside its folder; arguments as above.

    What lies in the folder of another root was allowed by its path.
    """
    if name == source.name or name.startswith(".."):
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
