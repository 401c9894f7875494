"""Flags that several commands share: how inputs are read, and who judges."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from asset_factory.sim_checks.simulators.catalog import SIMULATORS

from ..articulate.choose import ARTICULATORS
from ..config import BuildConfig
from ..errors import ConfigError
from ..presets import load_config

DEFAULT_SIMULATORS = "sapien"


@dataclass(frozen=True)
class Reading:
    """How inputs are loaded, and who says what moves."""

    articulator: str = "auto"
    """Who says what moves: auto, annotated, geometric, particulate or rigid."""
    checkpoint: str | None = None
    """Weights for particulate, which auto then asks alone: a file, or hf:owner/repository/file."""
    features: str | None = None
    """Weights of its feature extractor, where those want features: a file, or hf:owner/repository/file."""
    points: int | None = None
    """Points that particulate labels per sample."""
    samples: int | None = None
    """Samples that particulate reads; the one that agrees most with the others is taken."""
    up: str = "auto"
    """Axis of the input that points up: x, y, z, -x, -y, -z, or auto (glTF: y; everything else: z)."""
    height: float | None = None
    """Real height to scale every input to [m]."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""


def reading_config(reading: Reading) -> BuildConfig:
    """The configuration that flags ask for. Raises ConfigError: a flag that cannot be, and what would be right."""
    from ..articulate.settings import require_usable
    from ..intake.orientation import parse_up

    config = load_config(reading.config)
    if reading.articulator not in ARTICULATORS:
        raise ConfigError(
            f"--articulator: no articulator {reading.articulator!r}; there are {', '.join(ARTICULATORS)}"
        )
    if reading.height is not None and not reading.height > 0.0:
        raise ConfigError(f"--height: is {reading.height:g} m, want more than 0")
    up = reading.up if reading.up == "auto" else parse_up(reading.up)
    intake = replace(config.intake, up=up, height=reading.height)
    asked = ("checkpoint", "features", "points", "samples")
    given: dict[str, Any] = {
        name: getattr(reading, name) for name in asked if getattr(reading, name) is not None
    }
    particulate = replace(config.particulate, **given)
    require_usable(particulate, needed=reading.articulator == "particulate")
    return replace(config, articulator=reading.articulator, intake=intake, particulate=particulate)


def simulators_named(names: str) -> tuple[str, ...]:
    """Simulators by their names, separated by commas, or ``all``. Raises ConfigError that names what exists."""
    if names == "all":
        return tuple(SIMULATORS)
    chosen = tuple(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    unknown = [name for name in chosen if name not in SIMULATORS]
    if unknown:
        raise ConfigError(
            f"--sim: no simulator {unknown[0]!r}; there are {', '.join(SIMULATORS)}, or 'all'"
        )
    return chosen
