"""The running mean of the weights, which generalises better than the last ones."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - this module is only imported to train

Tensor = Any


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
            torch._foreach_lerp_(
                [self.weights[name] for name in names], [now[name] for name in names], 1.0 - decay
            )

    def load(self, weights: dict[str, Tensor]) -> None:
        """Go on from a stored mean."""
        for name, tensor in self.weights.items():
            tensor.copy_(weights[name])
