"""Exact looks at two shapes, counted: what bounds the work on one file, on every machine alike."""

from __future__ import annotations

import math


class TooManyLooks(Exception):
    """More exact looks than one file may take."""


class LookBudget:
    """How many exact looks a file may take, and how many it took."""

    def __init__(self, most: float = math.inf) -> None:
        self._most = most
        self._taken = 0

    def take(self, count: int = 1) -> None:
        """Count looks about to be taken.

        Raises:
            TooManyLooks: there would be more than may be.
        """
        self._taken += count
        if self._taken > self._most:
            raise TooManyLooks
