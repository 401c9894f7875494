"""Handles, knobs and latches: small things that stand in front of a face."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from ...mesh import BoolArray, FloatArray, IntArray
from ...views.raster import Side
from .relief import Relief

#: Widths of what is taken off a face, as shares of the picture's shorter side: bars, then knobs.
SCALES = (0.06, 0.12, 0.2)
#: A handle stands off by at least this [pixels]; a panel in front of its frame often by 2.
LEAST_HEIGHT = 2.2
#: And so many times as far as the surface is rough.
NOISE = 6.0
#: Of the pixels on one side of a handle so many belong to the face that carries it; on three sides.
SUPPORTED = 0.7
#: So far around a handle is looked [pixels].
BORDER = 4
#: Its longer side is at least that share of the picture's longer side: 2 cm on a metre.
SMALLEST = 0.02
#: A handle's shorter side is at most this share of the picture's shorter side.
WIDEST = 0.2
#: A bar from outline to outline is at most so thin, as a share of the picture's longer side, and
#: stands off so far [pixels]; a moulding less.
THIN = 0.05
INSET = 3
STANDS_OFF = 5.0
#: Three of one size in a row are controls if their centres lie within this share of their size,
#: and no farther apart than so many times their size; in a column on a side, where drawers have
#: their knobs, so many times.
IN_ROW = 0.35
ALIKE = 1.6
SPACING = 3.5
IN_COLUMN = 2.0
FEWEST = 3
#: Long ones are more, closer and short, as shares of the picture's longer side: doors in a row and
#: drawers in a column have such handles, too.
FEWEST_LONG = 4
SPACING_LONG = 2.5
LONGEST = 0.08
#: What stands off less than this share of the highest handle of a side is none.
OF_HIGHEST = 0.35
#: So many that hardly stand off, by less than so many times the least, are bumps of the surface.
FEWEST_BUMPS = 5
HARDLY = 1.2


@dataclass(frozen=True, eq=False)
class Protrusion:
    """Something small in front of a face, in pixels of one side.

    Attributes:
        low, high: first and last row and column, shape [2] each.
        height: by how much it stands off [pixels].
        fill: share of its box that it covers.
        control: one of three or more alike in a row: turned or pressed, not pulled.
    """

    low: IntArray
    high: IntArray
    height: float
    fill: float
    control: bool = False

    @property
    def center(self) -> FloatArray:
        """Return row and column."""
        return np.asarray((self.low + self.high) / 2.0)

    @property
    def size(self) -> FloatArray:
        """Return the rows and columns."""
        return np.asarray(self.high - self.low + 1.0)

    def holds(self, other: Protrusion) -> bool:
        """Return whether another stands on it: then it is a panel in front of its frame."""
        return bool((other.low > self.low).all() and (other.high < self.high).all())


@dataclass(frozen=True, eq=False)
class Face:
    """A relief without its protrusions.

    Attributes:
        height: of the face alone [pixels], shape [rows, columns].
        covered: where a handle was taken off, shape [rows, columns].
        handles: those taken off.
    """

    height: FloatArray
    covered: BoolArray
    handles: tuple[Protrusion, ...]


def cleared(relief: Relief) -> Face:
    """Take handles off a relief, the thin ones first.

    Args:
        relief: one side.
    """
    short = min(relief.shape)
    height = relief.height
    least = max(LEAST_HEIGHT, NOISE * _roughness(relief))
    covered = np.zeros(relief.shape, dtype=np.bool_)
    found: list[Protrusion] = []
    for scale in SCALES:
        width = max(round(scale * short), 5)
        opened = ndimage.grey_opening(height, size=(width, width))
        labels, _ = ndimage.label(height - opened >= least)
        for index, where in enumerate(ndimage.find_objects(labels), start=1):
            mask = labels[where] == index
            handle = _handle(relief, height, opened, where, mask)
            if handle is None or any(handle.holds(other) for other in found):
                continue
            found.append(handle)
            region = tuple(slice(max(part.start - 2, 0), part.stop + 2) for part in where)
            grown = ndimage.binary_dilation(labels[region] == index, iterations=2)
            grown &= relief.seen[region]
            covered[region] |= grown
            height = height.copy()
            height[region] = np.where(grown, np.minimum(height, opened)[region], height[region])
    bumps = {handle for handle in found if handle.height < HARDLY * least}
    if len(bumps) >= FEWEST_BUMPS:
        found = [handle for handle in found if handle not in bumps]
    return Face(height, covered, _with_controls(found, relief))


def _roughness(relief: Relief) -> float:
    """Measure how far the surface goes up and down from pixel to pixel [pixels]."""
    some = relief.height[::3, ::3]
    rough = np.abs(some - ndimage.median_filter(some, size=3))[relief.seen[::3, ::3]]
    return float(np.percentile(rough, 80)) if rough.size else 0.0


def _handle(
    relief: Relief,
    height: FloatArray,
    opened: FloatArray,
    where: tuple[slice, ...],
    mask: BoolArray,
) -> Protrusion | None:
    """Return a blob as a handle, if it has a handle's size and a face carries it.

    A rim or a plinth reaches from outline to outline; a foot hangs on by one end.
    """
    low = np.array([part.start for part in where])
    high = np.array([part.stop - 1 for part in where])
    size = high - low + 1
    short = min(relief.shape)
    if size.max() < SMALLEST * max(relief.shape) or not 2 <= size.min() <= WIDEST * short:
        return None
    top = float(np.percentile(height[where][mask], 90))
    under = float(np.median(opened[where][mask]))
    most = max(LEAST_HEIGHT, 0.6 * (top - under))
    shares = []
    for strip in _border(low, high, relief.shape):
        seen = relief.seen[strip]
        # The edge of something wider that is still to be taken off.
        if height[strip].size and (height[strip] > under + most).mean() > 1.0 - SUPPORTED:
            return None
        carried = seen & (np.abs(height[strip] - under) < most)
        shares.append(float(carried.mean()) if carried.size else 0.0)
    across = _reaches_across(relief, low, high)
    if across and (min(shares[:2]) < SUPPORTED or top - under < STANDS_OFF):
        return None
    if not across and (sorted(shares)[1] < SUPPORTED or sum(shares) < SUPPORTED * 3.0):
        return None
    if across:
        # What carries it ends where it does.
        low[1] += INSET
        high[1] -= INSET
    return Protrusion(low, high, top - under, float(mask.mean()))


def _reaches_across(relief: Relief, low: IntArray, high: IntArray) -> bool:
    """Tell whether a blob is a thin bar from outline to outline, as on fridges and ovens."""
    first, last = relief.box[:, 1]
    thin = high[0] - low[0] + 1 <= THIN * max(relief.shape)
    return bool(thin and low[1] - first <= BORDER and last - high[1] <= BORDER)


def _border(low: IntArray, high: IntArray, shape: tuple[int, int]) -> list[tuple[slice, slice]]:
    """Return the strips below, above, left and right of a box, clipped to the picture."""
    (bottom, left) = (int(value) for value in low)
    (top, right) = (int(value) for value in high)
    rows = slice(bottom, top + 1)
    columns = slice(left, right + 1)
    return [
        (slice(max(bottom - BORDER, 0), bottom), columns),
        (slice(min(top + 1, shape[0]), top + 1 + BORDER), columns),
        (rows, slice(max(left - BORDER, 0), left)),
        (rows, slice(min(right + 1, shape[1]), right + 1 + BORDER)),
    ]


def _with_controls(found: list[Protrusion], relief: Relief) -> tuple[Protrusion, ...]:
    """Mark the handles that are controls, and drop those far lower than the others."""
    highest = max((handle.height for handle in found), default=0.0)
    found = [handle for handle in found if handle.height >= OF_HIGHEST * highest]
    controls: set[int] = set()
    for handle in found:
        fewest = FEWEST if _is_round(handle) else FEWEST_LONG
        for along, spacing in enumerate(_spacings(handle, relief)):
            row = [j for j, other in enumerate(found) if _beside(handle, other, along)]
            if len(row) >= fewest and _close(found, row, 1 - along, spacing):
                controls |= set(row)
    return tuple(replace(h, control=i in controls) for i, h in enumerate(found))


def _is_round(handle: Protrusion) -> bool:
    return bool(handle.size.max() < ALIKE * handle.size.min())


def _spacings(handle: Protrusion, relief: Relief) -> tuple[float, float]:
    """Return how far apart controls like it may lie in a row and in a column, in their sizes."""
    above = relief.side is Side.TOP
    if _is_round(handle):
        return SPACING, SPACING if above else IN_COLUMN
    if handle.size.max() > LONGEST * max(relief.shape):
        return 0.0, 0.0
    return SPACING_LONG, SPACING_LONG if above else 0.0


def _beside(one: Protrusion, other: Protrusion, along: int) -> bool:
    apart = abs(float(other.center[along] - one.center[along]))
    ratio = other.size / one.size
    alike = bool((ratio >= 1.0 / ALIKE).all() and (ratio <= ALIKE).all())
    return alike and apart <= IN_ROW * float(one.size.max())


def _close(found: list[Protrusion], row: list[int], axis: int, spacing: float) -> bool:
    """Tell whether handles lie side by side, as controls do; drawers' are a drawer apart."""
    places = np.sort([found[j].center[axis] for j in row])
    size = max(float(found[j].size.max()) for j in row)
    return bool(np.median(np.diff(places)) < spacing * size)
