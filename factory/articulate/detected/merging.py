"""What the detector sees on single sides, as parts of one object."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.crossings import Side, side_facing
from ...intake.stated import Hinge, StatedKind, StatedPart
from ...mesh import FloatArray
from ...models.detector.canvas import CANVAS, LONGEST, WAYS, PanelWay, Sort, shares_of
from ...models.detector.decode import Found
from ..seams.fronts import OPPOSITE

#: Sorts that close an upright side, and what they are called.
_PANELS = {
    Sort.DOOR: (StatedKind.DOOR, (PanelWay.LEFT, PanelWay.RIGHT)),
    Sort.FLAP: (StatedKind.FLAP, (PanelWay.BOTTOM, PanelWay.TOP)),
    Sort.DRAWER: (StatedKind.DRAWER, (PanelWay.OUT,)),
}
_EDGES = {
    PanelWay.LEFT: Hinge.LEFT,
    PanelWay.RIGHT: Hinge.RIGHT,
    PanelWay.BOTTOM: Hinge.BOTTOM,
    PanelWay.TOP: Hinge.TOP,
}
_HINGE_SIDES = {
    Side.FRONT: Hinge.FRONT,
    Side.BACK: Hinge.BACK,
    Side.LEFT: Hinge.LEFT,
    Side.RIGHT: Hinge.RIGHT,
}
#: Two hinges are both tried where the likelier is not this sure.
SURE_WAY = 0.8
#: A panel of which this much is in a likelier one is no part of its own.
INSIDE = 0.5


@dataclass(frozen=True, eq=False)
class SeenPart:
    """A part that the detector sees, on one side or on several.

    Attributes:
        stated: as a person would state it.
        found: where it is seen; of a lid on every side that shows it.
        probability: that it is there.
    """

    stated: StatedPart
    found: tuple[Found, ...]
    probability: float = 1.0


def seen_parts(found: Sequence[Found], extents: FloatArray) -> tuple[SeenPart, ...]:
    """Return the parts that are seen, each once.

    Args:
        found: on all sides, those that are sure enough.
        extents: of the mesh along x, y and z, in any unit, shape [3].
    """
    sizes = extents / extents.max() * LONGEST
    parts = [SeenPart(_panel(each, sizes), (each,)) for each in _apart(found)]
    lids = tuple(each for each in found if each.sort is Sort.LID)
    if lids:
        parts.append(SeenPart(_lid(lids, sizes), lids))
    return tuple(parts)


def _apart(found: Sequence[Found]) -> list[Found]:
    """Return the panels of upright sides that are not in one another, nor seen from behind."""
    kept: list[Found] = []
    panels = [each for each in found if each.sort in _PANELS and each.side is not Side.TOP]
    for each in sorted(panels, key=lambda each: -each.score):
        behind = _from_behind(each)
        if all(max(_share_inside(each, k), _share_inside(behind, k)) < INSIDE for k in kept):
            kept.append(each)
    return kept


def _from_behind(found: Found) -> Found:
    """Return a panel as the opposite side shows it: both sides of a thing often look alike."""
    left, low, right, high = found.box
    mirrored = np.array([CANVAS - right, low, CANVAS - left, high])
    return replace(found, side=OPPOSITE[found.side], box=mirrored)


def _share_inside(one: Found, other: Found) -> float:
    """Return how much of the smaller of two boxes of a side is in the other."""
    if one.side is not other.side:
        return 0.0
    low = np.maximum(one.box[:2], other.box[:2])
    high = np.minimum(one.box[2:], other.box[2:])
    inner = float(np.prod(np.maximum(high - low, 0.0)))
    areas = [float(np.prod(each.box[2:] - each.box[:2])) for each in (one, other)]
    return inner / max(min(areas), 1.0)


def _panel(found: Found, sizes: FloatArray) -> StatedPart:
    kind, allowed = _PANELS[found.sort]
    hinge = None
    if found.sort is not Sort.DRAWER:
        chances = {way: float(found.ways[WAYS.index(way)]) for way in allowed}
        likely = max(chances, key=chances.__getitem__)
        if chances[likely] >= SURE_WAY * sum(chances.values()):
            hinge = _EDGES[likely]
    return StatedPart(kind, found.side, _box(found, sizes), hinge)


def _lid(lids: Sequence[Found], sizes: FloatArray) -> StatedPart:
    """Return the lid that several sides show: its row is that of the surest upright side."""
    direction = np.zeros(3)
    for each in lids:
        right, up, away = each.side.frame
        far = up if each.side is Side.TOP else away
        toward = {
            PanelWay.LEFT: -right,
            PanelWay.RIGHT: right,
            PanelWay.TOP: far,
            PanelWay.BOTTOM: -far,
        }
        for way, where in toward.items():
            direction += each.score * float(each.ways[WAYS.index(way)]) * where
    hinge_side = side_facing(direction) if float(np.linalg.norm(direction)) > 0.0 else Side.BACK
    hinge = _HINGE_SIDES.get(hinge_side, Hinge.BACK)
    upright = [each for each in lids if each.side is not Side.TOP]
    if not upright:
        above = max(lids, key=lambda each: each.score)
        return StatedPart(StatedKind.LID, above.side, _box(above, sizes), hinge)
    best = max(upright, key=lambda each: each.score)
    return StatedPart(StatedKind.LID, best.side, _box(best, sizes), hinge)


def _box(found: Found, sizes: FloatArray) -> tuple[float, float, float, float]:
    extents = np.abs(found.side.frame[:2] @ sizes)
    left, low, right, high = np.clip(shares_of(found.box, extents), 0.0, 1.0)
    return float(left), float(low), float(right), float(high)
