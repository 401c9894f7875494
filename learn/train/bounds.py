"""Which numbers a training run can be asked for."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from asset_factory.factory.errors import ConfigError

if TYPE_CHECKING:
    from .settings import TrainConfig

_ANY = math.inf
#: Least and most of each setting, both allowed; ``<section>.<name>``, with no section for the run's
#: own.
_BOUNDS: dict[str, tuple[float, float]] = {
    "seed": (0, 2**63 - 1),
    **dict.fromkeys(("batch", "lanes"), (1, _ANY)),
    **dict.fromkeys(
        ("network.hidden", "network.blocks", "network.heads", "network.mlp_ratio"), (1, _ANY)
    ),
    "network.max_parts": (2, _ANY),
    "network.dropout": (0, 0.99),
    "draw.points": (1, _ANY),
    **dict.fromkeys(("draw.context", "draw.shift", "draw.stretch"), (0, _ANY)),
    "draw.scale": (1e-3, 1e3),
    "schedule.steps": (1, _ANY),
    "schedule.rate": (0, 1),
    "schedule.warm_up": (0, _ANY),
    "schedule.last_rate": (0, 1),
    "loss.auxiliary_points": (1, _ANY),
    "optimiser.betas": (0, 0.99999),
    **dict.fromkeys(("optimiser.weight_decay", "optimiser.clip"), (0, _ANY)),
    "optimiser.ema": (0, 1),
    **dict.fromkeys(("validation.objects", "validation.points", "validation.batch"), (1, _ANY)),
    **dict.fromkeys(("run.log_every", "run.checkpoint_every", "run.ahead"), (1, _ANY)),
    **dict.fromkeys(
        ("run.micro_batch", "run.workers", "run.threads", "run.cache_mb", "run.validate_every"),
        (0, _ANY),
    ),
}
_OF_SOURCES = {"weight": (1e-9, 1e9), "reuse": (1, _ANY), "points": (1, _ANY), "objects": (0, _ANY)}


def require_within(config: TrainConfig, where: str) -> None:
    """Refuse numbers with which nothing could be trained; ``where`` they are from, for the message.

    Raises:
        ConfigError: names the first such setting, and what it can be.
    """
    shares = {
        f"draw.{each.name}": (0.0, 1.0)
        for each in fields(config.draw)
        if each.name.endswith("_share")
    }
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
            raise ConfigError(
                f"{where}: {name} must be two numbers, the lower one first, not {list(pair)}"
            )
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
