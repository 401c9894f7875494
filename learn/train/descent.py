"""One step down a loss, whatever network it is of; and the running mean of the weights."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.errors import ConfigError

from .checkpoints import State, fill

Tensor = Any
_MOST_MISSED = 20
"""Steps in a row whose gradients are not finite, after which a run ends."""


class RunningMean:
    """A mean of a network's weights in which the last steps count most; of integers, the last.

    ``decay`` is the share of the mean that stays at each step; in the first steps less does, so
    that the random start is forgotten.
    """

    def __init__(self, network: Any, decay: float) -> None:
        self.decay = decay
        self.weights: dict[str, Tensor] = {
            name: each.detach().clone() for name, each in network.state_dict().items()
        }

    def update(self, network: Any, step: int) -> None:
        """Take in the weights after a step, counted from 0."""
        decay = min(self.decay, (1.0 + step) / (10.0 + step))
        now = network.state_dict()
        whole = [name for name, each in self.weights.items() if not each.is_floating_point()]
        for name in whole:
            self.weights[name].copy_(now[name])
        names = [name for name in self.weights if name not in whole]
        with torch.no_grad():
            means = [self.weights[name] for name in names]
            torch._foreach_lerp_(means, [now[name] for name in names], 1.0 - decay)

    def load(self, weights: dict[str, Tensor]) -> None:
        """Go on from a stored mean."""
        for name, tensor in self.weights.items():
            tensor.copy_(weights[name])


class Descent:
    """A network's optimiser, and the running mean of its weights, which is shipped.

    ``clip`` is the largest norm of the gradient, 0: any.
    """

    def __init__(self, network: Any, optimiser: Any, clip: float, ema: float) -> None:
        self.network = network
        self.optimiser = optimiser
        self.mean = RunningMean(network, ema)
        self._clip = clip or math.inf
        self._missed = 0

    def restore(self, state: State, path: Path) -> None:
        """Go back to a stored state.

        Raises:
            ConfigError: it is another network's; says that of the file at ``path``.
        """
        for weights in (state.mean, state.weights):
            fill(self.network, weights, path)
        self.mean.load(state.mean)
        try:
            self.optimiser.load_state_dict(state.optimiser)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise ConfigError(f"{path}: its optimiser's state does not fit: {error}") from error

    def step(self, step: int, rate: float) -> Tensor:
        """Move the weights along the gradients, unless those are not finite; returns their norm.

        Steps count from 0.

        Raises:
            ConfigError: they have not been finite for many steps.
        """
        for each in self.optimiser.param_groups:
            each["lr"] = rate
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), self._clip)
        # One bad step must not end the run: a sample may be so odd that it overflows.
        if bool(torch.isfinite(norm)):
            self.optimiser.step()
            self.mean.update(self.network, step)
            self._missed = 0
        else:
            self._missed += 1
        if self._missed >= _MOST_MISSED:
            said = f"the gradients of {_MOST_MISSED} steps in a row are not finite"
            wanted = "want a lower schedule.rate, or look at the data"
            kept = "so nothing is learnt; the checkpoint is from before"
            raise ConfigError(f"step {step}: {said}, {kept}; {wanted}")
        return norm.detach()
