"""Which files under the given paths are inputs."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from xml.parsers import expat

from asset_factory.sim_checks.read.document import PACKAGED, inside
from asset_factory.sim_checks.read.regular import open_regular
from asset_factory.sim_checks.read.roots import OWN_PACKAGE, Roots
from asset_factory.sim_checks.read.usd.layers import is_usd

from ..errors import ConfigError
from ..runtime.layout import ASSETS, DATABASE, REJECTED, SUPERSEDED, WITHDRAWN
from .formats.catalog import is_mesh
from .references import References

_HEAD_BYTES = 2**20
#: What a registry's folder holds: assets are no inputs, though they look like some.
REGISTERED = (ASSETS, REJECTED, WITHDRAWN, SUPERSEDED)
#: What the USD layer to begin with is called, if not like its folder.
MAIN_LAYERS = ("instance", "model", "asset")


def find_inputs(paths: Sequence[Path]) -> tuple[Path, ...]:
    """Find mesh files and robot descriptions, each once, in folders of any depth, in sorted order.

    A mesh that a description (``.urdf``, or ``.xml`` with the root ``mujoco``) in its folder or
    above refers to, under whatever suffix, or that lies in or below a subfolder from which it takes
    one, belongs to that description and is no input of its own. A USD layer is one if it is called
    like its folder, or ``instance``, ``model`` or ``asset``. A file that is named explicitly always
    is one. Hidden files, links that lead out of a folder (:func:`links_out`), and what a registry
    in it holds, are passed over.

    Raises:
        ConfigError: a path does not exist.
    """
    found: dict[Path, Path] = {}
    for path in paths:
        if not path.exists():
            want = "want a mesh, a URDF or MJCF file, or a folder of them"
            raise ConfigError(f"input {path}: does not exist, {want}")
        for candidate in _inputs_below(path) if path.is_dir() else [path]:
            found.setdefault(candidate.resolve(), candidate)
    return tuple(found.values())


def is_description(path: Path) -> bool:
    """Return whether a file is a URDF, also as xacro, or an MJCF by its root element.

    Of xacro files those called ``*.urdf.xacro``: others hold macros for them.
    """
    suffix = path.suffix.lower()
    urdf = suffix == ".urdf" or path.name.lower().endswith(".urdf.xacro")
    return urdf or (suffix == ".xml" and _root_tag(path) == "mujoco")


def links_out(paths: Sequence[Path]) -> tuple[Path, ...]:
    """Return the links in folders that lead out of them, which :func:`find_inputs` passes over."""
    found = []
    for folder in (path for path in paths if path.is_dir()):
        real = folder.resolve()
        for current, subfolders, names in os.walk(folder):
            subfolders[:] = [name for name in subfolders if not name.startswith(".")]
            there = (Path(current) / name for name in sorted([*subfolders, *names]))
            links = (each for each in there if each.is_symlink())
            found += [x for x in links if not Path(os.path.realpath(x)).is_relative_to(real)]
    return tuple(found)


def _inputs_below(folder: Path) -> Iterator[Path]:
    real = folder.resolve()
    references = References(folder)
    owned: set[Path] = set()
    found: list[tuple[Path, list[Path], list[Path]]] = []
    for current, subfolders, names in os.walk(folder):
        here = Path(current)
        there = frozenset(subfolders)
        made = REGISTERED if DATABASE in names else ()
        looked_into = (name for name in subfolders if name not in made)
        subfolders[:] = sorted(name for name in looked_into if not name.startswith("."))
        candidates = [here / name for name in sorted(names) if not name.startswith(".")]
        candidates = [c for c in candidates if c.is_file() and inside(c, real)]
        descriptions = [c for c in candidates if is_description(c)]
        named: set[str] = set()
        stems = {c.stem for c in candidates}
        for description in descriptions:
            package = Roots(description, OWN_PACKAGE).package
            for reference in references.of(description):
                stem, inner = _taken(reference, there)
                owned |= _taken_elsewhere(reference, here, package)
                # Names are kept of what is there: a hostile file may name anything.
                named |= {stem} & stems
                owned |= {here / inner} if inner else set()
        stages = [c for c in candidates if _is_main_layer(c)]
        meshes = [c for c in candidates if is_mesh(c) and c.stem not in named]
        found.append((here, [*descriptions, *stages[:1]], meshes))
    for here, main, meshes in found:
        below = not owned.isdisjoint((here, *here.parents))
        alone = [c for c in meshes if not below and c.with_suffix("") not in owned]
        yield from sorted([*main, *alone])


def _is_main_layer(path: Path) -> bool:
    """Return whether a USD layer is the one to begin with, by its name."""
    usual = path.stem in MAIN_LAYERS or path.stem == path.parent.name
    return is_usd(path) and usual


def _taken(reference: str, subfolders: frozenset[str]) -> tuple[str, str]:
    """Return the stem of the file that a reference means, and the subfolder it takes it from."""
    words = [word for word in reference.replace("\\", "/").split("/") if word not in ("", ".")]
    if not words:
        return "", ""
    # A package's name comes before the folders that are there.
    inner = next((word for word in words[:-1] if word in subfolders or word == ".."), "")
    return os.path.splitext(words[-1])[0], "" if inner == ".." else inner


def _taken_elsewhere(reference: str, here: Path, package: Path | None) -> set[Path]:
    """Return what belongs to a description beside its folder: a folder, or a file's stem."""
    scheme, _, rest = reference.replace("\\", "/").rpartition("://")
    words = [word for word in rest.split("/") if word not in ("", ".")]
    up = words.count("..")
    if scheme.lower() in PACKAGED and package is not None:
        inner = words[1:]
        base = Path(os.path.normpath(here / os.path.relpath(package, here.resolve())))
    elif up and words[up - 1] == "..":
        inner = words[up:]
        base = Path(os.path.normpath(here / "/".join(words[:up])))
    else:
        return set()
    taken = [base / word for word in inner[:1]]
    return set(taken if len(inner) > 1 else [place.with_suffix("") for place in taken])


def _root_tag(path: Path) -> str | None:
    """Return the name of an XML file's root element; ``None`` if none is near its beginning."""
    tags: list[str] = []
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = lambda tag, _: tags.append(tag)
    # What is broken further down is told by whoever reads it.
    with suppress(expat.ExpatError, OSError, ValueError, LookupError), open_regular(path) as file:
        parser.Parse(file.read(_HEAD_BYTES), False)
    return tags[0] if tags else None
