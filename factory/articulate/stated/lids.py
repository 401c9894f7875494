"""Stated lids: what of the mesh is above a box's lower edge, and where it is hinged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...articulation import JointKind
from ...intake.stated import Hinge
from ...mesh import FloatArray
from ...views.raster import Side
from ..proposal import Motion
from ..seams.cutting import Region
from ..seams.fronts import AROUND, OPPOSITE, Front
from ..seams.placing import TURN, OpeningPart
from .boxed import MOST_WAYS, StatedBox
from .snapping import OFF

#: Rows above a lid's seam that show where the lid begins [pixels].
BESIDE = 8
#: Sides of the object at which a lid may be hinged.
HINGE_SIDES = {Hinge(side): side for side in OPPOSITE}


def lid_openings(fronts: Mapping[Side, Front], part: StatedBox) -> list[OpeningPart]:
    """Return the mesh above the lower edge of a lid's box, hinged as stated or across from there.

    Faces beside its box, or above it, by more than a drawn edge may be off are left out: there may
    be a second lid.

    Raises:
        InputRejected: ``stated_part_not_found``: no lid is hinged so.
    """
    hinge = part.hinged(HINGE_SIDES, "for a lid")
    side = part.front.relief.side
    others = [each for each in AROUND if each not in (side, OPPOSITE[side])]
    likely = [OPPOSITE[side], *others] if hinge is None else [hinge]
    bounds = _bounds(part)
    return [_opening(fronts, part, each, bounds) for each in likely[:MOST_WAYS]]


def _opening(
    fronts: Mapping[Side, Front], part: StatedBox, hinge: Side, bounds: Region
) -> OpeningPart:
    """Return a lid between its bounds, hinged on one side where it ends there.

    One that stands open turns where its inner face begins, seen from across.
    """
    front = fronts[hinge]
    raster = front.relief.raster
    right, up, _ = raster.side.frame
    row = int(part.rectangle.low[0])
    height = raster.low[1] + row * raster.pixel
    left, last = front.relief.box[:, 1]
    across = raster.low[0] + (left + last) / 2.0 * raster.pixel
    end = _end(front if part.stated.drawn is None else fronts[OPPOSITE[hinge]], row, bounds)
    return OpeningPart(
        kind=part.kind,
        region=Region(-up[None, :], np.array([-height])).within(bounds),
        motion=Motion(JointKind.REVOLUTE, right, across * right + height * up + end, 0.0, TURN),
    )


def _bounds(part: StatedBox) -> Region:
    """Return the edges of a lid's box beyond which there is more of the mesh above its seam."""
    relief = part.front.relief
    raster = relief.raster
    low = part.rectangle.low
    high = part.rectangle.high
    off_rows, off_columns = OFF * (relief.box[1] - relief.box[0])
    above = relief.seen[low[0] + 1 :]
    right, up, _ = raster.side.frame
    planes = []
    if above[:, : max(int(low[1] - off_columns), 0)].any():
        planes.append((-right, -raster.low[0] - low[1] * raster.pixel))
    if above[:, int(high[1] + off_columns) + 1 :].any():
        planes.append((right, raster.low[0] + high[1] * raster.pixel))
    if relief.seen[int(high[0] + off_rows) + 1 :, low[1] : high[1] + 1].any():
        planes.append((up, raster.low[1] + high[0] * raster.pixel))
    normals = np.array([normal for normal, _ in planes]).reshape(-1, 3)
    return Region(normals, np.array([float(offset) for _, offset in planes]))


def _end(front: Front, row: int, bounds: Region) -> FloatArray:
    """Return how far away a lid above a row begins, between its bounds [m], shape [3]."""
    raster = front.relief.raster
    right, _, away = raster.side.frame
    rows = slice(row + 1, row + BESIDE)
    shown = front.relief.seen[rows].copy()
    for normal, offset in zip(bounds.normals, bounds.offsets, strict=True):
        shown &= (float(normal @ right) * raster.right <= offset) | (abs(normal @ right) < 0.5)
    depth = -front.face.height[rows][shown]
    near = float(np.percentile(depth, 25)) * raster.pixel if len(depth) else 0.0
    return np.asarray((raster.near + near) * away)


def hinged_inside(mover: OpeningPart) -> OpeningPart:
    """Return a part whose hinge is not beyond what it fills, as bounds from other sides have it."""
    origin = mover.motion.origin
    for normal, offset in zip(mover.region.normals, mover.region.offsets, strict=True):
        origin = origin - max(float(origin @ normal) - float(offset), 0.0) * normal
    return replace(mover, motion=replace(mover.motion, origin=origin))
