"""What a user writes beside a mesh: ``chair.toml`` or ``chair.glb.toml`` next to ``chair.glb``."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from asset_factory.sim_checks.read.document import inside

from ..errors import ConfigError, InputRejected
from .categories import category_table, normalised
from .files import InputFiles
from .orientation import parse_up
from .reads import ABSENT

_TEXTS = ("category", "up", "license", "annotation")
_NUMBERS = ("height", "scale", "density")
KNOWN_KEYS = (*_TEXTS, *_NUMBERS)
_MAX_BYTES = 64 * 1024
#: Heights [m], factors and densities [kg/m3] beyond are slips.
_LEAST = 1e-9
_MOST = 1e9


@dataclass(frozen=True)
class Sidecar:
    """The content of a sidecar file; ``None`` where it says nothing.

    Attributes:
        category: of the object, e.g. ``fridge``.
        up: the input's up axis.
        height: real height [m].
        scale: factor from input units to metres.
        density: [kg/m3].
        license: of the input.
        annotation: path of a file with parts and joints.
    """

    category: str | None = None
    up: str | None = None
    height: float | None = None
    scale: float | None = None
    density: float | None = None
    license: str | None = None
    annotation: Path | None = None


def read_sidecar(path: Path, files: InputFiles) -> Sidecar:
    """Read the sidecar of mesh file ``path``; empty if none. The longer name wins.

    Raises:
        InputRejected: ``bad_sidecar``, with what it may contain; ``external_reference`` for its
            annotation.
    """
    found = find_beside(sidecar_paths(path), files)
    return Sidecar() if found is None else _parse(found, files)


def sidecar_paths(path: Path) -> tuple[Path, Path]:
    """Return where the sidecar of mesh file ``path`` may lie, the one that wins first."""
    return path.with_name(path.name + ".toml"), path.with_name(path.stem + ".toml")


def find_beside(paths: Iterable[Path], files: InputFiles) -> Path | None:
    """Return the first of some files that is there; those that are missed are noted."""
    for path in paths:
        if path.is_file():
            return path
        files.log.note(path, ABSENT)
    return None


def read_beside(path: Path, files: InputFiles, most_bytes: int) -> bytes:
    """Return the content of a file that says something of the mesh beside it.

    Raises:
        InputRejected: ``bad_sidecar``: it is too large; ``external_reference``: it is a link that
            leads out of the folder.
    """
    if path.stat().st_size > most_bytes:
        raise bad_sidecar(path, f"is {path.stat().st_size} bytes, want at most {most_bytes}")
    if not inside(path, path.parent.resolve()):
        files.log.note_link_out(path, path.parent)
        outside = f"{path.name}: is a link that leads outside the input's folder"
        raise InputRejected("external_reference", outside)
    return files.read(path)


def bad_sidecar(path: Path, why: str) -> InputRejected:
    """Return the rejection of an input for its sidecar."""
    return InputRejected("bad_sidecar", f"{path.name}: {why}")


def _parse(path: Path, files: InputFiles) -> Sidecar:
    text = read_beside(path, files, _MAX_BYTES)
    try:
        values = tomllib.loads(text.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise bad_sidecar(path, f"is not TOML: {error}") from error
    unknown = sorted(set(values) - set(KNOWN_KEYS))
    if unknown:
        known = f"known are {', '.join(KNOWN_KEYS)}"
        raise bad_sidecar(path, f"does not know {', '.join(unknown)[:160]}; {known}")
    if "height" in values and "scale" in values:
        raise bad_sidecar(path, "has both height and scale, want at most one")
    for key in _TEXTS:
        if key in values and not (isinstance(values[key], str) and values[key].strip()):
            raise bad_sidecar(path, f"{key} must be a text, not {repr(values[key])[:80]}")
    _require_known_category(path, values)
    return Sidecar(
        category=values.get("category"),
        up=_up(path, values.get("up")),
        height=_positive(path, "height", values.get("height")),
        scale=_positive(path, "scale", values.get("scale")),
        density=_positive(path, "density", values.get("density")),
        license=values.get("license"),
        annotation=_annotation(path, values.get("annotation"), files),
    )


def _require_known_category(path: Path, values: Mapping[str, Any]) -> None:
    """Reject a category that says nothing of the size, where nothing else does: a slip."""
    category = values.get("category")
    if category is None or not {"height", "scale"}.isdisjoint(values):
        return
    known = category_table()
    if normalised(category) not in known:
        near = get_close_matches(normalised(category), known, n=1)
        meant = f"did you mean {near[0]!r}?" if near else "configs/categories.toml lists those."
        message = f"category {category[:80]!r} is not known; {meant} For another, state its height"
        raise bad_sidecar(path, message)


def _up(path: Path, value: str | None) -> str | None:
    if value is None or value.strip().lower() == "auto":
        return None
    try:
        return parse_up(value)
    except ConfigError as error:
        raise bad_sidecar(path, str(error)) from error


def _positive(path: Path, key: str, value: object) -> float | None:
    if value is None:
        return None
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float)
        or not _LEAST <= value <= _MOST
    ):
        want = f"a positive number, {_LEAST:g} to {_MOST:g}"
        raise bad_sidecar(path, f"{key} must be {want}, not {repr(value)[:80]}")
    return float(value)


def _annotation(path: Path, reference: str | None, files: InputFiles) -> Path | None:
    if reference is None:
        return None
    location = files.find(reference, path.parent)
    try:
        files.read(location)
    except FileNotFoundError as error:
        raise bad_sidecar(path, f"annotation {reference!r} does not exist beside it") from error
    return location
