"""What generators put on surfaces though nothing opens there: planks, straps, plates, grain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray

#: How often an object has each of them.
PLANKED = 0.35
STRAPPED = 0.25
PLATED = 0.3
GRAINED = 0.4
#: How often planks and straps run over all that is seen, not over single parts.
OVERALL = 0.5
#: Of single parts so many are decorated, and so many of these the other way round.
TAKEN = 0.7
OTHERWISE = 0.2
#: Grooves between planks are so wide [pixels].
GROOVE = 1.5


@dataclass(frozen=True)
class Decoration:
    """What it adds to a side.

    Attributes:
        height: above the surface [pixels], shape [rows, columns].
        light: by which colours are multiplied, shape [rows, columns].
    """

    height: FloatArray
    light: FloatArray


@dataclass(frozen=True)
class Decorations:
    """What one object is decorated with; drawn once, for all its sides.

    Attributes:
        planks: distance of grooves [pixels], 0 for none, how deep [pixels] and how bright.
        straps: where bands run, as shares of what they cross.
        band: half their width, their height [pixels] and how bright they are.
        level: whether planks and straps run from left to right; straps, if both are there, across.
        overall: whether they run over everything, or over parts, each of its own choice.
        plates: how many small fields lie on it, their height [pixels] and how bright they are.
        grain: brightness that streaks vary by.
    """

    planks: tuple[float, float, float]
    straps: tuple[float, ...]
    band: tuple[float, float, float]
    level: bool
    overall: bool
    plates: tuple[int, float, float]
    grain: float

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Decorations:
        """Return some generator's taste."""

        def draw(low: float, high: float) -> float:
            return float(rng.uniform(low, high))

        planked, strapped, plated, grained = rng.random(4) < (PLANKED, STRAPPED, PLATED, GRAINED)
        margin = draw(0.05, 0.3)
        count = int(rng.integers(1, 5)) if strapped else 0
        return cls(
            planks=(draw(12.0, 60.0) if planked else 0.0, draw(0.0, 1.5), draw(0.4, 1.0)),
            straps=tuple(float(each) for each in np.linspace(margin, 1.0 - margin, count)),
            band=(draw(1.0, 8.0), draw(-0.5, 3.0), draw(0.3, 1.3)),
            level=bool(rng.random() < 0.5),
            overall=bool(rng.random() < OVERALL),
            plates=(int(rng.integers(1, 7)) if plated else 0, draw(-1.0, 1.5), draw(0.5, 1.4)),
            grain=draw(0.02, 0.12) if grained else 0.0,
        )

    def on(self, part: IntArray, rng: np.random.Generator) -> Decoration:
        """Return how they look on one side, of which the part of every pixel is known."""
        height = np.zeros(part.shape)
        light = np.ones(part.shape)
        for where, level in self._regions(part, rng):
            line = where & self._lines(where, level)
            height[line] -= self.planks[1]
            light[line] *= self.planks[2]
            bands = where & self._bands(where, level != bool(self.planks[0]))
            height[bands] += self.band[1]
            light[bands] *= self.band[2]
        for _ in range(self.plates[0]):
            field = _field(part.shape, rng)
            height[field] += self.plates[1]
            light[field] *= self.plates[2]
        return Decoration(
            height, light * (1.0 + self.grain * _streaks(part.shape, self.level, rng))
        )

    def _regions(
        self, part: IntArray, rng: np.random.Generator
    ) -> Iterator[tuple[BoolArray, bool]]:
        if self.overall:
            yield np.ones(part.shape, np.bool_), self.level
            return
        for each in np.unique(part):
            if rng.random() < TAKEN:
                yield part == each, self.level != (rng.random() < OTHERWISE)

    def _lines(self, where: BoolArray, level: bool) -> BoolArray:
        step = self.planks[0]
        if not step:
            return np.zeros(where.shape, np.bool_)
        return np.asarray((_along(where, level)[0] + 0.5 * step) % step < GROOVE)

    def _bands(self, where: BoolArray, level: bool) -> BoolArray:
        along, extent = _along(where, level)
        found = np.zeros(where.shape, np.bool_)
        for share in self.straps:
            found |= np.abs(along - share * extent) <= self.band[0]
        return found


def _along(where: BoolArray, level: bool) -> tuple[FloatArray, float]:
    """Return every pixel's distance from the region's edge across its lines, and its extent."""
    axis = 0 if level else 1
    held = np.flatnonzero(where.any(axis=1 - axis))
    place = np.indices(where.shape)[axis] - held[0]
    return np.asarray(place, np.float64), float(held[-1] - held[0] + 1)


def _field(shape: tuple[int, ...], rng: np.random.Generator) -> tuple[slice, slice]:
    """Return a small rectangle somewhere."""
    size = rng.uniform(5.0, 60.0, 2).astype(int)
    low = [int(rng.integers(max(whole - each, 1))) for whole, each in zip(shape, size, strict=True)]
    return slice(low[0], low[0] + int(size[0])), slice(low[1], low[1] + int(size[1]))


def _streaks(shape: tuple[int, ...], level: bool, rng: np.random.Generator) -> FloatArray:
    """Return the noise that is ten times as long as wide, of standard deviation one."""
    sigma = (1.0, 10.0) if level else (10.0, 1.0)
    noise = ndimage.gaussian_filter(rng.normal(size=shape), sigma)
    return np.asarray(noise / max(float(noise.std()), 1e-9))
