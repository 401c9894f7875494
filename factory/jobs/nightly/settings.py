"""What a night is to do: a TOML file of differences from these defaults."""

from __future__ import annotations

import os
import tomllib
from dataclasses import dataclass, field, replace
from math import isfinite
from pathlib import Path

from ...config import BuildConfig
from ...errors import ConfigError
from ...particulate.weights.sources import HUB, SHIPPED
from ...presets import load_config, overlay
from ...report.nightly.outcome import ALL_INPUTS, SHARED_INPUTS, Failure
from .licenses import Licenses

LOCAL = "local"
EXECUTORS = (LOCAL, "ray")


@dataclass(frozen=True)
class Budget:
    """When a night stops before all inputs are done; the next one takes up the rest.

    Attributes:
        max_hours: no input is begun later than this after the start [h]; 0: no limit.
        limit: inputs begun at most, those known from before not counted; 0: all.
        retry_rejected: reason codes; what did not pass for one of them is built again though
            nothing changed; ``any``: for any.
    """

    max_hours: float = 0.0
    limit: int = 0
    retry_rejected: tuple[str, ...] = ()


@dataclass(frozen=True)
class Upkeep:
    """What is removed after the build; never anything published.

    Attributes:
        enabled: remove what dead processes left, and of the cache what follows.
        cache_days: results that nobody used for so long [days]; 0: none for their age.
        cache_gb: the oldest beyond so much [10^9 bytes]; 0: any amount may stay.
    """

    enabled: bool = True
    cache_days: float = 0.0
    cache_gb: float = 0.0


@dataclass(frozen=True)
class NightConfig:
    """One night.

    Attributes:
        inputs: mesh, URDF and MJCF files, or folders of them.
        output: the registry's folder; nights are kept in its ``nights``.
        sim: simulators that judge, separated by commas, or ``all``.
        workers: inputs built at once; 0: as many as there are processors.
        executor: where workers run: ``local`` or ``ray``.
        ray_address: ``auto`` or ``host:port`` of a cluster that runs; ``local`` starts one.
        exchange: URL, as fsspec names it, where workers on other machines put what they made;
            empty: they see the output's folder.
        verify: whether every asset's files are compared with what was registered.
        preset: the build's settings: a preset, or a TOML file of differences from the defaults.
        build: those settings, with the differences of the table ``[build]``.
        budget, licenses, upkeep, failure: see there.
    """

    inputs: tuple[Path, ...] = ()
    output: Path = Path("out")
    sim: str = "sapien"
    workers: int = 0
    executor: str = LOCAL
    ray_address: str = "local"
    exchange: str = ""
    verify: bool = True
    preset: str = "default"
    build: BuildConfig = field(default_factory=BuildConfig)
    budget: Budget = field(default_factory=Budget)
    licenses: Licenses = field(default_factory=Licenses)
    upkeep: Upkeep = field(default_factory=Upkeep)
    failure: Failure = field(default_factory=Failure)


def load_night(path: Path) -> NightConfig:
    """The night that a TOML file describes; relative paths in it start from its folder.

    Raises:
        ConfigError: unreadable, or a setting that does not exist or has another type.
    """
    try:
        stated = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigError(f"{path}: {error}") from error
    base = path.resolve().parent
    where = path.name
    inputs = _paths(stated.pop("inputs", []), base, f"{where}: inputs")
    outputs = _paths([stated.pop("output", "out")], base, f"{where}: output")
    differences = stated.pop("build", {})
    config = replace(overlay(NightConfig(), stated, where), inputs=inputs, output=outputs[0])

    preset = str(base / config.preset) if config.preset.endswith(".toml") else config.preset
    if not isinstance(differences, dict):
        raise ConfigError(f"{where}: build: is {differences!r}, want a table of settings")
    build = overlay(load_config(preset), differences, f"{where}: build")
    weights = replace(
        build.particulate,
        checkpoint=_weights(build.particulate.checkpoint, base),
        features=_weights(build.particulate.features, base),
    )
    return replace(config, preset=preset, build=replace(build, particulate=weights))


def _paths(stated: object, base: Path, where: str) -> tuple[Path, ...]:
    if not isinstance(stated, list) or not all(isinstance(item, str) and item for item in stated):
        want = "want paths, relative to the configuration's folder"
        raise ConfigError(f"{where}: is {stated!r}, {want}")
    return tuple(Path(os.path.normpath(base / Path(item).expanduser())) for item in stated)


def _weights(stated: str, base: Path) -> str:
    own = stated and stated != SHIPPED and not stated.startswith(HUB)
    return str(base / stated) if own else stated


def with_licenses(config: NightConfig) -> NightConfig:
    """The same night, whose build refuses what is under another license.

    Raises:
        ConfigError: the build's own settings name other licenses.
    """
    intake = config.build.intake
    names = config.licenses.names
    if not names:
        return config
    if intake.allowed_licences not in ((), names):
        both = "licenses and build.intake.allowed_licences both say what is allowed"
        raise ConfigError(f"{both}; want one of them")
    intake = replace(intake, allowed_licences=names)
    return replace(config, build=replace(config.build, intake=intake))


def require_possible(config: NightConfig) -> None:
    """Find out now what would fail in the night.

    Raises:
        ConfigError: a setting that cannot be; names it and what would work.
    """
    from ...articulate.choose import ARTICULATORS
    from ...articulate.settings import require_usable

    if not config.inputs:
        raise ConfigError("inputs: none; name files or folders in the configuration or by --input")
    drop = config.failure.yield_drop
    if not 0.0 <= drop <= 1.0:
        raise ConfigError(f"failure.yield_drop: is {drop:g}, want a share from 0 to 1")
    amounts = {
        "workers": config.workers,
        "budget.limit": config.budget.limit,
        "budget.max_hours": config.budget.max_hours,
        "upkeep.cache_days": config.upkeep.cache_days,
        "upkeep.cache_gb": config.upkeep.cache_gb,
    }
    for name, amount in amounts.items():
        if not (isfinite(amount) and amount >= 0):
            raise ConfigError(f"{name}: is {amount:g}, want at least 0")
    choices = {
        "executor": (config.executor, EXECUTORS),
        "failure.over": (config.failure.over, (ALL_INPUTS, SHARED_INPUTS)),
        "build.articulator": (config.build.articulator, tuple(ARTICULATORS)),
    }
    for name, (chosen, known) in choices.items():
        if chosen not in known:
            raise ConfigError(f"{name}: is {chosen!r}, want {' or '.join(known)}")
    lists = {
        "licenses.allowed": config.licenses.allowed,
        "budget.retry_rejected": config.budget.retry_rejected,
    }
    for name, stated in lists.items():
        if not all(isinstance(item, str) for item in stated):
            raise ConfigError(f"{name}: is {list(stated)}, want texts")
    require_usable(config.build.particulate, needed=config.build.articulator == "particulate")
