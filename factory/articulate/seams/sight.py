"""What a small picture network sees on a side: which pixels open, where they end, and how.

``learn/fit`` trains it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy import ndimage

from ...mesh import BoolArray, FloatArray
from ...models import picture_network
from ...models.shipped import load_shipped
from .rectangles import Rectangle
from .relief import Relief

FILE = "seams.safetensors"
#: What is given to the network, and what it answers, by name and in order.
CUES = (
    *("seen", "height", "groove", "bump", "slope_right", "slope_up", "light", "red", "yellow"),
    *("up", "aside", "deep"),
)
ANSWERS = ("panel", "lid", "level", "upright", "left", "right", "bottom", "top", "out")
SQUARE = picture_network.SQUARE
GRID = picture_network.GRID
#: Windows that tell grooves and bumps from the rest [pixels].
GROOVE = 9
BUMP = 17

#: A panel runs on where all squares of such a window are so sure to be of one, and no square of
#: the narrower window is surer to be an end.
WITHIN = 7
SURE = 0.7
NEAR = 5
NO_END = 0.15

#: Added to what all squares together say of each way: a glance at few decides nothing.
LEAST_CHANCE = 10.0


@dataclass(frozen=True, eq=False)
class Sight:
    """Probabilities by square, 0 to 1, shape [rows, columns] each; a square is two pixels wide.

    Attributes:
        panel: that it belongs to a door, drawer or flap.
        lid: that it belongs to a lid.
        level, upright: that something which opens ends here, below or above, left or right.
        ways: how it opens, in the order of ``ANSWERS``, shape [5, rows, columns].
    """

    panel: FloatArray
    lid: FloatArray
    level: FloatArray
    upright: FloatArray
    ways: FloatArray

    def shows(self, rectangle: Rectangle) -> float:
        """Return the share of a rectangle that belongs to a panel, 0 to 1; 0 of a tiny one."""
        inside = self.panel[_squares_in(rectangle)]
        return float(inside.mean()) if inside.size else 0.0

    def runs_on(self, shape: tuple[int, ...]) -> BoolArray:
        """Tell where a panel surely does not end, level or upright, shape [2, rows, columns].

        Args:
            shape: of the side [pixels].
        """
        sure = ndimage.minimum_filter(self.panel, WITHIN) >= SURE
        ends = [ndimage.maximum_filter(each, NEAR) for each in (self.level, self.upright)]
        known = np.stack([sure & (each < NO_END) for each in ends])
        pixels = known.repeat(SQUARE, axis=1).repeat(SQUARE, axis=2)
        return np.asarray(pixels[:, : shape[0], : shape[1]])

    def is_of_lid(self, rectangle: Rectangle) -> bool:
        """Return whether more of a rectangle belongs to a lid than to a door, drawer or flap."""
        squares = _squares_in(rectangle)
        return bool(self.lid[squares].sum() > self.panel[squares].sum())

    def ways_of(self, rectangle: Rectangle) -> FloatArray:
        """Return how likely a rectangle opens in each way; even chances in a tiny one."""
        squares = _squares_in(rectangle)
        weights = self.panel[squares]
        chances = LEAST_CHANCE + (self.ways[:, *squares] * weights).sum(axis=(1, 2))
        return np.asarray(chances / chances.sum())


def _squares_in(rectangle: Rectangle) -> tuple[slice, slice]:
    first_row, first_column = rectangle.low // SQUARE + 1
    last_row, last_column = rectangle.high // SQUARE
    return slice(first_row, last_row), slice(first_column, last_column)


def sight_of(relief: Relief) -> Sight:
    """Return the picture network's answer for one side."""
    answer = picture_network.picture_scores(shipped_weights(), cues_of(relief))
    squares = tuple(-(-length // SQUARE) for length in relief.shape)
    answer = answer[:, : squares[0], : squares[1]]
    yes = 1.0 / (1.0 + np.exp(-answer[:4]))
    ways = np.exp(answer[4:] - answer[4:].max(axis=0))
    panel, lid, level, upright = yes
    return Sight(panel, lid, level, upright, ways / ways.sum(axis=0))


def cues_of(relief: Relief) -> FloatArray:
    """Return what the network is given of a side, padded, shape [cue_count, rows, columns]."""
    seen = relief.seen
    height = relief.height
    rows = np.flatnonzero(seen.any(axis=1))
    columns = np.flatnonzero(seen.any(axis=0))
    tall = max(int(np.ptp(rows)), 1)
    up = np.clip((np.arange(seen.shape[0]) - rows[0]) / tall, 0.0, 1.0)
    across = (np.arange(seen.shape[1]) - columns[0]) / max(int(np.ptp(columns)), 1)
    aside = np.abs(2.0 * np.clip(across, 0.0, 1.0) - 1.0)
    slope_up, slope_right = np.gradient(height)
    light, red, yellow = np.moveaxis(relief.lab, -1, 0)
    deep = np.log(max(relief.depth / relief.raster.pixel, 1.0) / tall)
    groove = ndimage.grey_closing(height, size=(GROOVE, GROOVE)) - height
    bump = height - ndimage.grey_opening(height, size=(BUMP, BUMP))
    cues = np.stack(
        [
            np.ones(seen.shape),
            np.clip((height - np.percentile(height[seen], 97.0)) / 12.0, -3.0, 1.0),
            np.clip(groove, 0.0, 4.0) / 2.0,
            np.clip(bump, 0.0, 12.0) / 6.0,
            np.clip(slope_right, -2.0, 2.0),
            np.clip(slope_up, -2.0, 2.0),
            (light - light[seen].mean()) / 25.0,
            red / 40.0,
            yellow / 40.0,
            np.broadcast_to(up[:, None], seen.shape),
            np.broadcast_to(aside, seen.shape),
            np.full(seen.shape, deep),
        ]
    )
    room = [(0, -length % GRID) for length in seen.shape]
    return np.pad(np.where(seen, cues, 0.0), ((0, 0), *room))


@cache
def shipped_weights() -> picture_network.Weights:
    """Return the weights that come with the package, by layer, float32."""
    return {name: each.astype(np.float32) for name, each in load_shipped(FILE).arrays.items()}
