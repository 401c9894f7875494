"""An export's files, from archive or folder, into a folder of ours: regular, safe names."""

from __future__ import annotations

import gzip
import os
import re
import shutil
import stat
import struct
import tarfile
import zlib
from pathlib import Path
from typing import IO, Any

from ...errors import RegistryError
from ..export.contents import SUMS_NAME, TOP_NAMES, is_safe_path

#: What the reader of archives raises besides its own errors when headers are nonsense.
_TAR_BUGS = (ValueError, IndexError, KeyError, OverflowError, struct.error)
_BLOCK = 512
_CHUNK = 1 << 20
#: Longer headers than this describe nothing that we write.
_MAX_HEADER = 65_536
_FILES = (tarfile.REGTYPE, tarfile.AREGTYPE)
_FOLDERS = (tarfile.DIRTYPE,)
_HEADERS = (tarfile.XHDTYPE, tarfile.GNUTYPE_LONGNAME)
#: A line of the list of digests, as ``sha256sum`` writes and checks it.
_LINE = re.compile(r"([0-9a-f]{64})  ([^\n]+)")
_MAX_SUMS = 2_000_000_000
#: Size of one file [bytes], and how many there are.
MOST_FILE_BYTES = 4_000_000_000
MOST_FILES = 5_000_000
#: Size of all files together, unless somebody allows more [bytes].
MOST_BYTES = 200_000_000_000


class Tally:
    """Counts files against limits; ``bytes`` is the size of all so far, at most ``most_bytes``."""

    def __init__(self, source: Path, most_bytes: int) -> None:
        self._source = source
        self._most_bytes = most_bytes
        self._files = self.bytes = 0

    def add(self, name: str, size: int) -> None:
        """Count one more file. Raises RegistryError if it is too large, or one too many."""
        self._files += 1
        self.bytes += size
        if not 0 <= size <= MOST_FILE_BYTES:
            most = f"want at most {MOST_FILE_BYTES}"
            raise RegistryError(f"{self._source}: {name!r} has {size} bytes, {most}")
        if self._files > MOST_FILES:
            raise RegistryError(f"{self._source}: more than {MOST_FILES} files")
        _require_within(self._source, self.bytes, self._most_bytes)


def unpack(source: Path, target: Path, most_bytes: int) -> None:
    """Copy an export's files, of so many bytes together at most.

    ``source`` is a folder, or a .tar or .tar.gz file; ``target`` an empty folder.

    Raises:
        RegistryError: it is no export, too large, or has something that no export has: links,
            devices, paths that lead elsewhere, a file twice.
    """
    try:
        if source.is_dir():
            _copy_folder(source, target, most_bytes)
        elif source.is_file():
            _unpack_archive(source, target, most_bytes)
        else:
            advice = "`factory registry export` writes one"
            raise RegistryError(f"{source}: no such file or folder; {advice}")
    except (OSError, EOFError, zlib.error, tarfile.TarError, *_TAR_BUGS) as error:
        raise RegistryError(f"{source}: cannot be unpacked ({error})") from error


def _copy_folder(source: Path, target: Path, most_bytes: int) -> None:
    """Copy what the list of digests names; whatever else lies there is not part of the export."""
    tally = Tally(source, most_bytes)
    root = source.resolve()
    for name in (*read_sums(source / SUMS_NAME), SUMS_NAME):
        _require_safe(source, name)
        path = source / name
        if not path.resolve().is_relative_to(root) or not stat.S_ISREG(path.lstat().st_mode):
            raise RegistryError(f"{source}: {name!r} is no file but a link or a device")
        tally.add(name, path.stat().st_size)
        _require_room(target, path.stat().st_size)
        with path.open("rb") as stream:
            _write(target / name, stream, path.stat().st_size)


def _unpack_archive(source: Path, target: Path, most_bytes: int) -> None:
    plain = source
    with source.open("rb") as stream:
        compressed = stream.read(2) == b"\x1f\x8b"
    if compressed:
        plain = target.with_name(f"{target.name}.tar")
        _decompress(source, plain, most_bytes)
    with plain.open("rb") as stream:
        _require_room(target, _scan(source, stream, most_bytes))
        stream.seek(0)
        # The reader may put together other sizes from several headers than the scan saw: counted
        # again.
        _extract(source, stream, target, Tally(source, most_bytes))
    if compressed:
        plain.unlink()


def _extract(source: Path, stream: IO[bytes], target: Path, tally: Tally) -> None:
    with tarfile.open(fileobj=stream, mode="r:") as opened:
        archive: Any = opened
        while (member := archive.next()) is not None:
            _require_safe(source, member.name)
            if member.type in _FILES and not member.issparse():
                tally.add(member.name, member.size)
                with archive.extractfile(member) as content:
                    _write(target / member.name, content, member.size)
            elif member.type not in _FOLDERS:
                raise RegistryError(f"{source}: {member.name!r} is no file but a link or a device")
            # It remembers every member otherwise.
            archive.members = []


def _scan(source: Path, stream: IO[bytes], most_bytes: int) -> int:
    """Check every header of an archive before extraction; returns the size of its files [bytes]."""
    tally = Tally(source, most_bytes)
    end = os.fstat(stream.fileno()).st_size
    while block := stream.read(_BLOCK):
        if block.count(0) == _BLOCK:
            break
        header = tarfile.TarInfo.frombuf(block, "utf-8", "surrogateescape")
        if header.size < 0:
            raise RegistryError(f"{source}: {header.name!r} has {header.size} bytes")
        if header.type in _HEADERS:
            if header.size > _MAX_HEADER:
                most = f"want at most {_MAX_HEADER}"
                raise RegistryError(f"{source}: a header of {header.size} bytes, {most}")
        elif header.type in _FILES:
            tally.add(header.name, header.size)
        elif header.type not in _FOLDERS:
            raise RegistryError(f"{source}: {header.name!r} is no file but a link or a device")
        following = stream.tell() + -(-header.size // _BLOCK) * _BLOCK
        if following > end:
            raise RegistryError(f"{source}: ends within {header.name!r}")
        stream.seek(following)
    return tally.bytes


def _decompress(source: Path, target: Path, most_bytes: int) -> None:
    written = 0
    with gzip.open(source, "rb") as stream, target.open("xb") as output:
        while chunk := stream.read(_CHUNK):
            written += len(chunk)
            _require_within(source, written, most_bytes)
            output.write(chunk)


def _require_within(source: Path, size: int, most_bytes: int) -> None:
    if size > most_bytes:
        raise RegistryError(f"{source}: more than {most_bytes / 1e9:g} GB; --max-gb allows more")


def _require_safe(source: Path, name: str) -> None:
    if not is_safe_path(name.rstrip("/")) or name.split("/", maxsplit=1)[0] not in TOP_NAMES:
        raise RegistryError(f"{source}: {name[:100]!r} is no path in an export")


def _require_room(target: Path, size: int) -> None:
    free = shutil.disk_usage(target).free
    if size > free:
        needed = f"{size / 1e9:.3g} GB are needed, {free / 1e9:.3g} GB are free"
        raise RegistryError(f"{target.parent}: {needed}")


def _write(path: Path, stream: IO[bytes], size: int) -> None:
    """Write a file that must not be there yet, not a byte longer than announced."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("xb") as output:
        while size > 0 and (chunk := stream.read(min(_CHUNK, size))):
            output.write(chunk)
            size -= len(chunk)


def read_sums(path: Path) -> dict[str, str]:
    """Read SHA-256 by path. Raises RegistryError if the list is not there or not one."""
    try:
        if path.is_symlink() or path.stat().st_size > _MAX_SUMS:
            raise RegistryError(f"{path}: is no list of digests")
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError as error:
        want = "want an export as `factory registry export` writes it"
        raise RegistryError(f"{path.parent}: no {path.name}; {want}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise RegistryError(f"{path}: cannot be read ({error})") from error
    sums: dict[str, str] = {}
    for number, line in enumerate(lines, start=1):
        found = _LINE.fullmatch(line)
        if found is None or found[2] in sums:
            want = "want a digest, two spaces and a path that is not listed yet"
            raise RegistryError(f"{path}, line {number}: {want}")
        sums[found[2]] = found[1]
    return sums
