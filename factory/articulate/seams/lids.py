"""Lids: a seam that runs around all four sides at one height, over something closed on top."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...geometry.crossings import Side
from ...mesh import FloatArray
from .evidence import Seams
from .fronts import AROUND, OPPOSITE, Front
from .learned import load_judge
from .relief import Relief

#: A lid's height, as a share of the object's: from a flat one to a chest's.
HEIGHT = (0.03, 0.6)
#: The seam's cover on the worst side, and on average.
LEAST_SIDE = 0.15
LEAST_MEAN = 0.45
#: Rows looked at, the best covered first.
MOST = 12
#: Below the seam is a body to so much of the height.
BODY_HEIGHT = 0.5
#: Of seams that differ by less in value the upper one is taken.
TIE = 0.5
#: How far the seam may wander up and down [pixels].
WANDER = 3
#: A latch or a handle lies within this share of the height of the seam, or above it.
LATCH_REACH = 0.1
#: Fronts mostly face -Y or +X, so that lids are mostly hinged across from there.
USUAL_HINGE = {Side.BACK: 0.3, Side.LEFT: 0.2, Side.FRONT: 0.0, Side.RIGHT: 0.0}

NAMES = (
    *(f"cover_{index}" for index in range(4)),
    *(f"shape_{index}" for index in range(4)),
    *("rank", "share", "over", "closed", "full", "uneven"),
    *("body_least", "body", "wider", "latch", "latches"),
    *("tall", "square", "filled", "pulls", "controls"),
)


@dataclass(frozen=True, eq=False)
class Lid:
    """A lid and where it may be hinged.

    Attributes:
        row: of the seam in the pictures of the four sides; the same in all.
        value: log-odds that it opens.
        hinges: sides where its hinge may be, likeliest first, with what speaks for each.
    """

    row: int
    value: float
    hinges: tuple[tuple[Side, float], ...]


def find_lids(fronts: Mapping[Side, Front], top: Relief) -> list[Lid]:
    """What may be a lid, the likeliest first.

    Args:
        fronts: the four sides.
        top: the view from above.
    """
    found = [
        Lid(candidate.row, float(value), _hinges(fronts, candidate.row))
        for candidate, value in _rated(lid_candidates(fronts, top))
    ]
    found.sort(key=lambda lid: -lid.value)
    if not found:
        return []
    # The rim below belongs to the body as often as to the lid, and moves without harm.
    near = [lid for lid in found if lid.value >= found[0].value - TIE]
    return sorted(
        found, key=lambda lid: (lid is not max(near, key=lambda one: one.row), -lid.value)
    )


@dataclass(frozen=True, eq=False)
class LidCandidate:
    """A row at which a lid may begin.

    Attributes:
        row: in the pictures of the four sides.
        features: about it, as :data:`NAMES` has them.
    """

    row: int
    features: FloatArray


def lid_candidates(fronts: Mapping[Side, Front], top: Relief) -> list[LidCandidate]:
    """Rows with a seam on all four sides, the best covered first."""
    sides = [fronts[side] for side in AROUND]
    covers = np.stack([_cover(each.relief, each.level, each.level.all) for each in sides])
    shapes = np.stack([_cover(each.relief, each.level, each.level.relief) for each in sides])
    first, last, _, _ = sides[0].relief.box
    strength = covers.mean(axis=0) + 0.5 * shapes.mean(axis=0)
    found: list[LidCandidate] = []
    for row in np.argsort(-strength, kind="stable").tolist():
        share = (last - row) / max(last - first, 1)
        good = covers[:, row].min() >= LEAST_SIDE and covers[:, row].mean() >= LEAST_MEAN
        if not (good and HEIGHT[0] <= share <= HEIGHT[1]) or row >= len(strength) - 2:
            continue
        if any(abs(other.row - row) <= 2 * WANDER for other in found):
            continue
        seam = [*np.sort(covers[:, row]), *np.sort(shapes[:, row])]
        rank = float(strength[row] / max(float(strength.max()), 1e-9))
        about = [*seam, rank, share, *_above(fronts, top, row), *_below(fronts, row)]
        found.append(LidCandidate(row, np.array([*about, *_object(fronts)])))
        if len(found) >= MOST:
            break
    return found


def _rated(candidates: list[LidCandidate]) -> list[tuple[LidCandidate, float]]:
    if not candidates:
        return []
    rows = np.stack([each.features for each in candidates])
    values = load_judge("lid", NAMES).logits(rows)[:, 0]
    return list(zip(candidates, values.tolist(), strict=True))


def _cover(relief: Relief, seams: Seams, evidence: FloatArray) -> FloatArray:
    """Share of each row's length with evidence, shape [rows]."""
    wide = ndimage.maximum_filter1d(evidence * seams.known, 2 * WANDER + 1, axis=0)
    inner = ndimage.binary_erosion(relief.seen, np.ones((1, 5), np.bool_))
    known = inner & (seams.known > 0.5)
    return np.asarray((wide * known).sum(axis=1) / np.maximum(known.sum(axis=1), 1))


def _widths(relief: Relief) -> FloatArray:
    """How far each row spans [pixels]."""
    seen = relief.seen
    any_seen = seen.any(axis=1)
    first = seen.argmax(axis=1)
    last = seen.shape[1] - 1 - seen[:, ::-1].argmax(axis=1)
    return np.where(any_seen, last - first + 1.0, 0.0)


def _above(fronts: Mapping[Side, Front], top: Relief, row: int) -> list[float]:
    """How much of the object's footprint lies above a row, and of what shape it is there."""
    front = fronts[Side.FRONT].relief
    _, last, _, _ = front.box
    # From above, heights are in pixels too, 0 at the highest point.
    above = last - row + np.where(top.seen, top.height, -np.inf) - float(top.height.max())
    over = top.seen & (above > -WANDER)
    if not over.any():
        return [0.0] * 4
    hull = ndimage.binary_closing(np.pad(over, 12), np.ones((19, 19), np.bool_))[12:-12, 12:-12]
    hull = ndimage.binary_fill_holes(hull | over)
    lid = np.clip(above[over], 0.0, None)
    highest = max(float(np.percentile(lid, 99)), 1e-9)
    uneven = float(np.subtract(*np.percentile(lid, [90, 10])))
    return [
        float(over.sum() / max(int(top.seen.sum()), 1)),
        float(over.sum() / max(int(hull.sum()), 1)),
        float(lid.mean()) / highest,
        min(uneven / max(last - row, 1), 1.0),
    ]


def _below(fronts: Mapping[Side, Front], row: int) -> list[float]:
    """Whether there is something to close below a row, and latches at it."""
    first, last, _, _ = fronts[Side.FRONT].relief.box
    height = last - first
    filled = []
    wider = []
    for side in (Side.FRONT, Side.RIGHT):
        relief = fronts[side].relief
        bottom = max(int(row - BODY_HEIGHT * height), first)
        here = max(float(_widths(relief)[row - 2 : row + 3].max()), 1.0)
        body = relief.seen[bottom : max(row - 3, bottom + 1)].sum(axis=1) / here
        rim = relief.seen[row + 3 : row + 9].sum(axis=1)
        filled.append(min(float(body.min()), 1.5))
        wider.append(float(rim.max(initial=0)) / here - float(np.percentile(body, 90)))
    latches = [max([*_latches(fronts[side], row, height), 0.0]) for side in AROUND]
    return [
        min(filled),
        max(filled),
        float(np.clip(np.mean(wider), -0.3, 0.3)),
        max(latches),
        max(float(np.mean(np.sort(latches)[:3])), 0.0),
    ]


def _object(fronts: Mapping[Side, Front]) -> list[float]:
    """The shape of the object, and how many handles and controls its sides have."""
    front = fronts[Side.FRONT].relief
    first, last, left, right = front.box
    _, _, near, far = fronts[Side.RIGHT].relief.box
    width = max(right - left, 1)
    depth = max(far - near, 1)
    pulls = max(len(fronts[side].face.pulls) for side in AROUND)
    controls = max(sum(h.control for h in fronts[side].face.handles) for side in AROUND)
    return [
        float(np.log(max(last - first, 1) / max(width, depth))),
        float(np.log(min(width, depth) / max(width, depth))),
        float(front.seen.sum()) / (width * max(last - first, 1)),
        min(pulls, 6) / 6.0,
        min(controls, 6) / 6.0,
    ]


def _latches(front: Front, row: int, height: int) -> list[float]:
    """How central each handle is that lies at a seam or above it, 0 to 1."""
    _, _, left, right = front.relief.box
    middle = (left + right) / 2.0
    half = max((right - left) / 2.0, 1.0)
    return [
        1.0 - abs(handle.center[1] - middle) / half
        for handle in front.face.handles
        if handle.high[0] >= row - LATCH_REACH * height
    ]


def _hinges(fronts: Mapping[Side, Front], row: int) -> tuple[tuple[Side, float], ...]:
    first, last, _, _ = fronts[Side.FRONT].relief.box
    height = last - first
    widths = {side: float(_widths(fronts[side].relief)[row - 2 : row + 3].max()) for side in AROUND}
    longest = max(widths.values())
    value = {}
    for side in AROUND:
        across = _latches(fronts[OPPOSITE[side]], row, height)
        here = _latches(fronts[side], row, height)
        value[side] = USUAL_HINGE[side] + 3.0 * (widths[side] / longest - 1.0)
        value[side] += 1.2 * max([*across, 0.0]) - 1.2 * max([*here, 0.0])
        value[side] += _foot(fronts, side, first, height)
    return tuple(sorted(value.items(), key=lambda each: -each[1]))


def _foot(fronts: Mapping[Side, Front], side: Side, first: int, height: int) -> float:
    """Wheels lie below the hinge: how far the foot reaches out to a side, -1 to 1."""
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
