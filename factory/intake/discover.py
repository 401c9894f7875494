"""Which files under the given paths are inputs."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from xml.parsers import expat

from ..errors import ConfigError
from ..runtime.layout import ASSETS, DATABASE, REJECTED, WITHDRAWN
from .formats.catalog import is_mesh

_HEAD_BYTES = 2**20
#: What a registry's folder holds: assets are no inputs, though they look like some.
REGISTERED = (ASSETS, REJECTED, WITHDRAWN)


def find_inputs(paths: Sequence[Path]) -> tuple[Path, ...]:
    """Mesh files and robot descriptions, each once, folders searched to any depth in sorted order.

    A mesh at or below a folder that holds a description (``.urdf``, or ``.xml`` with the root
    ``mujoco``) belongs to that description and is no input of its own. A file that is named
    explicitly always is one. Hidden files, links that lead out of a folder, and what a registry in
    it holds, are passed over.

    Raises:
        ConfigError: a path does not exist.
    """
    found: dict[Path, Path] = {}
    for path in paths:
        if not path.exists():
            raise ConfigError(
                f"input {path}: does not exist, want a mesh, a URDF or MJCF file, "
                "or a folder of them"
            )
        for candidate in _inputs_below(path) if path.is_dir() else [path]:
            found.setdefault(candidate.resolve(), candidate)
    return tuple(found.values())


def is_description(path: Path) -> bool:
    """Whether a file is a URDF, or an MJCF by its root element."""
    suffix = path.suffix.lower()
    return suffix == ".urdf" or (suffix == ".xml" and _root_tag(path) == "mujoco")


def _inputs_below(folder: Path) -> Iterator[Path]:
    real = folder.resolve()
    described: list[Path] = []
    for current, subfolders, names in os.walk(folder):
        made = REGISTERED if DATABASE in names else ()
        subfolders[:] = sorted(
            name for name in subfolders if not name.startswith(".") and name not in made
        )
        here = Path(current)
        candidates = [here / name for name in sorted(names) if not name.startswith(".")]
        candidates = [c for c in candidates if c.is_file() and c.resolve().is_relative_to(real)]
        descriptions = [c for c in candidates if is_description(c)]
        if descriptions:
            described.append(here)
        belongs = _is_below_any(here, described)
        meshes = [] if belongs else [c for c in candidates if is_mesh(c)]
        yield from sorted([*descriptions, *meshes])


def _is_below_any(folder: Path, others: Iterable[Path]) -> bool:
    return any(folder.is_relative_to(other) for other in others)


def _root_tag(path: Path) -> str | None:
    """The name of an XML file's root element; ``None`` if there is none near its beginning."""
    tags: list[str] = []
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = lambda tag, _: tags.append(tag)
    # What is broken further down is told by whoever reads it.
    with suppress(expat.ExpatError, OSError, ValueError, LookupError), path.open("rb") as file:
        parser.Parse(file.read(_HEAD_BYTES), False)
    return tags[0] if tags else None
