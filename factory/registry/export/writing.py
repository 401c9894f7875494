"""Exports written: a folder, an archive, or either behind a URL."""

from __future__ import annotations

import gzip
import io
import os
import shutil
import tarfile
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, cast

from ...errors import RegistryError
from ...runtime.remote import is_url, located, shown, told
from ...runtime.store import WRITING_PREFIX, writing

TAR_ENDINGS = (".tar", ".tar.gz", ".tgz")
_MODE = 0o644


@dataclass(frozen=True)
class Written:
    """What an export came to: files, and bytes before any compression."""

    files: int
    bytes: int


def write_export(files: Iterable[tuple[str, bytes]], target: str) -> Written:
    """Write an export; an unfinished one never has its name.

    Args:
        files: paths and contents, as :func:`.contents.contents` gives them.
        target: a folder that does not exist or is empty, a file that ends in .tar, .tar.gz or .tgz,
            or a URL of either that fsspec understands, e.g. ``s3://bucket/assets.tar``. An archive
            takes the place of an older one.

    Raises:
        RegistryError: the target cannot be written.
        ConfigError: what fsspec needs is not installed.
    """
    sizes: list[int] = []
    files = _counted(files, sizes)
    try:
        if target.endswith(TAR_ENDINGS):
            with _opened(target) as stream:
                write_archive(files, stream, compressed=not target.endswith(".tar"))
        elif is_url(target):
            _write_url(files, target)
        else:
            _write_folder(files, Path(target))
    except OSError as error:
        sentence = f"{shown(target)}: cannot be written ({told(error, target)})"
        raise RegistryError(sentence) from (None if is_url(target) else error)
    return Written(len(sizes), sum(sizes))


def _counted(files: Iterable[tuple[str, bytes]], sizes: list[int]) -> Iterator[tuple[str, bytes]]:
    """Pass files on, and note the size of each [bytes]."""
    for name, data in files:
        sizes.append(len(data))
        yield name, data


def _opened(target: str) -> AbstractContextManager[IO[bytes]]:
    if is_url(target):
        system, path = located(target)
        opened: AbstractContextManager[IO[bytes]] = system.open(path, "wb")
        return opened
    file = Path(target)
    file.parent.mkdir(parents=True, exist_ok=True)
    return writing(file)


def write_archive(
    files: Iterable[tuple[str, bytes]], stream: IO[bytes], *, compressed: bool
) -> None:
    """Write a tar archive without times, owners or anything else of this machine."""
    with ExitStack() as stack:
        if compressed:
            packed = gzip.GzipFile("", "wb", fileobj=stream, mtime=0)
            stream = cast(IO[bytes], stack.enter_context(packed))
        archive: Any = stack.enter_context(
            tarfile.open(fileobj=stream, mode="w|", format=tarfile.PAX_FORMAT)
        )
        for name, data in files:
            member = tarfile.TarInfo(name)
            member.size = len(data)
            member.mode = _MODE
            archive.addfile(member, io.BytesIO(data))
            # It remembers every member otherwise.
            archive.members = []


def _write_folder(files: Iterable[tuple[str, bytes]], target: Path) -> None:
    if target.is_file() or (target.is_dir() and any(target.iterdir())):
        advice = "name a folder that is not, or an archive (.tar, .tar.gz)"
        raise RegistryError(f"{target}: is there already; {advice}")
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(dir=target.parent, prefix=WRITING_PREFIX))
    try:
        temporary.chmod(0o755)
        for name, data in files:
            path = temporary / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        os.rename(temporary, target)
    except BaseException:
        shutil.rmtree(temporary, ignore_errors=True)
        raise


def _write_url(files: Iterable[tuple[str, bytes]], target: str) -> None:
    system, path = located(target)
    if system.exists(path) and system.ls(path):
        raise RegistryError(f"{shown(target)}: is there already; name a folder that is not")
    for name, data in files:
        system.makedirs(f"{path}/{name}".rpartition("/")[0], exist_ok=True)
        system.pipe_file(f"{path}/{name}", data)
