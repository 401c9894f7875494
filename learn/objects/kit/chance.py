"""Random draws: sizes, shares, looks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from .spans import Span

T = TypeVar("T")


class Chance:
    """Random draws, all from one generator: same generator, same draws."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng

    def draw(self, low: float, high: float) -> float:
        """Return a number between two."""
        return low + (high - low) * self.rng.random()

    def draws(self, *spans: Span) -> tuple[float, ...]:
        """Return a number from each span."""
        return tuple(low + (high - low) * self.rng.random() for low, high in spans)

    def count(self, low: int, high: int) -> int:
        """Return a whole number, both ends included."""
        return int(self.rng.integers(low, high + 1))

    def degrees(self, low: float, high: float) -> float:
        """Return an angle between two, in whole degrees, as radians."""
        return float(np.radians(self.rng.integers(round(low), round(high) + 1)))

    def happens(self, share: float) -> bool:
        """Return true in this share of cases."""
        return bool(self.rng.random() < share)

    def happen(self, *shares: float) -> tuple[bool, ...]:
        """Return whether each of several things happens, in its share of cases."""
        return tuple(self.happens(share) for share in shares)

    def sign(self) -> float:
        """Return 1 or -1."""
        return 1.0 if self.rng.random() < 0.5 else -1.0

    def pick(self, *things: T) -> T:
        """Return one of several, each as often."""
        return things[int(self.rng.random() * len(things))]

    def picks(self, *choices: tuple[T, ...]) -> tuple[T, ...]:
        """Return one of each several."""
        return tuple(self.pick(*choice) for choice in choices)

    def weighted(self, weights: Mapping[T, float]) -> T:
        """Return one of the keys, as often as their weights say."""
        left = self.rng.random() * sum(weights.values())
        for thing, weight in weights.items():
            left -= weight
            if left < 0.0:
                return thing
        return thing
