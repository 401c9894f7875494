"""How fast the network learns as the steps go by."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class ScheduleSettings:
    """Steps and rates.

    Attributes:
        steps: of the whole run.
        rate: highest learning rate.
        warm_up: steps in which it rises from 0.
        last_rate: share of it that is left at the end of the cosine.
    """

    steps: int = 100_000
    rate: float = 1e-4
    warm_up: int = 1000
    last_rate: float = 0.01

    def rate_at(self, step: int) -> float:
        """Return the rate of a step, counted from 0: a line up, then half a cosine down."""
        if step < self.warm_up:
            return self.rate * (step + 1) / self.warm_up
        done = (step - self.warm_up) / max(1, self.steps - self.warm_up)
        falling = 0.5 * (1.0 + math.cos(math.pi * min(1.0, done)))
        return self.rate * (self.last_rate + (1.0 - self.last_rate) * falling)
