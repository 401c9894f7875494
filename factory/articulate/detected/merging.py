"""What the detector sees on single sides, as parts of one object."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...intake.stated import Box, Hinge, StatedKind, StatedPart
from ...mesh import FloatArray
from ...models.detector.canvas import CANVAS, LONGEST, WAYS, PanelWay, Sort, shares_of
from ...models.detector.decode import Found, shared_areas
from ...views.raster import Side, side_facing
from ..seams.fronts import OPPOSITE
from ..stated.boxed import USUAL

#: Sorts that close an upright side.
PANELS = (Sort.DOOR, Sort.FLAP, Sort.DRAWER)
#: Two hinges are both tried where the likelier is not this sure.
SURE_WAY = 0.8
#: Sides agree on where a lid is hinged if the sum of what they say is so long, as a share of all
#: that they say. Of 27 lids no labelled hinge lies elsewhere where they do, and where they do not
#: it is 0.23 at most.
AGREED = 0.4
#: Fronts mostly face -Y or +X, so that lids are mostly hinged across from there.
USUAL_HINGES = (Side.BACK, Side.LEFT, Side.FRONT, Side.RIGHT)
#: Panels higher than so many of their widths are doors: of 262 labelled drawers none is higher than
#: 1.11 of its own, of 306 doors most are.
TALL = 1.2
#: A panel of which this much is in a likelier one is no part of its own.
INSIDE = 0.5


@dataclass(frozen=True, eq=False)
class DetectedPart:
    """A part that the detector sees, on one side or on several.

    Attributes:
        stated: as a person would state it.
        found: where it is seen; of a lid on every side that shows it.
        probability: that it is there.
    """

    stated: StatedPart
    found: tuple[Found, ...]
    probability: float = 1.0


def seen_parts(found: Sequence[Found], extents: FloatArray) -> tuple[DetectedPart, ...]:
    """Return the parts that are seen, each once.

    Args:
        found: on all sides, those that are sure enough.
        extents: of the mesh along x, y and z, in any unit, shape [3].
    """
    sizes = extents / extents.max() * LONGEST
    panels = [each for each in _apart(found) if _shows(_box(each, sizes))]
    parts = [DetectedPart(_panel(each, sizes), (each,)) for each in panels]
    lids = tuple(each for each in found if each.sort is Sort.LID and _shows(_box(each, sizes)))
    if lids:
        parts.append(DetectedPart(_lid(lids, sizes), lids))
    return tuple(parts)


def _apart(found: Sequence[Found]) -> list[Found]:
    """Return the panels of upright sides that are not in one another, nor seen from behind."""
    kept: list[Found] = []
    panels = [each for each in found if each.sort in PANELS and each.side is not Side.TOP]
    # Of what both sides of a door show alike the side that is looked at first counts.
    for each in sorted(panels, key=lambda each: -round(each.score, 3)):
        twice = (each, _from_behind(each))
        if any(_share_inside(one, other) >= INSIDE for one in twice for other in kept):
            continue
        cut = each
        for other in kept:
            cut = _cut_short(cut, other)
        kept.append(cut)
    return kept


def _cut_short(one: Found, other: Found) -> Found:
    """Return a panel that ends where a surer one begins, along the axis that leaves most of it."""
    if _share_inside(one, other) <= 0.0:
        return one
    choices = []
    for axis in (0, 1):
        for end, edge in ((axis + 2, other.box[axis]), (axis, other.box[axis + 2])):
            box = one.box.copy()
            box[end] = np.clip(edge, box[axis], box[axis + 2])
            choices.append(replace(one, box=box))
    return max(choices, key=_area)


def _area(found: Found) -> float:
    return float(np.prod(found.box[2:] - found.box[:2]))


def _from_behind(found: Found) -> Found:
    """Return a panel as the opposite side shows it: both sides of a thing often look alike."""
    left, low, right, high = found.box
    mirrored = np.array([CANVAS - right, low, CANVAS - left, high])
    return replace(found, side=OPPOSITE[found.side], box=mirrored)


def _share_inside(one: Found, other: Found) -> float:
    """Return how much of the smaller of two boxes of a side is in the other."""
    if one.side is not other.side:
        return 0.0
    inner = float(shared_areas(one.box, other.box[None])[0])
    return inner / max(min(_area(one), _area(other)), 1.0)


def _panel(found: Found, sizes: FloatArray) -> StatedPart:
    width, height = found.box[2:] - found.box[:2]
    tall = found.sort is Sort.DRAWER and height > TALL * width
    kind = StatedKind.DOOR if tall else StatedKind(found.sort)
    hinge = None
    if kind is not StatedKind.DRAWER:
        ways = [PanelWay(way) for way in USUAL[kind.part]]
        chances = {way: float(found.ways[WAYS.index(way)]) for way in ways}
        likely = max(chances, key=chances.__getitem__)
        if chances[likely] >= SURE_WAY * sum(chances.values()):
            hinge = Hinge(likely)
    return StatedPart(kind, found.side, _box(found, sizes), hinge)


def _lid(lids: Sequence[Found], sizes: FloatArray) -> StatedPart:
    """Return the lid that several sides show: its row is that of the surest upright side.

    Where they contradict one another on its hinge, none is told.
    """
    told = _hinges_told(lids)
    direction = told.sum(axis=0)
    agreed = float(np.linalg.norm(direction)) > AGREED * float(np.abs(told).sum())
    hinge = Hinge(side_facing(direction)) if agreed else None
    upright = [each for each in lids if each.side is not Side.TOP]
    best = max(upright or lids, key=lambda each: each.score)
    return StatedPart(StatedKind.LID, best.side, _box(best, sizes), hinge)


def _hinges_told(lids: Sequence[Found]) -> FloatArray:
    """Return where each way of each side says that the hinge is, as long as it is sure, [n, 3]."""
    told: list[FloatArray] = []
    for each in lids:
        right, up, away = each.side.frame
        far = up if each.side is Side.TOP else away
        toward = {
            PanelWay.LEFT: -right,
            PanelWay.RIGHT: right,
            PanelWay.TOP: far,
            PanelWay.BOTTOM: -far,
        }
        told += [each.score * each.ways[WAYS.index(way)] * at for way, at in toward.items()]
    return np.array(told)


def likely_hinges(lids: Sequence[Found]) -> list[Side]:
    """Return the sides at which a lid may be hinged, those first on whose axis its sides agree."""
    weight = np.abs(_hinges_told(lids)).sum(axis=0)
    return sorted(USUAL_HINGES, key=lambda side: -float(weight @ np.abs(side.frame[2])))


def _shows(box: Box) -> bool:
    """Tell whether a box has any of a side's picture in it."""
    return box[0] < box[2] and box[1] < box[3]


def _box(found: Found, sizes: FloatArray) -> Box:
    extents = np.abs(found.side.frame[:2] @ sizes)
    left, low, right, high = np.clip(shares_of(found.box, extents), 0.0, 1.0)
    return float(left), float(low), float(right), float(high)
