"""Settings of the network's articulator, checked before any input is touched."""

from __future__ import annotations

from importlib.util import find_spec

from ..config import ParticulateConfig
from ..errors import ConfigError
from ..models.network.shape import Precision, read_shape
from ..models.partfield.shape import read_partfield_shape
from ..models.particulate.components import COMPONENT_FEATURES
from ..models.particulate.decoding import TreeOver
from ..models.particulate.inference import MOST_SAMPLES
from ..models.particulate.labels import Refinement
from ..models.weights.checkpoint import open_checkpoint
from ..models.weights.sources import PARTFIELD, SHIPPED, fetch

NEEDS_TORCH = (
    "the network needs torch: pip install 'asset-factory[particulate]'; "
    "or name an articulator that asks none: --articulator geometric, stated or annotated"
)
LEAST = {"driving": 0, "points": 1, "context_points": 1, "max_faces": 4, "samples": 1}


def require_possible(config: ParticulateConfig) -> None:
    """Raise ConfigError for a setting that cannot be, and say what can."""
    for setting, least in LEAST.items():
        value = getattr(config, setting)
        if value < least:
            raise ConfigError(f"{setting} must be at least {least}, not {value}")
    if config.samples > MOST_SAMPLES:
        raise ConfigError(f"samples must be at most {MOST_SAMPLES}, not {config.samples}")
    for setting, known in (
        ("refinement", Refinement),
        ("tree", TreeOver),
        ("precision", Precision),
    ):
        if getattr(config, setting) not in set(known):
            raise ConfigError(
                f"{setting} must be one of {', '.join(known)}, not {getattr(config, setting)!r}"
            )
    for setting in ("least_confidence", "fused_share"):
        if not 0.0 <= getattr(config, setting) <= 1.0:
            raise ConfigError(f"{setting} must be 0 to 1, not {getattr(config, setting):g}")


def require_usable(config: ParticulateConfig, needed: bool) -> None:
    """Refuse settings that no input could be built with; reads checkpoint headers, not weights.

    Args:
        config: as given.
        needed: whether the network is asked for by name.

    Raises:
        ConfigError: which setting, what it is, what it should be; or a checkpoint that is missing
            or another network's.
    """
    require_possible(config)
    if config.checkpoint == SHIPPED and not needed:
        return
    wanted = open_checkpoint(fetch(config.checkpoint)).read(read_shape).features
    if wanted in (0, COMPONENT_FEATURES):
        return
    if not config.features:
        raise ConfigError(
            f"{config.checkpoint}: wants {wanted} features per point: "
            f"name the weights of {PARTFIELD.network} with "
            f"--features, e.g. {PARTFIELD.source}. {PARTFIELD.terms}"
        )
    open_checkpoint(fetch(config.features)).read(read_partfield_shape)


def require_torch() -> None:
    """Raise ConfigError where no network can run, and say what can be done about it."""
    if find_spec("torch") is None:
        raise ConfigError(NEEDS_TORCH)
