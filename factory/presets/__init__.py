"""Presets: TOML files that state differences from the defaults of :class:`BuildConfig`."""

from __future__ import annotations

import tomllib
from dataclasses import fields, is_dataclass, replace
from difflib import get_close_matches
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, TypeVar

from ..config import BuildConfig
from ..errors import ConfigError

C = TypeVar("C")


def preset_names() -> tuple[str, ...]:
    """Return the presets that come with the package."""
    names = (entry.name for entry in _shipped().iterdir())
    return (
        "default",
        *sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml")),
    )


def _shipped() -> Traversable:
    return resources.files("asset_factory") / "configs" / "presets"


def load_config(preset: str) -> BuildConfig:
    """Return the configuration of a preset.

    Args:
        preset: ``default``, the name of a shipped preset, or the path of a TOML file.

    Raises:
        ConfigError: no such preset, unreadable TOML, or a setting that does not exist.
    """
    if preset == "default":
        return BuildConfig()
    return overlay(BuildConfig(), _read(preset), preset)


def _read(preset: str) -> dict[str, Any]:
    shipped = preset in preset_names()
    if not shipped and not preset.endswith(".toml"):
        there = ", ".join(preset_names())
        raise ConfigError(f"no preset {preset!r}; there are {there}, or a path to a .toml file")
    file = _shipped() / f"{preset}.toml" if shipped else Path(preset)
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise ConfigError(f"preset {preset!r}: {why}") from error


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
