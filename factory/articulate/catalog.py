"""The articulators there are: one file each, one line here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from types import MappingProxyType

from ..config import BuildConfig
from ..errors import ConfigError
from ..intake.intake import Intake
from .articulator import Articulator


@dataclass(frozen=True)
class ArticulatorEntry:
    """An articulator that can be asked for.

    Attributes:
        name: on the command line.
        module: in this package; its ``articulator_for(intake, config)`` gives the articulator for
            one input.
        summary: what it goes by, for help and docs.
        asks_network: whether it may ask a trained network.
    """

    name: str
    module: str
    summary: str
    asks_network: bool = False


ARTICULATORS: Mapping[str, ArticulatorEntry] = MappingProxyType(
    {
        entry.name: entry
        for entry in (
            ArticulatorEntry(
                "auto", "auto", "what came with the input, else all of these weighed", True
            ),
            ArticulatorEntry("stated", "stated.articulator", "the parts that its sidecar states"),
            ArticulatorEntry("annotated", "annotated", "the joints that came with the input"),
            ArticulatorEntry("geometric", "geometric", "rules of shape, without learning"),
            ArticulatorEntry("particulate", "particulate", "a trained network", True),
            ArticulatorEntry(
                "vlm",
                "asking.articulator",
                "what came with the input, else a vision-language model",
            ),
            ArticulatorEntry("rigid", "rigid", "one part, no joints"),
        )
    }
)
"""Every articulator, by name."""


def entry_of(name: str) -> ArticulatorEntry:
    """Return the articulator's line. Raises ConfigError naming those there are."""
    if name not in ARTICULATORS:
        raise ConfigError(f"no articulator {name!r}; there are {', '.join(ARTICULATORS)}")
    return ARTICULATORS[name]


def choose(intake: Intake, config: BuildConfig) -> Articulator:
    """Return the articulator that the configuration names, for one input.

    Args:
        intake: the loaded input.
        config: which articulator, and its settings.

    Raises:
        ConfigError: no articulator of that name, or no usable checkpoint for its network.
        InputRejected: ``annotated`` was asked for and the input has no annotation.
    """
    module = import_module(f".{entry_of(config.articulator).module}", __package__)
    articulator: Articulator = module.articulator_for(intake, config)
    return articulator
