"""Which folders a description may read from, and what its references mean there."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, islice
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

from ..description import DescriptionError
from .document import (
    PACKAGED,
    REMEDY,
    inside,
    locate,
    outside_error,
    parse_document,
    refuse_address,
)

#: What marks the root folder of a ROS package, and how far above a file it is looked for.
PACKAGE = "package.xml"
MOST_LEVELS = 4
#: Folders of a root that are looked into for a package.
MOST_SUBFOLDERS = 1000


@dataclass(frozen=True)
class ReadOptions:
    """What a reader may open beyond a description's own folder.

    Attributes:
        roots: folders that may be read, and in which packages are looked for.
        allow_outside: trust the file with any path.
        arguments: of xacro files, written ``name:=value``.
        srdf: what says which of its links may pass through each other; ``None``: the file beside
            a URDF that is called like it.
    """

    roots: tuple[Path, ...] = ()
    allow_outside: bool = False
    arguments: tuple[str, ...] = ()
    srdf: Path | None = None


#: The description's own folder and its package alone.
OWN_PACKAGE = ReadOptions()


def ros_package_path() -> tuple[Path, ...]:
    """Return the folders that ``ROS_PACKAGE_PATH`` names, of those that are there."""
    named = map(Path, filter(None, os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)))
    return tuple(folder for folder in named if folder.is_dir())


class Roots:
    """The folders that one description may read from: its package, its own, and those given.

    Attributes:
        own: the description's folder, links followed.
        package: the nearest folder from there on up with a ``package.xml``, at most
            :data:`MOST_LEVELS` above; ``None`` without.
        looked: where its ``package.xml`` was looked for, the last place being where it is.
    """

    def __init__(self, path: Path, options: ReadOptions) -> None:
        self.own = path.parent.resolve()
        self._outside = options.allow_outside
        levels = [self.own, *self.own.parents][: MOST_LEVELS + 1]
        found = next((n for n, level in enumerate(levels) if os.path.isfile(level / PACKAGE)), None)
        self.package = None if found is None else levels[found]
        self.looked = [level / PACKAGE for level in levels[: None if found is None else found + 1]]
        above = [] if self.package is None else [self.package]
        self._given = [root.resolve() for root in options.roots]
        self._folders = list(dict.fromkeys([*above, self.own, *self._given]))
        self._names: dict[Path, str] = {}

    def find(self, reference: str) -> Path:
        """Return the file that a URDF means by ``reference``, links followed.

        ``package://name/rest`` and ``model://name/rest`` mean ``rest`` in the root of that name, or
        in a folder of that name in a root or in one of its folders; without either, ever shorter
        tails of it are looked for in the description's folder, and ``rest`` in nameless roots.

        Raises:
            DescriptionError: ``outside_folder`` or ``missing_file``; names the flags that help.
        """
        places: list[Path] = []
        for spelled in dict.fromkeys((reference, unquote(reference.strip()))):
            places += self._places(spelled)
        allowed = [place for place in places if self.allows(place)]
        for place in allowed:
            if os.path.isfile(place):
                return place.resolve()
        if not allowed:
            raise outside_error(reference, places)
        words = f"{reference[:160]!r}: no such file in the description's folder or its package"
        raise DescriptionError("missing_file", f"{words}; {REMEDY}", allowed)

    def package_folder(self, name: str) -> Path:
        """Return the root folder of a package. Raises DescriptionError ``missing_file``."""
        for folder in self._packages(name):
            if folder.is_dir() and self.allows(folder):
                return folder
        raise DescriptionError("missing_file", f"no package {name[:160]!r}; {REMEDY}")

    def allows(self, path: Path) -> bool:
        """Return whether a path, every link in it followed, may be read."""
        return self._outside or any(inside(path, folder) for folder in self._folders)

    def copied_to(self, file: Path) -> PurePosixPath:
        """Return where a copy of a file lies among copies of all; no name of this machine in it.

        Files of one root, given by resolved paths, keep their places relative to each other.
        """
        root = next((each for each in self._folders if file.is_relative_to(each)), file.parent)
        if root not in self._names:
            name = _package_name(root)
            while name in self._names.values():
                name += "_"
            self._names[root] = name
        return PurePosixPath(self._names[root], file.relative_to(root).as_posix())

    def _places(self, reference: str) -> Iterator[Path]:
        """Yield where the file of a reference may lie, best first; some may not be read."""
        refuse_address(reference)
        scheme, _, rest = reference.replace("\\", "/").rpartition("://")
        if scheme.lower() not in PACKAGED:
            yield self.own / rest
            return
        name, _, inner = rest.partition("/")
        yield from (folder / inner for folder in self._packages(name))
        with suppress(DescriptionError):
            yield from locate(reference, self.own)
        unnamed = (root for root in self._folders if not os.path.isfile(root / PACKAGE))
        yield from (root / inner for root in unnamed)

    def _packages(self, name: str) -> Iterator[Path]:
        """Yield where a package of that name may lie, best first."""
        for root in self._folders:
            if name in (root.name, _package_name(root)):
                yield root
            yield root / name
        yield from self._index.get(name, ())

    @cached_property
    def _index(self) -> Mapping[str, list[Path]]:
        """Return the folders in the given roots, and in those, by their and their packages' names.

        As in a workspace, where packages lie in repositories.
        """
        found: dict[str, list[Path]] = {}
        for root in self._given:
            children = _subfolders(root)
            inner = (folder for child in children for folder in _subfolders(child))
            for folder in islice(chain(children, inner), MOST_SUBFOLDERS):
                for name in {folder.name, _package_name(folder)}:
                    found.setdefault(name, []).append(folder)
        return found


def _subfolders(root: Path) -> list[Path]:
    with suppress(OSError), os.scandir(root) as entries:
        return sorted(Path(e.path) for e in islice(entries, MOST_SUBFOLDERS) if e.is_dir())
    return []


def _package_name(folder: Path) -> str:
    """Return what the ``package.xml`` in a folder calls it; without one, the folder's own name."""
    with suppress(DescriptionError):
        name = (parse_document(folder / PACKAGE, 2**16).findtext("name") or "").strip()
        if name.isidentifier():
            return name
    return folder.name or "root"
