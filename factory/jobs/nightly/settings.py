"""What a night is to do: a TOML file of differences from these defaults.

configs/nightly.toml states every setting, with its unit and what it does.
"""

from __future__ import annotations

import os
import tomllib
from dataclasses import dataclass, field, replace
from math import isfinite
from operator import attrgetter
from pathlib import Path
from typing import Any

from ...config import BuildConfig
from ...errors import ConfigError
from ...models.weights.sources import HUB, SHIPPED
from ...presets import load_config, overlay
from ...report.nightly.outcome import ALL_INPUTS, SHARED_INPUTS, FailureRules
from ...runtime.remote import is_url
from .licenses import Licenses

EXECUTORS = ("local", "ray")
#: Settings that are numbers of at least 0.
_AMOUNTS = (
    *("workers", "budget.limit", "budget.max_hours", "upkeep.cache_days", "upkeep.cache_gb"),
    *("failure.source.nights", "failure.source.least"),
)


@dataclass(frozen=True)
class NightBudget:
    """When a night stops before all inputs are done; the next one takes up the rest."""

    max_hours: float = 0.0
    limit: int = 0
    retry_rejected: tuple[str, ...] = ()


@dataclass(frozen=True)
class Upkeep:
    """Files to remove after the build; never anything published."""

    enabled: bool = True
    cache_days: float = 0.0
    cache_gb: float = 0.0


@dataclass(frozen=True)
class NightConfig:
    """One night; ``build`` is what ``preset`` and the table ``[build]`` come to."""

    inputs: tuple[Path | str, ...] = ()
    output: Path = Path("out")
    sim: str = "sapien"
    workers: int = 0
    executor: str = "local"
    ray_address: str = "local"
    exchange: str = ""
    verify: bool = True
    mend: bool = True
    preset: str = "default"
    build: BuildConfig = field(default_factory=BuildConfig)
    budget: NightBudget = field(default_factory=NightBudget)
    licenses: Licenses = field(default_factory=Licenses)
    upkeep: Upkeep = field(default_factory=Upkeep)
    failure: FailureRules = field(default_factory=FailureRules)


def load_night(path: Path) -> NightConfig:
    """Return the night that a TOML file describes; relative paths in it start from its folder.

    Raises:
        ConfigError: unreadable, or a setting that does not exist or has another type.
    """
    try:
        stated = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise ConfigError(f"{path}: {why}") from error
    base = path.resolve().parent
    where = path.name
    inputs = _places(stated.pop("inputs", []), base, f"{where}: inputs")
    (output,) = _places([stated.pop("output", "out")], base, f"{where}: output")
    _require(isinstance(output, Path), f"{where}: output", output, "a folder, by its path")
    differences = stated.pop("build", {})
    _require(isinstance(differences, dict), f"{where}: build", differences, "a table of settings")
    config = overlay(NightConfig(), stated, where)

    preset = str(base / config.preset) if config.preset.endswith(".toml") else config.preset
    build = overlay(load_config(preset), differences, f"{where}: build")
    network = build.particulate
    checkpoint, features = (_weights(x, base) for x in (network.checkpoint, network.features))
    network = replace(network, checkpoint=checkpoint, features=features)
    build = replace(build, particulate=network)
    return replace(config, inputs=inputs, output=Path(output), preset=preset, build=build)


def place_from(stated: str | Path, base: Path) -> Path | str:
    """Return a URL as it is; a path, which may be relative to ``base``, from the root."""
    if isinstance(stated, str) and is_url(stated):
        return stated
    return Path(os.path.normpath(base / Path(stated).expanduser()))


def _places(stated: Any, base: Path, where: str) -> tuple[Path | str, ...]:
    texts = isinstance(stated, list) and all(isinstance(item, str) and item for item in stated)
    _require(texts, where, stated, "paths, relative to the configuration's folder, or URLs")
    return tuple(place_from(item, base) for item in stated)


def _weights(stated: str, base: Path) -> str:
    own = stated and stated != SHIPPED and not stated.startswith(HUB)
    return str(base / stated) if own else stated


def with_licenses(config: NightConfig) -> NightConfig:
    """Return the same night, whose build refuses inputs under another license.

    Raises:
        ConfigError: the build's own settings name other licenses.
    """
    intake = config.build.intake
    names = config.licenses.names
    if not names:
        return config
    if intake.allowed_licenses not in ((), names):
        both = "licenses and build.intake.allowed_licenses both say what is allowed"
        raise ConfigError(f"{both}; want one of them")
    intake = replace(intake, allowed_licenses=names)
    return replace(config, build=replace(config.build, intake=intake))


def require_possible(config: NightConfig) -> None:
    """Find out now what would fail in the night.

    Raises:
        ConfigError: a setting that cannot be; names it and what would work.
    """
    from ...articulate.catalog import ARTICULATORS
    from ...articulate.settings import require_usable

    if not config.inputs:
        raise ConfigError("inputs: none; name files or folders in the configuration or by --input")
    choices = {
        "executor": EXECUTORS,
        "failure.over": (ALL_INPUTS, SHARED_INPUTS),
        "build.articulator": tuple(ARTICULATORS),
    }
    for name in _AMOUNTS:
        amount = attrgetter(name)(config)
        _require(isfinite(amount) and amount >= 0, name, amount, "at least 0")
    for name, known in choices.items():
        chosen = attrgetter(name)(config)
        _require(chosen in known, name, chosen, " or ".join(known))
    for name in ("licenses.allowed", "budget.retry_rejected"):
        stated = attrgetter(name)(config)
        _require(all(isinstance(item, str) for item in stated), name, list(stated), "texts")
    for name in ("failure.yield_drop", "failure.source.drop"):
        drop = attrgetter(name)(config)
        _require(0.0 <= drop <= 1.0, name, drop, "a share from 0 to 1")
    require_usable(config.build.particulate, needed=config.build.articulator == "particulate")


def _require(possible: bool, name: str, stated: object, want: str) -> None:
    if not possible:
        told = f"{stated:g}" if isinstance(stated, float) else repr(stated)
        raise ConfigError(f"{name} must be {want}, not {told}")
