"""Rectangles of a front that may be panels: closed by seams, or cut between handles."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...mesh import BoolArray, FloatArray, IntArray
from ...views.raster import PIXELS
from .dividing import divided
from .handles import Face, Protrusion
from .rectangles import SHORTEST, Lines, Rectangle
from .relief import BEHIND, Relief

#: Rectangles with so much in common (intersection over union) are one.
SAME = 0.8
#: Rectangles looked at, best first.
MOST = 60
MOST_FOUND = 1500
#: A rectangle is cut between at most so many handles.
MOST_PIECES = 20
#: Handles are in one row if they differ in height by no more than this share of the rectangle's.
ROW = 0.05
#: A front is at least so high, as a share of the object's longest extent: no hob, no keyboard.
FLAT = 0.12
#: Handles of one make are alike up to this ratio of their sizes.
ONE_KIND = 2.0
#: A strip along a side, so wide as a share of the rectangle and at least [pixels], that lies so far
#: behind its middle [pixels] belongs to something else: the wall behind a stove's top. Edges that
#: are round to so far in [pixels] do not count.
ROUNDED = 5
STRIP = 0.08
LEAST_STRIP = 4
#: What opens is a container: so thick as a share of the panel's shorter and longer side.
THICK_SHORT = 0.15
THICK_LONG = 0.08
#: A handle belongs to a panel if it is that far inside [pixels].
INSIDE = 1.0


@dataclass(frozen=True, eq=False)
class FrontScene:
    """One side, ready to be searched for panels.

    Attributes:
        relief: the side.
        face: it without handles.
        thickness: how much lies behind each pixel [pixels], shape [rows, columns].
        level, upright: candidate lines.
    """

    relief: Relief
    face: Face
    thickness: FloatArray
    level: Lines
    upright: Lines

    def handles_in(self, rectangle: Rectangle) -> tuple[Protrusion, ...]:
        """Return the pulls in a rectangle, the most prominent first."""
        inside = [
            handle
            for handle in self.face.pulls
            if rectangle.holds(handle.low, INSIDE) and rectangle.holds(handle.high, INSIDE)
        ]
        return tuple(sorted(inside, key=lambda h: -h.height * float(np.sqrt(h.size.prod()))))


@dataclass(frozen=True, eq=False)
class PanelCandidate:
    """What may be a panel, or several that are there together or not at all.

    Attributes:
        rectangle: around them.
        pieces: the rectangle itself, or what it is cut into.
    """

    rectangle: Rectangle
    pieces: tuple[Rectangle, ...]

    @property
    def cut(self) -> bool:
        """Return whether nobody saw a seam between its pieces."""
        return len(self.pieces) > 1


def candidates_of(scene: FrontScene, found: Sequence[Rectangle]) -> list[PanelCandidate]:
    """Return what may be a panel of one side.

    Args:
        scene: the side.
        found: its closed rectangles, the best first.
    """
    first_row, last_row, _, _ = scene.relief.box
    if last_row - first_row < FLAT * PIXELS:
        return []
    fit = usable(scene, (whole_side(scene), *found[:MOST_FOUND]))
    back = steps_back(scene, fit)
    # What steps back may be cut into panels, but is none, and all but the whole side comes last.
    order = sorted(range(len(fit)), key=lambda index: index > 0 and bool(back[index]))
    kept = distinct(scene, fit, order)
    cuts = [cut for index in kept for cut in _divided(scene, fit[index])]
    whole = [PanelCandidate(fit[index], (fit[index],)) for index in kept if not back[index]]
    return [*whole, *cuts]


def whole_side(scene: FrontScene) -> Rectangle:
    """Return all that is seen: the flush front of a box has no other outline."""
    first_row, last_row, first_column, last_column = scene.relief.box
    return Rectangle(
        np.array([first_row, first_column]),
        np.array([last_row, last_column]),
        np.ones(4),
        np.ones(4),
    )


def _divided(scene: FrontScene, rectangle: Rectangle) -> list[PanelCandidate]:
    """Return a rectangle with several pulls, cut between them, or between pairs of them."""
    pulls = main_pulls(scene.handles_in(rectangle), rectangle)
    if len(pulls) < 2 or not of_one_kind(pulls):
        return []
    pulls_of = (pulls, _paired(pulls, rectangle))
    cuts = (cut_between(scene, rectangle, some, MOST_PIECES) for some in pulls_of)
    return [
        PanelCandidate(rectangle, tuple(piece for piece, _ in pieces)) for pieces in cuts if pieces
    ]


def cut_between(
    scene: FrontScene, rectangle: Rectangle, pulls: Sequence[Protrusion], most: int
) -> list[tuple[Rectangle, Protrusion]]:
    """Cut a rectangle between two to ``most`` pulls; return nothing where a piece is too small."""
    if not 2 <= len(pulls) <= most:
        return []
    pieces = divided(rectangle, pulls, scene.level, scene.upright)
    shortest = min((float(piece.size.min()) for piece, _ in pieces), default=0.0)
    return pieces if shortest >= SHORTEST * min(scene.relief.shape) else []


def _paired(pulls: Sequence[Protrusion], rectangle: Rectangle) -> list[Protrusion]:
    """Return two neighbours in every row as one; nothing if rows are odd."""
    rows: list[list[Protrusion]] = []
    for pull in sorted(pulls, key=lambda each: float(each.center[0])):
        if rows and pull.center[0] - rows[-1][-1].center[0] <= ROW * rectangle.size[0]:
            rows[-1].append(pull)
        else:
            rows.append([pull])
    if any(len(row) % 2 for row in rows):
        return []
    pairs = []
    for row in rows:
        row.sort(key=lambda each: float(each.center[1]))
        for left, right in zip(row[::2], row[1::2], strict=True):
            low = np.minimum(left.low, right.low)
            pairs.append(replace(left, low=low, high=np.maximum(left.high, right.high)))
    return pairs


def of_one_kind(pulls: Sequence[Protrusion]) -> bool:
    """Return whether handles are of one make, upright or level, as on one piece of furniture."""
    longest = np.array([float(pull.size.max()) for pull in pulls])
    widest = np.array([float(pull.size.min()) for pull in pulls])
    return bool(
        longest.max() <= ONE_KIND * longest.min() and widest.max() <= ONE_KIND * widest.min() + 2.0
    )


@dataclass(frozen=True)
class PanelLimits:
    """What a rectangle must have to be looked at as a panel.

    Attributes:
        solid: share of it that is seen and faces the viewer.
        area: share of the picture's area that it covers.
        slimmest: its width over its height.
        span: how wide the object is there, as a share of its whole width: no tank on a bowl.
    """

    solid: float = 0.8
    area: float = 0.012
    slimmest: float = 0.0
    span: float = 0.0


def usable(
    scene: FrontScene, found: Sequence[Rectangle], limits: PanelLimits | None = None
) -> list[Rectangle]:
    """Return the rectangles that keep some limits, the lenient ones unless others are given."""
    if not found:
        return []
    least = limits or PanelLimits()
    relief = scene.relief
    box = relief.box
    whole = max((box[1] - box[0]) * (box[3] - box[2]), 1)
    low = np.array([each.low for each in found]) + 2
    high = np.maximum(np.array([each.high for each in found]) - 1, low + 1)
    size = high - low
    facing = relief.seen & ((relief.facing > 0.7) | scene.face.covered)
    rows = mean_in(relief.seen, low * [1, 0], high * [1, 0] + [0, relief.shape[1]])
    good = (
        (size.prod(axis=1) >= least.area * whole)
        & (mean_in(facing, low, high) >= least.solid)
        & (size[:, 1] >= least.slimmest * size[:, 0])
        & (rows * relief.shape[1] >= least.span * (box[3] - box[2]))
    )
    return [each for each, fits in zip(found, good, strict=True) if fits]


def distinct(scene: FrontScene, rectangles: Sequence[Rectangle], order: Sequence[int]) -> list[int]:
    """Return which rectangles, in some order, are deep and unlike those before, at most 60."""
    low = np.array([each.low for each in rectangles])
    high = np.array([each.high for each in rectangles])
    kept: list[int] = []
    for index in order:
        # As :func:`in_common` has it, of all kept ones at once.
        sides = np.minimum(high[index], high[kept]) - np.maximum(low[index], low[kept])
        shared = np.maximum(sides, 0).prod(axis=1)
        both = (high[index] - low[index]).prod() + (high[kept] - low[kept]).prod(axis=1)
        if not (shared / (both - shared) >= SAME).any() and deep(scene, rectangles[index]):
            kept.append(index)
        if len(kept) >= MOST:
            break
    return kept


def steps_back(scene: FrontScene, rectangles: Sequence[Rectangle]) -> BoolArray:
    """Return whether rectangles end in strips that lie far behind their middle, shape [n]."""
    if not rectangles:
        return np.zeros(0, np.bool_)
    low = np.array([each.low for each in rectangles]) + ROUNDED
    high = np.maximum(np.array([each.high for each in rectangles]) - ROUNDED, low + 1)
    seen = scene.relief.seen
    height = np.where(seen, scene.face.height, 0.0)

    def mean_height(low: IntArray, high: IntArray) -> FloatArray:
        share = mean_in(seen, low, high)
        return np.where(share > 0.0, mean_in(height, low, high) / np.maximum(share, 1e-9), np.inf)

    width = np.maximum((STRIP * (high - low)).astype(np.int64), LEAST_STRIP)
    width = np.minimum(width, (high - low) // 3)
    strips = [
        mean_height(*strip)
        for axis in (0, 1)
        for strip in (
            (low, np.where(np.arange(2) == axis, low + width, high)),
            (np.where(np.arange(2) == axis, high - width, low), high),
        )
    ]
    return np.asarray(np.min(strips, axis=0) < mean_height(low + width, high - width) - BEHIND)


def deep(scene: FrontScene, rectangle: Rectangle) -> bool:
    """Return whether there is something behind a rectangle that could be open."""
    inner = tuple(
        slice(int(low), int(high) + 1)
        for low, high in zip(rectangle.low, rectangle.high, strict=True)
    )
    short = float(rectangle.size.min())
    long = float(rectangle.size.max())
    behind = float(np.median(scene.thickness[inner]))
    return behind >= max(THICK_SHORT * short, THICK_LONG * long)


def mean_in(values: FloatArray | BoolArray, low: IntArray, high: IntArray) -> FloatArray:
    """Average a picture in boxes from ``low`` up to, without, ``high``; shape [n, 2] each."""
    sums = np.pad(values.astype(np.float64), ((1, 0), (1, 0))).cumsum(axis=0).cumsum(axis=1)
    total = sums[high[:, 0], high[:, 1]] - sums[low[:, 0], high[:, 1]]
    total += sums[low[:, 0], low[:, 1]] - sums[high[:, 0], low[:, 1]]
    return np.asarray(total / np.maximum((high - low).prod(axis=1), 1))


def main_pulls(handles: Sequence[Protrusion], rectangle: Rectangle) -> list[Protrusion]:
    """Return one handle for each panel: two alike side by side open one wide drawer."""
    if not handles:
        return []
    main = handles[0]
    middle = (rectangle.low + rectangle.high) / 2.0
    pulls = [main]
    for other in handles[1:]:
        level = abs(other.center[0] - main.center[0]) <= 0.1 * rectangle.size[0]
        between = (other.center[1] + main.center[1]) / 2.0
        mirrored = abs(between - middle[1]) <= 0.06 * rectangle.size[1]
        apart = abs(other.center[1] - main.center[1]) >= 0.3 * rectangle.size[1]
        low = rectangle.size[0] <= 0.5 * rectangle.size[1]
        small = other.size.prod() <= 0.35 * main.size.prod() or other.height < 0.5 * main.height
        if not (level and mirrored and apart and low) and not small:
            pulls.append(other)
    return pulls


def is_among(rectangle: Rectangle, others: Iterable[Rectangle]) -> bool:
    """Return whether it is one of several rectangles, give or take an edge."""
    return any(in_common(rectangle, other) >= SAME for other in others)


def in_common(one: Rectangle, other: Rectangle) -> float:
    """Return the intersection over union."""
    shared = one.shared(other)
    return shared / (one.area + other.area - shared)
