"""Stated parts that close nothing: knobs, buttons, levers, wheels, caps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import JointKind
from ...geometry.posing import UP
from ...mesh import BoolArray, FloatArray
from ...part import OpensBy, PartKind
from ...views.raster import Side
from ..proposal import Motion
from ..seams.cutting import Region
from ..seams.fronts import thickness
from ..seams.knobs import MARGIN, knobs_on
from ..seams.placing import TURN, OpeningPart, box_before, box_behind, edge_middle
from .boxed import EDGES, StatedBox
from .snapping import AT_OUTLINE

#: How far a button is pressed [m].
BUTTON_TRAVEL_M = 0.004
#: Of what a box shows so much stands off from what carries it.
LEAST_STANDING = 0.1


def control_openings(part: StatedBox) -> list[OpeningPart]:
    """Return parts to turn or press, as :func:`_control` finds them; a lever one way or the other.

    Raises:
        InputRejected: ``stated_part_not_found``: no lever is hinged so.
    """
    found = _control(part)
    if found.kind is not PartKind.LEVER:
        return [found]
    back = replace(found, motion=replace(found.motion, axis=-found.motion.axis))
    return [found, back]


def _control(part: StatedBox) -> OpeningPart:
    """Return the knob that is seen in a box, or all that stands off.

    A wheel turns about the middle of its protrusion, a lever about the edge where it is hinged, a
    cap that is seen from beside about the upright.
    """
    kind = part.kind
    if kind is PartKind.CAP and part.view.side is not Side.TOP:
        return _cap(part)
    relief = part.front.relief
    raster = relief.raster
    box = part.rectangle
    if kind is PartKind.KNOB:
        for knob in knobs_on(relief, part.front.face):
            if box.holds(raster.pixels(knob.motion.origin)[:2]):
                return knob
    right, up, away = raster.side.frame
    carrier, standing = _standing(part)
    back = raster.near - (carrier + MARGIN) * raster.pixel
    low, high = part.corners
    low = low - MARGIN * raster.pixel
    high = high + MARGIN * raster.pixel
    way = part.hinged(EDGES, "for a lever") if kind is PartKind.LEVER else None
    across, height = edge_middle(low, high, way or OpensBy.OUT)
    if kind is PartKind.WHEEL and standing.any():
        rows, columns = np.nonzero(standing)
        across = low[0] + (columns.mean() + MARGIN) * raster.pixel
        height = low[1] + (rows.mean() + MARGIN) * raster.pixel
    origin = across * right + height * up + back * away
    # What is drawn to the outline has its thinnest ends too.
    ends = np.array(part.view.box).reshape(2, 2)
    low = np.where(ends[0] <= AT_OUTLINE, -np.inf, low)
    high = np.where(ends[1] >= 1.0 - AT_OUTLINE, np.inf, high)
    if _depth_is_bounded(part):
        region = box_behind(raster.side, low, high)
    else:
        region = box_before(raster.side, low, high, back)
    return OpeningPart(kind, region, _motion(kind, away, origin))


def _motion(kind: PartKind, away: FloatArray, origin: FloatArray) -> Motion:
    if kind is PartKind.BUTTON:
        return Motion(JointKind.PRISMATIC, away, origin, 0.0, BUTTON_TRAVEL_M)
    if kind is PartKind.LEVER:
        return Motion(JointKind.REVOLUTE, away, origin, 0.0, TURN)
    return Motion.endless(away, origin)


def _depth_is_bounded(part: StatedBox) -> bool:
    """Tell whether another side's box says how deep a part is."""
    away = part.front.relief.raster.side.frame[2]
    shown = [abs(view.side.frame[:2] @ away).max() for view in part.stated.also]
    return part.view.side is not Side.TOP and max(shown, default=0.0) > 0.5


def _standing(part: StatedBox) -> tuple[float, BoolArray]:
    """Return how high what carries a part is [pixels], and which pixels of its box stand off.

    A wheel or a lever may hide most of what carries it: that is then the deeper one of two groups
    of depths, or, where there is one depth only, whatever is behind the part's own thickness.
    """
    slices = part.rectangle.window
    seen = part.front.relief.seen[slices]
    height = part.front.relief.height[slices]
    carrier = float(np.median(part.front.face.height[slices]))
    if part.kind in (PartKind.WHEEL, PartKind.LEVER):
        deeper = height[seen & (height <= _parting(height[seen]))]
        carrier = float(np.percentile(deeper, 95))
    if float((height[seen] > carrier + MARGIN).mean()) < LEAST_STANDING:
        own = thickness(part.front.relief, part.front.behind)[slices][seen]
        carrier = float(np.median(height[seen])) - float(np.percentile(own, 25))
    return carrier, seen & (height > carrier + MARGIN)


def _parting(values: FloatArray) -> float:
    """Return the value that parts values into the two groups that differ most (Otsu's)."""
    ordered = np.sort(values)
    count = np.arange(1, len(ordered))
    total = np.cumsum(ordered)
    below = total[:-1] / count
    above = (total[-1] - total[:-1]) / (len(ordered) - count)
    spread = count * (len(ordered) - count) * (above - below) ** 2
    return float(ordered[int(spread.argmax())]) if len(spread) else float(ordered[0])


def _cap(part: StatedBox) -> OpeningPart:
    """Return all that is above the lower edge of a cap's box, turning about its middle."""
    raster = part.front.relief.raster
    right, up, away = raster.side.frame
    low, high = part.corners
    middle = (low[0] + high[0]) / 2.0
    nearest = float(part.front.face.height[part.rectangle.window].max())
    depth = raster.near + (high[0] - low[0]) / 2.0 - nearest * raster.pixel
    region = Region(np.stack([-up, right, -right]), np.array([-low[1], high[0], -low[0]]))
    origin = middle * right + low[1] * up + depth * away
    return OpeningPart(part.kind, region, Motion.endless(UP, origin))
