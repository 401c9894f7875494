"""Training recipes: TOML files of differences from the default settings, checked as a whole."""

from __future__ import annotations

import math
import tomllib
from dataclasses import fields, replace
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import AxisForm
from asset_factory.factory.presets import overlay

from .settings import FEATURES, KINDS, PRECISIONS, DataSource, TrainConfig

_ANY = math.inf
#: Least and most of each setting, both allowed: ``<section>.<name>``, or the run's own.
_BOUNDS: dict[str, tuple[float, float]] = {
    name: bounds
    for bounds, names in {
        (0, 2**63 - 1): "seed",
        (1, _ANY): "batch lanes network.hidden network.blocks network.heads network.mlp_ratio "
        "draw.points schedule.steps loss.auxiliary_points validation.objects validation.points "
        "validation.batch run.log_every run.checkpoint_every run.ahead",
        (2, _ANY): "network.max_parts",
        (0, 0.99): "network.dropout",
        (0, _ANY): "draw.context draw.shift draw.stretch schedule.warm_up optimiser.weight_decay "
        "optimiser.clip run.micro_batch run.workers run.threads run.cache_mb run.validate_every",
        (1e-3, 1e3): "draw.scale",
        (0, 1): "schedule.rate schedule.last_rate optimiser.ema",
        (0, 0.99999): "optimiser.betas",
    }.items()
    for name in names.split()
}
_OF_SOURCES = {"weight": (1e-9, 1e9), "reuse": (1, _ANY), "points": (1, _ANY), "objects": (0, _ANY)}


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
    data = _sources(table.pop("data", []), f"{where}: data")
    held_out = _sources(table.pop("held_out", []), f"{where}: held_out")
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
    _require_within(config, where)
    if network.hidden % network.heads:
        said = f"{network.heads} do not divide the width {network.hidden}"
        raise ConfigError(f"{where}: network.heads: {said}")
    if not config.data:
        kinds = ", ".join(KINDS)
        raise ConfigError(f"{where}: no [[data]]; want at least one source, of kind {kinds}")


def _require_within(config: TrainConfig, where: str) -> None:
    """Refuse numbers with which nothing could be trained; ``where`` they are from, for the message.

    Raises:
        ConfigError: names the first such setting, and what it can be.
    """
    drawn = (each.name for each in fields(config.draw))
    shares = {f"draw.{name}": (0.0, 1.0) for name in drawn if name.endswith("_share")}
    weights = {f"loss.{each.name}": (0.0, _ANY) for each in fields(config.loss)}
    for name, bounds in {**shares, **weights, **_BOUNDS}.items():
        holder: Any = config
        for step in name.split("."):
            holder = getattr(holder, step)
        _require(holder, bounds, f"{where}: {name}")
    for name in ("draw.scale", "optimiser.betas"):
        section, _, field = name.partition(".")
        pair = getattr(getattr(config, section), field)
        if len(pair) != 2 or (name == "draw.scale" and pair[0] > pair[1]):
            wanted = "two numbers, the lower one first"
            raise ConfigError(f"{where}: {name} must be {wanted}, not {list(pair)}")
    for list_name in ("data", "held_out"):
        for number, source in enumerate(getattr(config, list_name), start=1):
            for name, bounds in _OF_SOURCES.items():
                _require(getattr(source, name), bounds, f"{where}: {list_name} {number}: {name}")


def _require(value: Any, bounds: tuple[float, float], what: str) -> None:
    least, most = bounds
    for number in value if isinstance(value, tuple) else (value,):
        if not isinstance(number, int | float) or not least <= number <= most or math.isinf(number):
            said = f"{least:g} or more" if math.isinf(most) else f"{least:g} to {most:g}"
            raise ConfigError(f"{what} must be {said}, not {number!r}")
