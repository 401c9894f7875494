"""Presets: TOML files that state differences from the defaults of :class:`BuildConfig`."""

from __future__ import annotations

import tomllib
from dataclasses import fields, is_dataclass, replace
from difflib import get_close_matches
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from ..config import BuildConfig
from ..errors import ConfigError

C = TypeVar("C")


def shipped_names(folder: str) -> tuple[str, ...]:
    """Return the TOML files that come with the package in a folder of ``configs``, by name."""
    files = (resources.files("asset_factory") / "configs" / folder).iterdir()
    return tuple(sorted(Path(file.name).stem for file in files if file.name.endswith(".toml")))


def toml_text(what: str, name: str, folder: str) -> str:
    """Return the text of a shipped file of ``configs/<folder>``, or of a TOML file at a path.

    Raises:
        ConfigError: there is none; ``what`` is the word for it.
    """
    shipped = shipped_names(folder)
    if name not in shipped and not name.endswith(".toml"):
        there = ", ".join(shipped)
        raise ConfigError(f"no {what} {name!r}; there are {there}, or a path to a .toml file")
    place = resources.files("asset_factory") / "configs" / folder / f"{name}.toml"
    try:
        return (place if name in shipped else Path(name)).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise ConfigError(f"{what} {name!r}: {why}") from error


def load_config(preset: str) -> BuildConfig:
    """Return the configuration of a preset.

    Args:
        preset: the name of a shipped one, ``default`` among them, or the path of a TOML file.

    Raises:
        ConfigError: no such preset, unreadable TOML, or a setting that does not exist.
    """
    text = toml_text("preset", preset, "presets")
    try:
        return overlay(BuildConfig(), tomllib.loads(text), preset)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"preset {preset!r}: {error}") from error


def overlay(config: C, differences: dict[str, Any], where: str) -> C:
    """Return ``config`` with some settings replaced, recursively.

    Raises:
        ConfigError: a setting does not exist or has another type than its default; names what
            exists.
    """
    known = {field.name for field in fields(config)}  # type: ignore[arg-type]
    changes: dict[str, Any] = {}
    for name, value in differences.items():
        if name not in known:
            near = "".join(f"; did you mean {it!r}?" for it in get_close_matches(name, known, n=1))
            there = ", ".join(sorted(known))
            raise ConfigError(f"{where}: no setting {name!r}; there are {there}{near}")
        default = getattr(config, name)
        changes[name] = _converted(default, value, f"{where}: {name}")
    return replace(config, **changes)  # type: ignore[type-var]


def _converted(default: Any, value: Any, where: str) -> Any:
    if is_dataclass(default) and not isinstance(default, type):
        if not isinstance(value, dict):
            raise ConfigError(f"{where} must be a table of settings, not {value!r}")
        return overlay(default, value, where)
    if isinstance(default, tuple) and isinstance(value, list):
        return tuple(value)
    if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if default is not None and type(value) is not type(default):
        raise ConfigError(
            f"{where} must be {type(default).__name__}, e.g. {default!r}, not {value!r}"
        )
    return value
