"""Lids: a seam that runs around all four sides at one height, over something closed on top."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...mesh import BoolArray, FloatArray
from ...views.raster import Side
from .evidence import Seams
from .fronts import AROUND, OPPOSITE, Front
from .relief import Relief
from .sight import SQUARE

#: A lid's height, as a share of the object's: from a flat one to a chest's.
HEIGHT = (0.03, 0.6)
#: The seam's cover on the worst side, and on average.
LEAST_SIDE = 0.3
LEAST_MEAN = 0.6
#: Of the object's footprint the lid covers so much, and is closed there.
FOOTPRINT = 0.7
CLOSED = 0.8
#: Below the seam the body is at least so wide as above it, down to so much of the height.
BODY_WIDTH = 0.6
BODY_HEIGHT = 0.5
#: A roof comes to a point: its mean height is a third to a half of its highest.
POINTED = 0.42
#: So thin is a table's top, as a share of the height; and so flat is what is no box.
SLAB = 0.12
FLAT_TOP = 0.9
FLAT = 0.25
#: A box with a lid is not taller than that many times its longer side.
SLENDER = 2.0
#: Of seams that differ by less in value the upper one is taken.
TIE = 0.5
#: How far the seam may wander up and down [pixels].
WANDER = 3
#: So much of a lid the network must see; and so much of one without a seam on one side, where its
#: hinge hides it, or above several panels.
SEEN = 0.2
CLEARLY_SEEN = 0.3
#: A latch or a handle lies within this share of the height of the seam, or above it; of the side's
#: width it takes at most so much, and lies near its middle (1), where hinges lie near its ends (0).
LATCH_REACH = 0.1
LATCH_WIDTH = 0.4
CENTRAL = 0.6
#: Hinges are at most so wide, as a share of the side's width.
HINGE_WIDTH = 0.2
#: A pedal is what lies within so much of the nearest of a foot [pixels].
NEAREST = 4.0
#: What speaks for a side whose seam alone is not seen, which has hinges, or a latch across; and for
#: one below which wheels reach out.
UNSEEN = 1.5
HINGED = 1.0
LATCHED = 1.2
WHEELED = 2.0
#: Fronts mostly face -Y or +X, so that lids are mostly hinged across from there.
USUAL_HINGE = {Side.BACK: 0.3, Side.LEFT: 0.2, Side.FRONT: 0.0, Side.RIGHT: 0.0}


@dataclass(frozen=True, eq=False)
class Lid:
    """A lid and where it may be hinged.

    Attributes:
        row: of the seam in the pictures of the four sides; the same in all.
        value: what speaks for it, no probability.
        seen: share of it that the picture network takes for a lid, 0 to 1.
        hinges: sides where its hinge may be, likeliest first, with what speaks for each.
    """

    row: int
    value: float
    seen: float
    hinges: tuple[tuple[Side, float], ...]

    def is_seen(self, *, beside_panels: bool) -> bool:
        """Return whether the picture network sees enough of it; it sees some in any top."""
        return self.seen >= (CLEARLY_SEEN if beside_panels else SEEN)


def find_lids(fronts: Mapping[Side, Front], top: Relief) -> list[Lid]:
    """Return what may be a lid, the likeliest first.

    Args:
        fronts: the four sides.
        top: the view from above.
    """
    reliefs = {side: fronts[side].relief for side in AROUND}
    rows = reliefs[Side.FRONT].shape[0]
    seams = [fronts[side].level for side in AROUND]
    covers = np.stack(
        [_cover(reliefs[side], each, each.all) for side, each in zip(AROUND, seams, strict=True)]
    )
    shapes = np.stack(
        [_cover(reliefs[side], each, each.relief) for side, each in zip(AROUND, seams, strict=True)]
    )
    first, last, _, _ = reliefs[Side.FRONT].box
    height = last - first
    found: list[Lid] = []
    strength = covers.mean(axis=0) + 0.5 * shapes.mean(axis=0)
    for row in np.argsort(-strength, kind="stable"):
        share = (last - row) / height
        told = _told(covers[:, row])
        good = covers[told, row].min() >= LEAST_SIDE and covers[told, row].mean() >= LEAST_MEAN
        if not (good and HEIGHT[0] <= share <= HEIGHT[1]) or row >= rows - 2:
            continue
        if any(abs(lid.row - int(row)) <= 2 * WANDER for lid in found):
            continue
        value = _value(fronts, top, int(row), share, covers[told, row], shapes[told, row])
        if value is None:
            continue
        shown = [_seen_above(fronts[side], int(row)) for side in AROUND]
        seen = float(np.mean(shown, where=told))
        hidden = [side for side, tells in zip(AROUND, told, strict=True) if not tells]
        if not hidden or seen >= CLEARLY_SEEN:
            found.append(Lid(int(row), value, seen, _hinges(fronts, int(row), hidden)))
    found.sort(key=lambda lid: -lid.value)
    # The rim below belongs to the body as often as to the lid, and moves without harm.
    near = [lid for lid in found if lid.value >= found[0].value - TIE]
    return sorted(
        found, key=lambda lid: (lid is not max(near, key=lambda one: one.row), -lid.value)
    )


def _told(covers: FloatArray) -> BoolArray:
    """Return the sides that count, shape [4]: all, or all but the one on which no seam is seen."""
    told = np.ones(len(covers), np.bool_)
    told[covers.argmin()] = covers.min() >= LEAST_SIDE
    return told


def _seen_above(front: Front, row: int) -> float:
    """Return the share above a row that the picture network takes for a lid, 0 to 1."""
    lid = front.sight.lid[row // SQUARE + 1 :]
    seen = front.relief.seen[::SQUARE, ::SQUARE][row // SQUARE + 1 :]
    return float(lid[seen].mean()) if seen.any() else 0.0


def _cover(relief: Relief, seams: Seams, evidence: FloatArray) -> FloatArray:
    """Return the share of each row's length with evidence, shape [rows]."""
    wide = ndimage.maximum_filter1d(evidence * seams.known, 2 * WANDER + 1, axis=0)
    inner = ndimage.binary_erosion(relief.seen, np.ones((1, 5), np.bool_))
    known = inner & (seams.known > 0.5)
    return np.asarray((wide * known).sum(axis=1) / np.maximum(known.sum(axis=1), 1))


def _widths(relief: Relief) -> FloatArray:
    """Return how far each row spans [pixels]."""
    seen = relief.seen
    any_seen = seen.any(axis=1)
    first = seen.argmax(axis=1)
    last = seen.shape[1] - 1 - seen[:, ::-1].argmax(axis=1)
    return np.where(any_seen, last - first + 1.0, 0.0)


def _value(
    fronts: Mapping[Side, Front],
    top: Relief,
    row: int,
    share: float,
    covers: FloatArray,
    shapes: FloatArray,
) -> float | None:
    """Return what speaks for a lid above a row; ``None`` if there can be none."""
    front = fronts[Side.FRONT].relief
    first, last, _, _ = front.box
    height = last - first
    # From above, heights are in pixels too, 0 at the highest point.
    above = last - row + np.where(top.seen, top.height, -np.inf) - float(top.height.max())
    over = top.seen & (above > -WANDER)
    if over.sum() < FOOTPRINT * top.seen.sum():
        return None
    hull = ndimage.binary_closing(np.pad(over, 12), np.ones((19, 19), np.bool_))[12:-12, 12:-12]
    hull = ndimage.binary_fill_holes(hull | over)
    if over.sum() < CLOSED * hull.sum():
        return None
    lid = np.clip(above[over], 0.0, None)
    fullness = float(lid.mean() / max(np.percentile(lid, 99), 1e-9))
    if share > 0.12 and fullness < POINTED:
        return None
    if not _has_body(fronts, row, height, first):
        return None
    value = 4.0 * (float(covers.mean()) - 0.75) + 1.5 * (float(covers.min()) - 0.5)
    value += float(shapes.mean())
    value += 0.5 if fullness < FLAT_TOP and share > 0.1 else 0.0
    value += 0.7 if _latched(fronts, row, height) else 0.0
    # A slab that lies on top is a table's or a cooker's more often than a lid.
    slab = share < SLAB and fullness >= FLAT_TOP
    value -= 1.0 if slab and not _latched(fronts, row, height) else 0.0
    value -= 1.5 if height < FLAT * max(front.shape[1], fronts[Side.RIGHT].relief.shape[1]) else 0.0
    value -= (
        2.0 if height > SLENDER * max(front.shape[1], fronts[Side.RIGHT].relief.shape[1]) else 0.0
    )
    return value


def _has_body(fronts: Mapping[Side, Front], row: int, height: int, first: int) -> bool:
    """Return whether there is something to close below the seam: no legs, no pole."""
    for side in (Side.FRONT, Side.RIGHT):
        relief = fronts[side].relief
        widths = _widths(relief)
        bottom = max(int(row - BODY_HEIGHT * height), first)
        if bottom >= row - 4:
            return False
        filled = relief.seen[bottom : row - 3].sum(axis=1)
        here = max(float(widths[row - 2 : row + 3].max()), 1.0)
        if filled.min() < BODY_WIDTH * here:
            return False
    return True


def _latched(fronts: Mapping[Side, Front], row: int, height: int) -> bool:
    return any(_at_seam(fronts[side], row, height, LATCH_WIDTH) for side in AROUND)


def _at_seam(front: Front, row: int, height: int, widest: float) -> list[tuple[float, float]]:
    """Return how central each handle at a seam is, 0 to 1, and on which half, -1 or 1.

    Args:
        front: the side.
        row: of the seam.
        height: of the object [pixels].
        widest: share of the side's width that it takes at most.
    """
    _, _, left, right = front.relief.box
    middle = (left + right) / 2.0
    half = max((right - left) / 2.0, 1.0)
    aside = [
        (float(handle.center[1]) - middle) / half
        for handle in front.face.handles
        if handle.high[0] >= row - LATCH_REACH * height and handle.size[1] <= 2.0 * widest * half
    ]
    return [(1.0 - abs(each), float(np.sign(each))) for each in aside]


def _latch(front: Front, row: int, height: int) -> float:
    """Return how central the most central latch of a side is, 0 to 1; 0 without one."""
    found = [central for central, _ in _at_seam(front, row, height, LATCH_WIDTH)]
    return max((each for each in found if each >= CENTRAL), default=0.0)


def _has_hinges(front: Front, row: int, height: int) -> bool:
    """Return whether something small sits at the seam towards both ends of a side."""
    found = _at_seam(front, row, height, HINGE_WIDTH)
    return {half for central, half in found if central < CENTRAL} == {-1.0, 1.0}


def _hinges(
    fronts: Mapping[Side, Front], row: int, hidden: Sequence[Side]
) -> tuple[tuple[Side, float], ...]:
    """Return where the hinge may be; ``hidden``: sides on which no seam is seen."""
    first, last, _, _ = fronts[Side.FRONT].relief.box
    height = last - first
    widths = {side: float(_widths(fronts[side].relief)[row - 2 : row + 3].max()) for side in AROUND}
    longest = max(widths.values())
    value = {}
    for side in AROUND:
        front = fronts[side]
        value[side] = USUAL_HINGE[side] + 3.0 * (widths[side] / longest - 1.0)
        value[side] += UNSEEN * (side in hidden) + HINGED * _has_hinges(front, row, height)
        value[side] += LATCHED * _latch(fronts[OPPOSITE[side]], row, height)
        value[side] -= LATCHED * _latch(front, row, height)
        value[side] += WHEELED * _foot(fronts, side, first, height)
    return tuple(sorted(value.items(), key=lambda each: -each[1]))


def _foot(fronts: Mapping[Side, Front], side: Side, first: int, height: int) -> float:
    """Return how far wheels reach out at the foot of a side, below a hinge, -1 to 1.

    A pedal reaches out on the other side: it has no ends beyond the middle.
    """
    reach = _reach(fronts, side, first, height)
    out = side if reach > 0.0 else OPPOSITE[side]
    return -reach if _has_pedal(fronts[out], first, height) else reach


def _reach(fronts: Mapping[Side, Front], side: Side, first: int, height: int) -> float:
    """Return how much further a foot reaches out to a side than to the opposite one, -1 to 1."""
    view = Side.FRONT if side in (Side.LEFT, Side.RIGHT) else Side.RIGHT
    relief = fronts[view].relief
    foot = np.flatnonzero(relief.seen[first : first + max(height // 8, 1)].any(axis=0))
    upper = np.flatnonzero(relief.seen[first + height // 4 : first + height // 2].any(axis=0))
    if not len(foot) or not len(upper):
        return 0.0
    reach_left = float(upper[0] - foot[0])
    reach_right = float(foot[-1] - upper[-1])
    offset = (reach_right - reach_left) / max(float(len(upper)), 1.0)
    to_right = side in (Side.RIGHT, Side.BACK)
    return float(np.clip(10.0 * (offset if to_right else -offset), -1.0, 1.0))


def _has_pedal(front: Front, first: int, height: int) -> bool:
    """Tell whether the nearest point at the foot of a side is in its middle."""
    relief = front.relief
    foot = np.where(relief.seen, relief.height, -np.inf)[first : first + max(height // 8, 1)]
    nearest = np.flatnonzero((foot > foot.max() - NEAREST).any(axis=0))
    _, _, left, right = relief.box
    middle = np.abs(nearest - (left + right) / 2.0) / max((right - left) / 2.0, 1.0)
    return bool(middle.max() < 1.0 - CENTRAL)
