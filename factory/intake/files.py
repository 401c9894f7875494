"""The files of one input: below one folder, within one budget, digested as they are read."""

from __future__ import annotations

import os
import re
from pathlib import Path

from asset_factory.sim_checks.read.document import inside
from asset_factory.sim_checks.read.regular import open_regular

from ..config import IntakeConfig
from ..errors import InputRejected
from ..runtime.store import digest_bytes
from .limits import require_at_most, unreadable
from .reads import ABSENT, ReadLog

_SCHEME = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]+:")
_DRIVE = re.compile(r"^[A-Za-z]:")
_LARGEST_TEXTURES = 16
#: A picture takes time however small it is.
_PIXELS_OF_SMALLEST = 512 * 512
_LFS_POINTER = b"version https://git-lfs.github.com/spec/"


class InputFiles:
    """Reads an input and what it refers to.

    Args:
        root: nothing outside this folder is read, through symbolic links or otherwise.
        limits: ``max_bytes`` bounds all files together, ``max_texture_pixels`` each image.
        log: of the files that are read; one of its own by default.
    """

    def __init__(self, root: Path, limits: IntakeConfig, log: ReadLog | None = None) -> None:
        self.limits = limits
        self.log = log or ReadLog()
        self._root = root
        self._real_root = root.resolve()
        self._digests: list[str] = []
        self._cache: dict[Path, bytes] = {}
        self._bytes = 0
        self._pixels = 0

    @property
    def digests(self) -> tuple[str, ...]:
        """Return the SHA-256 of each file read, in that order."""
        return tuple(self._digests)

    @property
    def digest(self) -> str:
        """Return the SHA-256 over the files read, in that order; of one file, its own digest."""
        if len(self._digests) == 1:
            return self._digests[0]
        return digest_bytes("\n".join(self._digests).encode())

    def read(self, path: Path) -> bytes:
        """Return the content of ``path``.

        Raises:
            InputRejected: ``too_large``, or ``unreadable`` if it is no regular file.
            FileNotFoundError: there is no such file.
        """
        if path in self._cache:
            return self._cache[path]
        if not os.path.exists(path):
            self.log.note(path, ABSENT)
            raise FileNotFoundError(path.name)
        if not path.is_file():
            raise unreadable(path.name, "is not a regular file")
        with open_regular(path) as file:
            size = os.fstat(file.fileno()).st_size
            require_at_most(path.name, self._bytes + size, self.limits.max_bytes, "bytes")
            # Not what is written to it meanwhile: it may grow without end.
            data = file.read(size)
        if data.startswith(_LFS_POINTER):
            pointer = "is a Git LFS pointer, not the file itself; run git lfs pull"
            raise unreadable(path.name, pointer)
        self._bytes += len(data)
        self._digests.append(digest_bytes(data))
        self.log.note(path, self._digests[-1])
        self._cache[path] = data
        return data

    def spend_pixels(self, name: str, pixels: int) -> None:
        """Ask before decoding an image; the sum is bounded too, against decompression bombs.

        Raises:
            InputRejected: ``too_large``.
        """
        limit = self.limits.max_texture_pixels
        require_at_most(f"texture {name}", pixels, limit, "pixels")
        self._pixels += max(pixels, _PIXELS_OF_SMALLEST)
        most = _LARGEST_TEXTURES * limit
        require_at_most(f"all textures up to {name}", self._pixels, most, "pixels")

    def find(self, reference: str, base: Path) -> Path:
        """Return where ``reference``, as written in a file in folder ``base``, leads.

        Raises:
            InputRejected: ``external_reference`` if it leads outside the input's folder.
        """
        plain = reference.strip().replace("\\", "/")
        if not plain or "\0" in plain:
            raise unreadable(reference[:80] or "empty reference", "is not a file name")
        if _SCHEME.match(plain) or _DRIVE.match(plain) or plain.startswith("/"):
            raise _external(reference, "is absolute")
        path = base / plain
        if not inside(path, self._real_root):
            self.log.note_link_out(path, self._root)
            raise _external(reference, "leads outside the input's folder")
        return path

    def read_reference(self, reference: str, base: Path) -> bytes:
        """Return the content of a file referred to; raise as :meth:`find` and :meth:`read`."""
        return self.read(self.find(reference, base))


def _external(reference: str, why: str) -> InputRejected:
    advice = "put the file beside the input and name it relatively"
    said = f"reference {reference.strip()[:160]!r} {why}; {advice}"
    return InputRejected("external_reference", said)
