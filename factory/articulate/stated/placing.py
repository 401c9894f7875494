"""A stated part on the mesh: the region that it fills, and how it may open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...articulation import JointKind
from ...errors import InputRejected
from ...intake.stated import Hinge, StatedPart, StatedView
from ...mesh import Mesh
from ...part import OpensBy, PartKind
from ...views.raster import Side
from ..geometric.rounds import FROM_ABOVE
from ..proposal import Motion
from ..seams.fronts import Front
from ..seams.placing import OpeningPart, box_behind, panel_mover
from ..seams.rectangles import Rectangle
from .boxed import EDGES, MOST_WAYS, NOT_FOUND, USUAL, StatedBox, boxed_in
from .controls import control_openings
from .hinging import level_edge, upright_edge
from .lids import hinged_inside, lid_openings
from .seen import SeenMesh
from .snapping import LEAST_OFF, OFF, StatedFrame, snap
from .tilting import tilted
from .wholes import find_outline, way_of

#: Boxes of two panels of one side may share so much of the smaller one.
MOST_SHARED = 0.25
#: From above the back is at the top of the picture.
_EDGES_ABOVE = {**EDGES, Hinge.BACK: OpensBy.TOP, Hinge.FRONT: OpensBy.BOTTOM}


def place_parts(seen: SeenMesh, parts: Sequence[StatedPart]) -> list[StatedBox]:
    """Return every stated part that has a box, with at least one way in which it may open.

    They are found on a mesh, where its front was stated to be.

    Raises:
        InputRejected: ``stated_part_not_found``: a box shows nothing, or two take the same place.
    """
    mesh = seen.mesh
    found: dict[int, StatedBox] = {}
    for above, turn in ((False, np.eye(3)), (True, FROM_ABOVE)):
        views = {
            place: part.view
            for place, part in enumerate(parts)
            if part.view is not None and (part.view.side is Side.TOP) is above
        }
        if views:
            fronts = seen.above if above else seen.around
            seams = [_boxed(seen, parts[place], place, view) for place, view in views.items()]
            outlines = [_outlined(seen, each) for each in seams]
            _refuse_shared(outlines)
            for cut, whole in zip(seams, outlines, strict=True):
                ways = [
                    way_of(seen, _as_stated(mover.turned(turn.T), whole, mesh), whole)
                    for mover in _all_openings(fronts, whole, outlines)
                ]
                if any(len(way.faces) for way in ways):
                    movers = _all_openings(fronts, cut, seams)
                    ways = [
                        replace(way, cut=_as_stated(mover.turned(turn.T), cut, mesh))
                        for way, mover in zip(ways, movers, strict=True)
                    ]
                found[cut.place] = replace(cut, ways=tuple(way.turned(seen.back) for way in ways))
    return [found[place] for place in sorted(found)]


def _all_openings(
    fronts: Mapping[Side, Front], part: StatedBox, boxed: Sequence[StatedBox]
) -> list[OpeningPart]:
    """Return the ways in which a part may open as stated, and then by its alternatives."""
    said = [part, *(replace(part, stated=other) for other in part.stated.others)]
    return [way for each in said for way in _openings(fronts, each, boxed)]


def _boxed(seen: SeenMesh, part: StatedPart, place: int, view: StatedView) -> StatedBox:
    """Return a part with the rectangle of seams that its box means."""
    front = seen.above[Side.FRONT] if view.side is Side.TOP else seen.around[view.side]
    frame = StatedFrame.of(seen.mesh, view.side)
    return boxed_in(front, part, place, snap(front, frame, view.box))


def _outlined(seen: SeenMesh, part: StatedBox) -> StatedBox:
    """Return a part in the outline of the piece that its box means; as it is if there is none."""
    front = part.front
    frame = StatedFrame.of(seen.mesh, part.view.side)
    raster = front.relief.raster
    # A piece that fits is meant, though somebody drew a little beside it.
    reach = 1.25 * np.maximum(OFF * frame.size, LEAST_OFF * raster.pixel)
    outline = find_outline(seen, part.view.side, frame.place(part.view.box), reach)
    if outline is None:
        return part
    low, high = np.rint((outline - raster.low) / raster.pixel).astype(np.int64)[:, ::-1]
    limit = np.array(front.relief.shape) - 1
    box = Rectangle(np.clip(low, 0, limit), np.clip(high, 0, limit), np.zeros(4))
    return boxed_in(front, part.stated, part.place, box)


def _refuse_shared(boxed: Sequence[StatedBox]) -> None:
    panels = [each for each in boxed if each.is_panel and each.stated.parent is None]
    for number, one in enumerate(panels):
        for other in panels[:number]:
            smaller = max(min(one.rectangle.area, other.rectangle.area), 1.0)
            share = one.rectangle.shared(other.rectangle) / smaller
            if one.front is other.front and share > MOST_SHARED:
                raise InputRejected(
                    NOT_FOUND,
                    f"{other.label} and {one.label}: share {100 * share:.0f} % of the smaller box, "
                    f"want at most {100 * MOST_SHARED:.0f} %; say parent if one carries the other",
                    value=share,
                    unit="of the smaller box",
                    limit=MOST_SHARED,
                )


def _openings(
    fronts: Mapping[Side, Front], part: StatedBox, boxed: Sequence[StatedBox]
) -> list[OpeningPart]:
    """Return the ways in which a part may open, the likeliest first, in the turned frame."""
    above = part.view.side is Side.TOP
    if part.kind in (PartKind.LID, PartKind.SCREEN) and not above:
        return lid_openings(fronts, part)
    if not part.is_panel:
        return control_openings(part)
    way = part.hinged(_EDGES_ABOVE if above else EDGES)
    wanted = _likeliest_first(part, boxed) if way is None else (way,)
    side = part.front.relief.side
    return [
        tilted(panel_mover(fronts, side, part.rectangle, way, part.kind), part)
        for way in wanted[:MOST_WAYS]
    ]


def _likeliest_first(part: StatedBox, boxed: Sequence[StatedBox]) -> tuple[OpensBy, ...]:
    """Return ways in which a panel may open, first the one that its handle speaks for."""
    if part.kind is PartKind.DOOR:
        beside = [each for each in boxed if each.is_panel and each.front is part.front]
        likely: OpensBy | None = upright_edge(part, beside)
    else:
        likely = level_edge(part)
    return tuple(sorted(USUAL[part.kind], key=lambda way: way is not likely))


def _as_stated(mover: OpeningPart, part: StatedBox, mesh: Mesh) -> OpeningPart:
    """Return a part with the limits and depth that were stated, in the mesh's frame."""
    for view in part.stated.also:
        bounds = box_behind(view.side, *StatedFrame.of(mesh, view.side).place(view.box))
        mover = replace(mover, region=mover.region.within(bounds))
    if mover.kind in (PartKind.LID, PartKind.SCREEN) and mover.panel is None:
        mover = hinged_inside(mover)
    if part.stated.range is None:
        return mover
    lower, upper = (each / stated_unit(mover.motion) for each in part.stated.range)
    return replace(mover, motion=replace(mover.motion, lower=lower, upper=upper))


def stated_unit(motion: Motion) -> float:
    """Return how many stated units, degrees or millimetres, are one of a joint's, rad or m."""
    return 1000.0 if motion.kind is JointKind.PRISMATIC else float(np.degrees(1.0))
