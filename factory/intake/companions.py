"""Which files an input may be made of, told from names in its text: what to send along with it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path
from urllib.parse import unquote

from asset_factory.sim_checks.read.document import inside
from asset_factory.sim_checks.read.regular import open_regular
from asset_factory.sim_checks.read.usd.layers import SUFFIXES as USD_SUFFIXES
from asset_factory.sim_checks.read.usd.layers import is_usd

from .formats.catalog import FORMATS
from .references import MOST_BYTES, REFERENCE
from .sidecar import sidecar_paths

#: What readers open beside a mesh.
_BESIDE = (
    *(".mtl", ".bin", ".json", ".npz", ".toml", ".xml", ".urdf"),
    *(".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga", ".tif", ".tiff", ".gif", ".ktx2", ".dds"),
)
#: These name no files.
_LEAVES = frozenset({".stl", ".off", *_BESIDE}) - {".mtl", ".json", ".toml", ".xml", ".urdf"}
_ENDS = "|".join(map(re.escape, sorted({*_BESIDE, *(form.suffix for form in FORMATS)})))
_SUFFIX = re.compile(rf"(?:{_ENDS})(?![A-Za-z0-9_])".encode(), re.IGNORECASE)
#: Before a name, unless a file is called strangely.
_BEFORE = re.compile(rb"[\x00-\x1f\"'<>@|=]")
_SCHEME = re.compile(r"^.*(://|file:)")
_LONGEST = 250
_MOST_WORDS = 8
#: Of USD layers, which say in no readable way what they name.
_MOST_LAYERS = 4096
#: Names, folders they may lie in, and text [bytes] that are looked at for one input: whatever a
#: file says, so many places at most are asked for.
_MOST_NAMES = 20_000
_MOST_FOLDERS = 32
_MOST_TEXT = 16 * MOST_BYTES


def companions(source: Path, known: frozenset[str] = frozenset()) -> frozenset[str]:
    """Return the files in or below an input's folder that it may be made of, itself included.

    Some may be too many, and some missing that are called strangely, or named beyond the first
    64 MiB of a file: what an input was made of only its reader knows, see :class:`.reads.Reads`.

    Args:
        source: the input.
        known: further files that it is known to refer to, relative to its folder.

    Returns:
        Paths relative to its folder, of files and of links to anywhere.
    """
    root = source.parent
    beside = [path for path in sidecar_paths(source) if path.is_file()]
    beside_it = islice(filter(is_usd, root.rglob("*")), _MOST_LAYERS)
    layers = sorted(beside_it) if is_usd(source) else []
    waiting = [source, *beside, *layers, *(root / name for name in known)]
    found = dict.fromkeys(map(Path, map(os.path.normpath, waiting)))
    folders = {root}
    names: set[str] = set()
    real = root.resolve()
    left = _MOST_TEXT
    while waiting:
        path = waiting.pop()
        # The input itself may be a link to anywhere.
        here = path == source or inside(path, real)
        if path.suffix.lower() in _LEAVES | USD_SUFFIXES or not here:
            continue
        with suppress(OSError), open_regular(path) as file:
            data = file.read(min(MOST_BYTES, left))
            left -= len(data)
            more = {path.parent, *_folders(data, root)} - folders
            more = set(islice(sorted(more), max(0, _MOST_FOLDERS - len(folders))))
            said = set(islice(_names(data), max(0, _MOST_NAMES - len(names)))) - names
            # What was said before may lie in a folder that is new.
            places = [*_places(said, folders | more, root), *_places(names, more, root)]
            folders |= more
            names |= said
            new = dict.fromkeys(each for each in places if each not in found)
            found |= new
            waiting += new
    return frozenset(os.path.relpath(path, root) for path in found)


def _folders(data: bytes, root: Path) -> Iterator[Path]:
    """Yield the folders in which an MJCF says that its files lie."""
    for found in REFERENCE.finditer(data if b"dir" in data else b""):
        if found[1].endswith(b"dir"):
            yield Path(os.path.normpath(root / found[2].decode("utf-8", "replace")))


def _names(data: bytes) -> Iterator[str]:
    """Yield what may be a file's name in a text: up to a known suffix, from where it may begin."""
    seen = set()
    for found in _SUFFIX.finditer(data):
        text = _BEFORE.split(data[max(0, found.start() - _LONGEST) : found.end()])[-1]
        if text in seen:
            continue
        seen.add(text)
        words = text.decode("utf-8", "replace").replace("\\", "/").split(" ")
        for start in range(max(0, len(words) - _MOST_WORDS), len(words)):
            yield " ".join(words[start:]).strip()


def _places(names: set[str], folders: set[Path], root: Path) -> Iterator[Path]:
    """Yield the files and links in the input's folder that names lead to."""
    for name in {*names, *map(unquote, names)}:
        for folder in folders:
            yield from _there(name, folder, root)


def _there(name: str, folder: Path, root: Path) -> Iterator[Path]:
    parts = _SCHEME.sub("", name).split("/")
    # Packages are looked for nowhere: their paths begin with names that may be no folders.
    for start in range(len(parts) if "://" in name else 1):
        path = Path(os.path.normpath(folder / "/".join(parts[start:])))
        if path.is_relative_to(root) and (os.path.isfile(path) or os.path.islink(path)):
            yield path
