"""A disposable, content-addressed cache: results of expensive stages, by what went into them."""

from __future__ import annotations

import hashlib
import io
import json
import os
import stat
import tempfile
import time
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, is_dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from asset_factory.sim_checks.processes.scratch import hold

#: In place of the digest of what is no regular file.
NOT_A_FILE = "not a file"
#: For how long nobody takes away what was used [s].
RECENT_S = 3600.0
#: In a file of arrays: names of those that are equal to another, with that one's.
_SAME = "same as"
#: How files begin that are still being written.
WRITING_PREFIX = ".writing-"


def digest_bytes(data: bytes) -> str:
    """Return SHA-256 of some bytes, as hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def digest_file(path: Path) -> str:
    """Return SHA-256 of a file's content, as hexadecimal. Raises OSError if it cannot be read."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def stage_key(stage: str, *inputs: object) -> str:
    """Return the name under which a stage's result is kept.

    Args:
        stage: e.g. ``decompose``.
        inputs: everything the result depends on: arrays, dataclasses, strings, numbers, library
            versions, digests of code.
    """
    digest = hashlib.sha256(stage.encode())
    for item in inputs:
        digest.update(_fingerprint(item))
    return f"{stage}-{digest.hexdigest()}"


def _fingerprint(item: object) -> bytes:
    if isinstance(item, np.ndarray):
        header = f"array {item.dtype.str} {item.shape} ".encode()
        return header + np.ascontiguousarray(item).tobytes()
    if is_dataclass(item) and not isinstance(item, type):
        item = asdict(item)
    return f"json {json.dumps(item, sort_keys=True)} ".encode()


def folder_digests(folder: Path, *, without: tuple[str, ...] = ()) -> dict[str, str]:
    """Return SHA-256 of every file below a folder, by path within it, sorted.

    A link, a pipe and the like has ``not a file`` in place of a digest, so
    that it equals no registered file. Raises OSError if something cannot be read.

    Args:
        folder: it must exist.
        without: paths within it that do not count.
    """
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if name in without or (path.is_dir() and not path.is_symlink()):
            continue
        found[name] = digest_file(path) if path.is_file() and not path.is_symlink() else NOT_A_FILE
    return found


def write_whole(path: Path, data: bytes, *, lasting: bool = False) -> None:
    """Write a file so that a reader sees all of it or the old one. Its folder must exist.

    Args:
        path: the file.
        data: its content.
        lasting: return only when it is on the disk, for what cannot be made again.

    Raises:
        OSError: e.g. the disk is full; the old file is untouched, and nothing half-written is
            left.
    """
    with writing(path, lasting=lasting) as file:
        file.write(data)


@contextmanager
def writing(path: Path, *, lasting: bool = False) -> Iterator[BinaryIO]:
    """Yield a file that becomes ``path`` when the block ends well; for content too large for bytes.

    Everything else as in :func:`write_whole`.
    """
    handle, temporary = _begun(path.parent)
    try:
        # By name, so that a library which writes to a path alone can be told it.
        with open(temporary, "wb", opener=lambda _path, _flags: handle) as file:
            yield file
            os.fchmod(file.fileno(), 0o644)
            if lasting:
                file.flush()
                os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    if lasting:
        sync_folder(path.parent)


def _begun(folder: Path) -> tuple[int, str]:
    """Make a file, locked while its process lives, so that cleaning sees it is being written."""
    while True:
        handle, name = tempfile.mkstemp(dir=folder, prefix=WRITING_PREFIX)
        if hold(Path(name), handle):
            return handle, name


def write_json(path: Path, data: object, *, lasting: bool = False) -> None:
    """Write JSON as :func:`write_whole` does. Raises ValueError for NaN and infinity."""
    write_whole(
        path, (json.dumps(data, indent=2, allow_nan=False) + "\n").encode(), lasting=lasting
    )


def sync_folder(folder: Path) -> None:
    """Have the names in a folder on the disk."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@dataclass(frozen=True)
class Trimmed:
    """Removed files: how many, of how many bytes."""

    files: int = 0
    bytes: int = 0


class Store:
    """Arrays by key, in one folder. Losing it costs time, never data.

    Args:
        root: created when first written to.
    """

    def __init__(self, root: Path) -> None:
        self.root = root

    def load(self, key: str) -> dict[str, npt.NDArray[Any]] | None:
        """Return the arrays kept under ``key``; ``None``: there are none or the file is damaged."""
        path = self._path(key)
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
                arrays = {name: archive[name] for name in archive.files}
            for name, first in arrays.pop(_SAME, ()):
                arrays[str(name)] = arrays[str(first)]
        except (OSError, ValueError, KeyError, zipfile.BadZipFile, zlib.error, EOFError):
            return None
        # What was asked for last goes last; a cache that cannot be written to is still one.
        with suppress(OSError):
            os.utime(path)
        return arrays

    def save(self, key: str, arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        """Keep ``arrays`` under ``key``. A reader sees all of it or nothing.

        Equal arrays are written once, and all of them packed, quickly rather than well: hypotheses
        of one mesh share most of it, and a cache is as large as the disk lets it be.
        """
        path = self._path(key)
        path.parent.mkdir(parents=True, exist_ok=True)
        firsts: dict[tuple[str, tuple[int, ...], bytes], str] = {}
        same: list[tuple[str, str]] = []
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
            for name, array in arrays.items():
                told = (array.dtype.str, array.shape, hashlib.sha256(array.tobytes()).digest())
                first = firsts.setdefault(told, name)
                if first == name:
                    _write_array(archive, name, array)
                else:
                    same.append((name, first))
            if same:
                _write_array(archive, _SAME, np.array(same))
        write_whole(path, buffer.getvalue())

    def size(self) -> Trimmed:
        """Return how many files there are, and their size."""
        sizes = [size for _, size, _ in _used(self.root)]
        return Trimmed(len(sizes), sum(sizes))

    def trim(self, *, older_than_s: float | None = None, keep_bytes: int | None = None) -> Trimmed:
        """Remove files long unused, then the least recently used until the rest is small.

        Files used within the last hour stay: they may belong to a running job.

        Args:
            older_than_s: remove what nobody used for so long [s]; ``None``: however old.
            keep_bytes: how much may stay [bytes]; ``None``: any amount.
        """
        now = time.time()
        # A clock that was wrong once has marked files as from the future: as far away as the past.
        found = sorted(
            ((abs(now - used), size, path) for used, size, path in _used(self.root)), reverse=True
        )
        left = sum(size for _, size, _ in found)
        freed = Trimmed()
        for age, size, path in found:
            old = older_than_s is not None and age > older_than_s
            if age < RECENT_S or not (old or (keep_bytes is not None and left > keep_bytes)):
                continue
            with suppress(OSError):
                path.unlink()
                left -= size
                freed = Trimmed(freed.files + 1, freed.bytes + size)
        return freed

    def _path(self, key: str) -> Path:
        return self.root / key[-2:] / f"{key}.npz"


def _write_array(archive: zipfile.ZipFile, name: str, array: npt.NDArray[Any]) -> None:
    # Members have a time of their own, which equal results shall not differ by.
    member = zipfile.ZipInfo(f"{name}.npy")
    member.compress_type = zipfile.ZIP_DEFLATED
    with archive.open(member, "w", force_zip64=True) as file:
        np.lib.format.write_array(file, np.asanyarray(array), allow_pickle=False)


def _used(root: Path) -> Iterator[tuple[float, int, Path]]:
    """Yield when each file of a cache was last used [s since 1970], its size [bytes], its path."""
    for path in root.rglob("*"):
        with suppress(OSError):
            status = path.lstat()
            if stat.S_ISREG(status.st_mode):
                yield status.st_mtime, status.st_size, path
