"""How fast the network learns, and from how many points, as the steps go by."""

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
        late_points: points per sample in the last steps; 0: as many as before.
        late_from: share of the steps after which they are drawn.
    """

    steps: int = 100_000
    rate: float = 1e-4
    warm_up: int = 1000
    last_rate: float = 0.01
    late_points: int = 0
    late_from: float = 0.75

    def rate_at(self, step: int) -> float:
        """Return the rate of a step, counted from 0: a line up, then half a cosine down."""
        if step < self.warm_up:
            return self.rate * (step + 1) / self.warm_up
        done = (step - self.warm_up) / max(1, self.steps - self.warm_up)
        falling = 0.5 * (1.0 + math.cos(math.pi * min(1.0, done)))
        return self.rate * (self.last_rate + (1.0 - self.last_rate) * falling)

    def points_at(self, step: int, points: int) -> int:
        """Return the points per sample of a step, where it is ``points`` at first."""
        late = self.late_points and step >= self.late_from * self.steps
        return self.late_points if late else points
