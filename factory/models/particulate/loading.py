"""From a configuration to the networks it names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...config import ParticulateConfig
from ..network.shape import read_shape
from ..weights.checkpoint import open_checkpoint
from ..weights.sources import fetch
from .components import COMPONENT_FEATURES
from .device import device_for

if TYPE_CHECKING:
    from .model import Particulate


def weight_files(config: ParticulateConfig) -> tuple[str, ...]:
    """Return the checkpoints that an answer rests on, as the configuration names them.

    Raises:
        ConfigError: no such checkpoint, or not one of this network.
    """
    wanted = open_checkpoint(fetch(config.checkpoint)).read(read_shape).features
    alone = wanted in (0, COMPONENT_FEATURES)
    return (config.checkpoint,) if alone else (config.checkpoint, config.features)


def load_network(config: ParticulateConfig) -> Particulate:
    """Return the networks with their weights; imports torch, which then has one thread.

    Raises:
        ConfigError: no such checkpoint, or not one of this network.
    """
    import torch

    from .field import load_field
    from .model import Particulate, load_model

    # Sums in another order would have other bits, and workers are as many as processors.
    torch.set_num_threads(1)
    checkpoint, *features = weight_files(config)
    device = device_for(config.device)
    model = load_model(checkpoint, precision=config.precision, device=device)
    field = load_field(features[0], precision=config.precision, device=device) if features else None
    return Particulate(model, field, config.driving or None)
