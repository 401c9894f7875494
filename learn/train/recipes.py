"""Training recipes: TOML files of differences from the default settings, checked as a whole."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from typing import Any

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import AxisForm
from asset_factory.factory.presets import overlay, toml_text

from ..bounds import require_possible
from ..datasets.catalog import SOURCES
from .settings import FEATURES, PRECISIONS, DataSource, TrainConfig

KINDS = ("procedural", "sampled", *SOURCES)


def load_train_config(recipe: str) -> TrainConfig:
    """Return the configuration of a shipped recipe, or of the TOML file at a path.

    Raises:
        ConfigError: no such recipe, unreadable TOML, a setting that does not exist or cannot be.
    """
    return parse_train_config(recipe_text(recipe), recipe)


def recipe_text(recipe: str) -> str:
    """Return the TOML of a recipe. Raises ConfigError: there is none."""
    return toml_text("recipe", recipe, "train")


def parse_train_config(text: str, where: str) -> TrainConfig:
    """Return a configuration from TOML; what it leaves out is as the defaults say.

    Raises:
        ConfigError: see :func:`load_train_config`.
    """
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{where}: {error}") from error
    data = _sources(table.pop("data", []), f"{where}: data")
    held_out = _sources(table.pop("held_out", []), f"{where}: held_out")
    config = replace(overlay(TrainConfig(), table, where), data=data, held_out=held_out)
    _check(config, where)
    return config


def _sources(tables: Any, where: str) -> tuple[DataSource, ...]:
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise ConfigError(f"{where}: want [[{where.rpartition(' ')[2]}]] tables, each with a kind")
    found = []
    for number, table in enumerate(tables, start=1):
        at = f"{where} {number}"
        source = overlay(DataSource(), table, at)
        if "kind" not in table or source.kind not in KINDS:
            raise ConfigError(f"{at}: kind is {table.get('kind')!r}; there are {', '.join(KINDS)}")
        if source.kind != "procedural" and not source.path:
            raise ConfigError(f"{at}: {source.kind} wants a path")
        found.append(source)
    return tuple(found)


def _check(config: TrainConfig, where: str) -> None:
    network = config.network
    if network.features == "partfield":
        wanted = "want 'none' or 'components', which need no other network"
        said = "network.features: PartField is not computed while training"
        raise ConfigError(f"{where}: {said}; {wanted}")
    allowed = {
        "network.features": (network.features, FEATURES),
        "network.axes": (network.axes, tuple(AxisForm)),
        "run.precision": (config.run.precision, PRECISIONS),
    }
    for name, (value, values) in allowed.items():
        if value not in values:
            wanted = " or ".join(map(repr, values))
            raise ConfigError(f"{where}: {name} must be {wanted}, not {value!r}")
    require_possible(config, where)
    if config.draw.scale[0] > config.draw.scale[1]:
        wanted = "the lower number first"
        raise ConfigError(f"{where}: draw.scale must be {wanted}, not {list(config.draw.scale)}")
    if network.hidden % network.heads:
        said = f"{network.heads} do not divide the width {network.hidden}"
        raise ConfigError(f"{where}: network.heads: {said}")
    if not config.data:
        kinds = ", ".join(KINDS)
        raise ConfigError(f"{where}: no [[data]]; want at least one source, of kind {kinds}")
