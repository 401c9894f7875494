"""What a night is to do: a TOML file of differences from these defaults."""

from __future__ import annotations

import os
import tomllib
from dataclasses import dataclass, field, fields, is_dataclass, replace
from difflib import get_close_matches
from math import isfinite
from pathlib import Path
from typing import Any

from ...config import BuildConfig
from ...errors import ConfigError
from ...intake.licenses import UNKNOWN
from ...presets import load_config, overlay

ALL_INPUTS, SHARED_INPUTS = "all", "shared"
SHIPPED = "shipped"
LOCAL = "local"
EXECUTORS = (LOCAL, "ray")


@dataclass(frozen=True)
class Budget:
    """When a night stops before all inputs are done. The rest is left to the next night.

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
class Licences:
    """Which inputs may be built.

    Attributes:
        allowed: licences as sidecars, files and ``asset.json`` state them, or patterns such as
            ``CC0-*``, case aside; empty: all of them.
        unknown: whether inputs that state none may be.
    """

    allowed: tuple[str, ...] = ()
    unknown: bool = True

    @property
    def names(self) -> tuple[str, ...]:
        """The same for those who read inputs: :attr:`~..config.IntakeConfig.allowed_licenses`."""
        if self.unknown:
            return (*self.allowed, UNKNOWN) if self.allowed else ()
        return self.allowed or ("*",)


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
class Failure:
    """What makes the exit code differ from 0.

    Attributes:
        unjudged: an input that could not be judged.
        damage: an asset whose files are not what was registered.
        yield_drop: the share that passed fell by more than this against the night before, 0 to 1;
            1: never.
        over: ``all``: inputs of each night; ``shared``: those that both nights had, whatever came
            in since.
    """

    unjudged: bool = True
    damage: bool = True
    yield_drop: float = 0.05
    over: str = ALL_INPUTS


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
        exchange: where workers on other machines put what they made: a URL as fsspec names it;
            empty: the output's folder is the same one on all of them.
        verify: whether every asset's files are compared with what was registered.
        preset: the build's settings: a preset, or a TOML file of differences from the defaults.
        build: those settings, with the differences of the table ``[build]``.
        budget, licences, upkeep, failure: see there.
    """

    inputs: tuple[Path, ...] = ()
    output: Path = Path("out")
    sim: str = "sapien"
    workers: int = 0
    executor: str = "local"
    ray_address: str = "local"
    exchange: str = ""
    verify: bool = True
    preset: str = "default"
    build: BuildConfig = field(default_factory=BuildConfig)
    budget: Budget = field(default_factory=Budget)
    licences: Licences = field(default_factory=Licences)
    upkeep: Upkeep = field(default_factory=Upkeep)
    failure: Failure = field(default_factory=Failure)


def load_night(path: Path) -> NightConfig:
    """The night that a TOML file describes; relative paths in it start from its folder.

    Raises:
        ConfigError: unreadable, a setting that does not exist, or one that cannot be; names what
            would work.
    """
    try:
        stated = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigError(f"{path}: {error}") from error
    base, where = path.resolve().parent, path.name
    _require_known(stated, NightConfig(), where)
    inputs = _paths(stated.pop("inputs", []), base, f"{where}: inputs")
    outputs = _paths([stated.pop("output", "out")], base, f"{where}: output")
    build = stated.pop("build", {})
    config = replace(overlay(NightConfig(), stated, where), inputs=inputs, output=outputs[0])
    preset = str(base / config.preset) if config.preset.endswith(".toml") else config.preset
    if not isinstance(build, dict):
        raise ConfigError(f"{where}: build: is {build!r}, want a table of settings")
    settled = overlay(load_config(preset), build, f"{where}: build")
    return replace(config, preset=preset, build=_with_weights(settled, base))


def with_licences(config: NightConfig) -> NightConfig:
    """The same night, whose build refuses what states another licence. Raises ConfigError where both say something."""
    intake = config.build.intake
    if not config.licences.names:
        return config
    if intake.allowed_licenses not in ((), config.licences.names):
        raise ConfigError(
            "licences and build.intake.allowed_licenses both say what is allowed; want one of them"
        )
    return replace(
        config,
        build=replace(config.build, intake=replace(intake, allowed_licenses=config.licences.names)),
    )


def require_possible(config: NightConfig) -> None:
    """Find out now what would fail in the night.

    Raises:
        ConfigError: a setting that cannot be; names it and what would work.
    """
    from ...articulate.catalog import ARTICULATORS
    from ...articulate.settings import require_usable

    if not config.inputs:
        raise ConfigError(
            "inputs: none; name files or folders in the configuration, or with --input"
        )
    if not 0.0 <= config.failure.yield_drop <= 1.0:
        raise ConfigError(
            f"failure.yield_drop: is {config.failure.yield_drop:g}, want a share from 0 to 1"
        )
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
    if config.executor not in EXECUTORS:
        raise ConfigError(
            f"executor: no executor {config.executor!r}; there are {', '.join(EXECUTORS)}"
        )
    if config.failure.over not in (ALL_INPUTS, SHARED_INPUTS):
        raise ConfigError(
            f"failure.over: is {config.failure.over!r}, want {ALL_INPUTS} or {SHARED_INPUTS}"
        )
    lists = {
        "licences.allowed": config.licences.allowed,
        "budget.retry_rejected": config.budget.retry_rejected,
    }
    for name, told in lists.items():
        if not all(isinstance(item, str) for item in told):
            raise ConfigError(f"{name}: is {list(told)}, want texts")
    if config.build.articulator not in ARTICULATORS:
        names = ", ".join(ARTICULATORS)
        raise ConfigError(
            f"build.articulator: no articulator {config.build.articulator!r}; there are {names}"
        )
    require_usable(config.build.particulate, needed=config.build.articulator == "particulate")


def _require_known(stated: dict[str, Any], default: object, where: str) -> None:
    known = [item.name for item in fields(default)]  # type: ignore[arg-type]
    for name, value in stated.items():
        if name not in known:
            near = get_close_matches(name, known, n=1)
            hint = f"did you mean {near[0]!r}? " if near else ""
            raise ConfigError(
                f"{where}: no setting {name!r}; {hint}there are {', '.join(sorted(known))}"
            )
        inner = getattr(default, name)
        if isinstance(value, dict) and is_dataclass(inner):
            _require_known(value, inner, f"{where}: {name}")


def _paths(stated: object, base: Path, where: str) -> tuple[Path, ...]:
    if not isinstance(stated, list) or not all(isinstance(item, str) and item for item in stated):
        raise ConfigError(
            f"{where}: is {stated!r}, want paths, relative to the configuration's folder"
        )
    return tuple(Path(os.path.normpath(base / Path(item).expanduser())) for item in stated)


def _with_weights(build: BuildConfig, base: Path) -> BuildConfig:
    checkpoint, features = (
        str(base / value) if value and not _is_name(value) else value
        for value in (build.particulate.checkpoint, build.particulate.features)
    )
    return replace(
        build, particulate=replace(build.particulate, checkpoint=checkpoint, features=features)
    )


def _is_name(weights: str) -> bool:
    return weights == SHIPPED or weights.startswith("hf:")
