"""One object of a dataset, before it is read; and where in a folder of folders the objects are."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from asset_factory.factory.runtime.store import digest_bytes, digest_file

#: Looks change no geometry; datasets are mostly made of them.
LOOKS = frozenset({
    ".png", ".jpg", ".jpeg", ".bmp", ".tga", ".tif", ".tiff", ".gif", ".webp", ".exr", ".hdr",
    ".mdl",
})  # fmt: skip


@dataclass(frozen=True)
class SourceItem:
    """An object as files.

    Attributes:
        name: unique within its source: its folder, relative to the source's, or its file's stem.
        main: the file that says what the object is.
        files: everything that it may consist of; ``main`` is one of them.
    """

    name: str
    main: Path
    files: tuple[Path, ...]

    @property
    def folder(self) -> Path:
        """Return the folder outside of which nothing belongs to the object."""
        return self.main.parent

    def digest(self) -> str:
        """Return the SHA-256 of its files' names and contents, images left out. Raises OSError."""
        lines = [f"main {self.main.name}"]
        for path in self.files:
            if path.suffix.lower() not in LOOKS:
                lines.append(f"{path.relative_to(self.folder).as_posix()} {digest_file(path)}")
        return digest_bytes("\n".join(lines).encode())


def find_items(
    root: Path, mains: Callable[[Sequence[Path]], Sequence[Path]]
) -> tuple[SourceItem, ...]:
    """Return the objects in and below a folder, by name.

    A folder that holds a main file is an object, and so is nothing below it. Several main files in
    ``root`` itself are an object each; elsewhere the first counts. Hidden files, and links that
    lead out of ``root``, do not exist. ``mains`` returns which of a folder's files could be an
    object's main file, best first.
    """
    items: list[SourceItem] = []
    real = root.resolve()
    for current, subfolders, names in os.walk(root):
        here = Path(current)
        subfolders[:] = sorted(name for name in subfolders if not name.startswith("."))
        found = mains(_regular(here, names, real))
        if not found:
            continue
        subfolders.clear()
        flat = here == root
        for main in found if flat else found[:1]:
            name = main.stem if flat else here.relative_to(root).as_posix()
            items.append(SourceItem(name, main, files_below(here, real)))
    return tuple(sorted(items, key=lambda item: item.name))


def _regular(folder: Path, names: Sequence[str], real_root: Path) -> list[Path]:
    candidates = [folder / name for name in sorted(names) if not name.startswith(".")]
    there = (path for path in candidates if path.is_file())
    return [path for path in there if path.resolve().is_relative_to(real_root)]


def files_below(folder: Path, root: Path | None = None) -> tuple[Path, ...]:
    """Return the files in and below a folder, in a fixed order.

    Links that lead out of ``root`` (``folder`` itself by default) do not exist.
    """
    real = (root or folder).resolve()
    found: list[Path] = []
    for current, subfolders, names in os.walk(folder):
        subfolders[:] = sorted(name for name in subfolders if not name.startswith("."))
        found += _regular(Path(current), names, real)
    return tuple(found)
