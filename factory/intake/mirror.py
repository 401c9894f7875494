"""Inputs behind URLs: copied beside the registry once, and again where they changed."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import urlsplit

from filelock import FileLock

from ..errors import ConfigError
from ..runtime.layout import INPUTS
from ..runtime.remote import LOCAL, is_url, located, shown, told, version
from ..runtime.store import digest_bytes, writing

#: Files fetched at once: most of the time is waiting.
AT_ONCE = 8
#: A line for each file that was fetched, in the order in which they came.
_FETCHED = ".fetched.jsonl"
#: In place of a size that is not told.
_UNKNOWN = -1


def local_inputs(places: Sequence[Path | str], output: Path) -> tuple[Path, ...]:
    """Return inputs as paths on this machine; those behind a URL are fetched first.

    A copy that was cut off goes on with the missing files. Each file is put in place whole; files
    gone from the URL go here too.

    Places are paths or URLs that fsspec understands; copies lie in the registry's folder,
    ``output``.

    Raises:
        ConfigError: a URL cannot be read; the sentence names no secret.
    """
    return tuple(_local(place, output) for place in places)


def mirror_of(place: Path | str, output: Path) -> Path:
    """Return where a place's files lie, or will once they are fetched."""
    if isinstance(place, Path) or not is_url(place):
        return Path(place)
    parts = urlsplit(shown(place))
    if parts.scheme == LOCAL:
        return Path(located(place)[1])
    names = [name for name in (parts.netloc, *parts.path.split("/")) if name not in ("", ".", "..")]
    return output / INPUTS / parts.scheme / Path(*names)


def _local(place: Path | str, output: Path) -> Path:
    mirror = mirror_of(place, output)
    if isinstance(place, Path) or not is_url(place) or urlsplit(place).scheme == LOCAL:
        return mirror
    try:
        (output / INPUTS).mkdir(parents=True, exist_ok=True)
        with FileLock(output / INPUTS / f".{digest_bytes(str(mirror).encode())}.lock"):
            _fetch(place, mirror)
    except ConfigError:
        raise
    except Exception as error:  # noqa: BLE001 - each file system has errors of its own
        raise ConfigError(f"input {shown(place)}: cannot be read: {told(error, place)}") from None
    return mirror


def _fetch(url: str, mirror: Path) -> None:
    """Make the mirror what the URL shows."""
    system, path = located(url)
    single = system.isfile(path)
    root = path.rpartition("/")[0] if single else path
    wanted = dict(_listed(system, path, root, single=single))
    if not wanted:
        want = "want a mesh, a URDF or MJCF file, or a folder of them"
        raise ConfigError(f"input {shown(url)}: nothing there, {want}")
    folder = mirror.parent if single else mirror
    folder.mkdir(parents=True, exist_ok=True)
    known = _known(folder)
    missing = [name for name, stamp in wanted.items() if not _is_there(folder, name, stamp, known)]
    with (
        (folder / _FETCHED).open("a", encoding="utf-8", buffering=1) as journal,
        ThreadPoolExecutor(AT_ONCE, thread_name_prefix="fetch") as pool,
    ):

        def copy(name: str) -> None:
            _copy(system, f"{root}/{name}", folder / name, wanted[name][0])

        # Where one fails, those after it are not begun.
        for name, _ in zip(missing, pool.map(copy, missing), strict=True):
            journal.write(json.dumps([name, *wanted[name]]) + "\n")
    if not single:
        _drop_others(folder, frozenset(wanted))


def _listed(
    system: Any, path: str, root: str, *, single: bool
) -> Iterator[tuple[str, tuple[int, str]]]:
    """Yield every file's name below the root, its size [bytes] and what changes with it."""
    stem = PurePosixPath(path).stem
    found = {}
    # Where there are no listings, a file may be there all the same.
    with suppress(FileNotFoundError, NotImplementedError):
        found = system.find(root, maxdepth=1 if single else None, detail=True)
    if single:
        found.setdefault(path, system.info(path))
    for place, details in found.items():
        name = place.removeprefix(root).strip("/")
        # A file comes with those beside it that are named after it: sidecar, annotation, material.
        if single and not name.startswith(f"{stem}."):
            continue
        parts = PurePosixPath(name).parts
        if not parts or ".." in parts or any(part.startswith(".") for part in parts):
            continue
        size = details.get("size")
        yield name, (_UNKNOWN if size is None else int(size), version(details))


def _copy(system: Any, path: str, target: Path, listed: int) -> None:
    """Fetch one file of so many bytes; it is there whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with writing(target) as file:
        system.get_file(path, file.name)
        size = os.stat(file.name).st_size
        if listed not in (_UNKNOWN, size):
            what = f"{target.name}: {size} bytes came, {listed} were listed"
            raise OSError(f"{what}; it changes, or was cut")


def _known(folder: Path) -> dict[str, tuple[int, str]]:
    """Return the files fetched before; a file's last line counts, a line cut off does not."""
    known = {}
    path = folder / _FETCHED
    for line in path.read_text(encoding="utf-8").splitlines() if path.is_file() else ():
        try:
            name, size, stamp = json.loads(line)
        except ValueError:
            continue
        known[str(name)] = (int(size), str(stamp))
    return known


def _is_there(
    folder: Path, name: str, listed: tuple[int, str], known: dict[str, tuple[int, str]]
) -> bool:
    path = folder / name
    if known.get(name) != listed or not path.is_file():
        return False
    return listed[0] in (_UNKNOWN, path.stat().st_size)


def _drop_others(folder: Path, wanted: frozenset[str]) -> None:
    for current, _, names in os.walk(folder, topdown=False):
        here = Path(current)
        for name in names:
            path = here / name
            if path.relative_to(folder).as_posix() not in wanted and not name.startswith("."):
                path.unlink(missing_ok=True)
        if here != folder and not any(here.iterdir()):
            here.rmdir()
