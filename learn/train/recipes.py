"""Training recipes: TOML files of differences from the default settings, checked as a whole."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import AxisForm
from asset_factory.factory.presets import overlay

from .bounds import require_within
from .settings import FEATURES, KINDS, PRECISIONS, DataSource, TrainConfig


def recipe_names() -> tuple[str, ...]:
    """Return the recipes that come with the package."""
    names = (entry.name for entry in _shipped().iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml")))


def load_train_config(recipe: str) -> TrainConfig:
    """Return the configuration of a shipped recipe, or of the TOML file at a path.

    Raises:
        ConfigError: no such recipe, unreadable TOML, a setting that does not exist or cannot be.
    """
    return parse_train_config(recipe_text(recipe), recipe)


def recipe_text(recipe: str) -> str:
    """Return the TOML of a recipe.

    Raises:
        ConfigError: there is no such recipe.
    """
    try:
        if recipe in recipe_names():
            return (_shipped() / f"{recipe}.toml").read_text(encoding="utf-8")
        if recipe.endswith(".toml"):
            return Path(recipe).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise ConfigError(f"recipe {recipe!r}: {why}") from error
    raise ConfigError(
        f"no recipe {recipe!r}; there are {', '.join(recipe_names())}, or a path to a .toml file"
    )


def parse_train_config(text: str, where: str) -> TrainConfig:
    """Return a configuration from TOML; what it leaves out is as the defaults say.

    Raises:
        ConfigError: see :func:`load_train_config`.
    """
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{where}: {error}") from error
    data, held_out = (
        _sources(table.pop(name, []), f"{where}: {name}") for name in ("data", "held_out")
    )
    config = replace(overlay(TrainConfig(), table, where), data=data, held_out=held_out)
    _check(config, where)
    return config


def _shipped() -> Traversable:
    return resources.files("asset_factory") / "configs" / "train"


def _sources(tables: Any, where: str) -> tuple[DataSource, ...]:
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise ConfigError(f"{where}: want [[{where.rpartition(' ')[2]}]] tables, each with a kind")
    free = ("style", "options")
    found = []
    for number, table in enumerate(tables, start=1):
        at = f"{where} {number}"
        for name in free:
            if not isinstance(table.get(name, {}), dict):
                raise ConfigError(f"{at}: {name} must be a table of settings, not {table[name]!r}")
        plain = {name: value for name, value in table.items() if name not in free}
        source = overlay(DataSource(), plain, at)
        if "kind" not in table or source.kind not in KINDS:
            raise ConfigError(f"{at}: kind is {table.get('kind')!r}; there are {', '.join(KINDS)}")
        if source.kind != "procedural" and not source.path:
            raise ConfigError(f"{at}: {source.kind} wants a path")
        found.append(replace(source, **{name: table[name] for name in free if name in table}))
    return tuple(found)


def _check(config: TrainConfig, where: str) -> None:
    network = config.network
    if network.features == "partfield":
        raise ConfigError(
            f"{where}: network.features: PartField is not computed while training; "
            "want 'none' or 'components', "
            "which need no other network"
        )
    allowed = {
        "network.features": (network.features, FEATURES),
        "network.axes": (network.axes, tuple(AxisForm)),
        "run.precision": (config.run.precision, PRECISIONS),
    }
    for name, (value, values) in allowed.items():
        if value not in values:
            raise ConfigError(
                f"{where}: {name} must be {' or '.join(map(repr, values))}, not {value!r}"
            )
    require_within(config, where)
    if network.hidden % network.heads:
        raise ConfigError(
            f"{where}: network.heads: {network.heads} do not divide the width {network.hidden}"
        )
    if not config.data:
        raise ConfigError(
            f"{where}: no [[data]]; want at least one source, of kind {', '.join(KINDS)}"
        )
