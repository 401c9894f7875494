"""What a user writes beside a mesh: ``chair.toml`` or ``chair.glb.toml`` next to ``chair.glb``."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from ..errors import ConfigError, InputRejected
from .files import InputFiles
from .orientation import parse_up

_TEXTS = ("category", "up", "license", "annotation")
_NUMBERS = ("height", "scale", "density")
KNOWN_KEYS = (*_TEXTS, *_NUMBERS)
_MAX_BYTES = 1_000_000


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
    """The sidecar of mesh file ``path``; empty if there is none. The longer name wins over the shorter.

    Raises:
        InputRejected: ``bad_sidecar``, with what it may contain; ``external_reference`` for its annotation.
    """
    for candidate in (path.with_name(path.name + ".toml"), path.with_name(path.stem + ".toml")):
        if candidate.is_file():
            return _parse(candidate, files)
    return Sidecar()


def _parse(path: Path, files: InputFiles) -> Sidecar:
    if path.stat().st_size > _MAX_BYTES:
        raise _bad(path, f"is {path.stat().st_size} bytes, want at most {_MAX_BYTES}")
    if not path.resolve().is_relative_to(path.parent.resolve()):
        raise InputRejected("external_reference", f"{path.name}: is a link that leads outside the input's folder")
    try:
        values = tomllib.loads(files.read(path).decode("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise _bad(path, f"is not TOML: {error}") from error
    unknown = sorted(set(values) - set(KNOWN_KEYS))
    if unknown:
        raise _bad(path, f"does not know {', '.join(unknown)}; known are {', '.join(KNOWN_KEYS)}")
    if "height" in values and "scale" in values:
        raise _bad(path, "has both height and scale, want at most one")
    for key in _TEXTS:
        if key in values and not (isinstance(values[key], str) and values[key].strip()):
            raise _bad(path, f"{key} is {values[key]!r}, want a text")
    return Sidecar(
        category=values.get("category"),
        up=_up(path, values.get("up")),
        height=_positive(path, "height", values.get("height")),
        scale=_positive(path, "scale", values.get("scale")),
        density=_positive(path, "density", values.get("density")),
        license=values.get("license"),
        annotation=_annotation(path, values.get("annotation"), files),
    )


def _up(path: Path, value: str | None) -> str | None:
    if value is None or value.strip().lower() == "auto":
        return None
    try:
        return parse_up(value)
    except ConfigError as error:
        raise _bad(path, str(error)) from error


def _positive(path: Path, key: str, value: object) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < float("inf"):
        raise _bad(path, f"{key} is {value!r}, want a positive number")
    return float(value)


def _annotation(path: Path, reference: str | None, files: InputFiles) -> Path | None:
    if reference is None:
        return None
    location = files.find(reference, path.parent)
    try:
        files.read(location)
    except FileNotFoundError as error:
        raise _bad(path, f"annotation {reference!r} does not exist beside it") from error
    return location


def _bad(path: Path, why: str) -> InputRejected:
    return InputRejected("bad_sidecar", f"{path.name}: {why}")
