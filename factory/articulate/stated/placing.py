"""A stated part on the mesh: the region that it fills, and how it may open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...articulation import JointKind, rotation_about
from ...errors import InputRejected
from ...geometry.crossings import Side
from ...intake.stated import Hinge, StatedPart, StatedView
from ...mesh import FloatArray, Mesh
from ...part import OpensBy, PartKind
from ..proposal import Motion
from ..seams.cutting import Region
from ..seams.fronts import AROUND, OPPOSITE, Front, fronts_of
from ..seams.groups import FrontPanel
from ..seams.knobs import knobs_on
from ..seams.lids import Lid
from ..seams.motions import openings_of
from ..seams.placing import OpeningPart, box_before, lid_mover, panel_mover
from ..seams.rectangles import Rectangle
from ..seams.relief import reliefs_of
from .snapping import StatedFrame, snap

NOT_FOUND = "stated_part_not_found"
#: Of a stated box so much must show the mesh.
LEAST_SHOWN = 0.3
#: Boxes of two panels of one side may share so much of the smaller one.
MOST_SHARED = 0.25
#: Ways to open that are tried for one part.
MOST_WAYS = 2
#: Rows below a lid's seam that show where the body ends [pixels].
BELOW = 8
#: How far a button is pressed [m].
BUTTON_TRAVEL_M = 0.004
MM = 1000.0

#: How a panel of a kind opens where nobody says; these kinds are panels.
USUAL = {
    PartKind.DOOR: (OpensBy.LEFT, OpensBy.RIGHT),
    PartKind.FLAP: (OpensBy.BOTTOM, OpensBy.TOP),
    PartKind.DRAWER: (OpensBy.OUT,),
    PartKind.LID: (OpensBy.TOP, OpensBy.BOTTOM, OpensBy.LEFT, OpensBy.RIGHT),
}
_WAYS = {
    Hinge.LEFT: OpensBy.LEFT,
    Hinge.RIGHT: OpensBy.RIGHT,
    Hinge.TOP: OpensBy.TOP,
    Hinge.BOTTOM: OpensBy.BOTTOM,
}
#: From above the back is at the top of the picture.
_WAYS_ABOVE = {**_WAYS, Hinge.BACK: OpensBy.TOP, Hinge.FRONT: OpensBy.BOTTOM}
_HINGE_SIDES = {
    Hinge.FRONT: Side.FRONT,
    Hinge.BACK: Side.BACK,
    Hinge.LEFT: Side.LEFT,
    Hinge.RIGHT: Side.RIGHT,
}
#: Turns the top of an object to where its front is.
FROM_ABOVE: FloatArray = rotation_about([1.0, 0.0, 0.0], np.pi / 2.0)


@dataclass(frozen=True, eq=False)
class SeenMesh:
    """A mesh with its sides, to be kept by who changes the boxes on them.

    Attributes:
        mesh: whose front is -Y.
    """

    mesh: Mesh

    @cached_property
    def around(self) -> dict[Side, Front]:
        """Return its upright sides."""
        return fronts_of(reliefs_of(self.mesh))

    @cached_property
    def above(self) -> dict[Side, Front]:
        """Return the sides of the mesh turned so that its top is its front."""
        return fronts_of(reliefs_of(self.mesh.turned(FROM_ABOVE)))

    def look(self) -> SeenMesh:
        """Look at its upright sides now; returns itself."""
        for front in self.around.values():
            _ = front.scene
        return self


@dataclass(frozen=True, eq=False)
class Placed:
    """A stated part that was found.

    Attributes:
        stated: as somebody said it.
        ways: in which it may open, the likeliest first; at least one.
    """

    stated: StatedPart
    ways: tuple[OpeningPart, ...]


@dataclass(frozen=True, eq=False)
class _Boxed:
    """A stated part and the rectangle of seams that its box means.

    Attributes:
        stated: as somebody said it.
        place: in the list of parts.
        front: the side of the turned mesh that shows it.
        panel: its rectangle and handles there.
    """

    stated: StatedPart
    place: int
    front: Front
    panel: FrontPanel

    @property
    def is_panel(self) -> bool:
        """Tell whether it closes an opening."""
        return self.stated.kind in USUAL

    @property
    def label(self) -> str:
        """Return how messages call it."""
        return f"parts[{self.place}] ({self.stated.name or self.stated.kind})"


def place_parts(seen: SeenMesh, parts: Sequence[StatedPart]) -> list[Placed]:
    """Return every stated part that has a box, found on a mesh.

    Raises:
        InputRejected: ``stated_part_not_found``: a box shows nothing, or two take the same place.
    """
    found: dict[int, Placed] = {}
    for above, turn in ((False, np.eye(3)), (True, FROM_ABOVE)):
        views = {
            place: part.view
            for place, part in enumerate(parts)
            if part.view is not None and (part.view.side is Side.TOP) is above
        }
        if views:
            turned = seen.mesh.turned(turn)
            fronts = seen.above if above else seen.around
            boxed = [
                _boxed(turned, fronts, parts[place], place, view) for place, view in views.items()
            ]
            _refuse_shared(boxed)
            for each in boxed:
                ways = [way.turned(turn.T) for way in _openings(fronts, each, boxed)]
                stated = tuple(_as_stated(way, each.stated, seen.mesh) for way in ways)
                found[each.place] = Placed(each.stated, stated)
    return [found[place] for place in sorted(found)]


def _boxed(
    mesh: Mesh, fronts: Mapping[Side, Front], part: StatedPart, place: int, view: StatedView
) -> _Boxed:
    side = Side.FRONT if view.side is Side.TOP else view.side
    front = fronts[side]
    box = snap(front, StatedFrame.of(mesh, side), view.box)
    rows, columns = _slices(box)
    shown = front.relief.seen[rows, columns]
    share = float(shown.mean()) if shown.size else 0.0
    found = _Boxed(part, place, front, FrontPanel(box, front.scene.handles_in(box), 1.0))
    if share < LEAST_SHOWN:
        raise InputRejected(
            NOT_FOUND,
            f"{found.label}: its box on the {view.side} shows the mesh on {100 * share:.0f} % of "
            f"its area, want {100 * LEAST_SHOWN:.0f} %; boxes are [left, lower, right, upper] in "
            "shares of that side's picture",
            value=share,
            unit="of its area",
            limit=LEAST_SHOWN,
        )
    return found


def _refuse_shared(boxed: Sequence[_Boxed]) -> None:
    panels = [each for each in boxed if each.is_panel and each.stated.parent is None]
    for number, one in enumerate(panels):
        for other in panels[:number]:
            smaller = max(min(one.panel.rectangle.area, other.panel.rectangle.area), 1.0)
            share = one.panel.rectangle.shared(other.panel.rectangle) / smaller
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
    fronts: Mapping[Side, Front], part: _Boxed, boxed: Sequence[_Boxed]
) -> list[OpeningPart]:
    """Return the ways in which a part may open, the likeliest first, in the turned frame."""
    side = part.front.relief.side
    view = part.stated.view
    above = view is not None and view.side is Side.TOP
    if part.stated.kind is PartKind.LID and not above:
        return _lid_openings(fronts, side, part)
    if not part.is_panel:
        return [_control(part)]
    wanted = _wanted_ways(part, _WAYS_ABOVE if above else _WAYS)
    if len(wanted) > 1:
        beside = [each.panel for each in boxed if each.is_panel and each.front is part.front]
        openings = openings_of(part.front.scene, beside, part.front.sight)
        (own,) = (each for each in openings if each.panel is part.panel)
        likely = [way for way, _ in own.ways if way in wanted]
        wanted = (*likely, *(way for way in wanted if way not in likely))
    return [panel_mover(fronts, side, part.panel, way, 1.0, 1.0) for way in wanted[:MOST_WAYS]]


def _wanted_ways(part: _Boxed, ways: Mapping[Hinge, OpensBy]) -> tuple[OpensBy, ...]:
    hinge = part.stated.hinge
    if hinge is None:
        return USUAL[part.stated.kind]
    if hinge not in ways:
        edges = ", ".join(ways)
        raise InputRejected(
            NOT_FOUND, f"{part.label}: is hinged at its {hinge}, want one of {edges} there"
        )
    return (ways[hinge],)


def _lid_openings(fronts: Mapping[Side, Front], side: Side, part: _Boxed) -> list[OpeningPart]:
    """Return a lid above the lower edge of its box, hinged as stated or across from that side."""
    hinge = part.stated.hinge
    if hinge is not None and hinge not in _HINGE_SIDES:
        edges = ", ".join(_HINGE_SIDES)
        raise InputRejected(
            NOT_FOUND, f"{part.label}: is hinged at its {hinge}, want one of {edges} for a lid"
        )
    others = [each for each in AROUND if each not in (side, OPPOSITE[side])]
    likely = [OPPOSITE[side], *others] if hinge is None else [_HINGE_SIDES[hinge]]
    row = int(part.panel.rectangle.low[0])
    lid = Lid(row, 1.0, 1.0, tuple((each, 1.0) for each in likely))
    found = [(each, lid_mover(fronts, lid, each, 1.0, 1.0)) for each in likely[:MOST_WAYS]]
    if part.stated.drawn is None:
        return [mover for _, mover in found]
    return [_hung_on_body(fronts[each], mover, row) for each, mover in found]


def _hung_on_body(front: Front, mover: OpeningPart, row: int) -> OpeningPart:
    """Return a lid hinged where the body ends: one that stands open may lean out beyond it."""
    rows = slice(max(row - BELOW, 0), row)
    depth = -front.face.height[rows][front.relief.seen[rows]]
    if not len(depth):
        return mover
    raster = front.relief.raster
    away = raster.side.frame[2]
    at = raster.near + float(np.percentile(depth, 25)) * raster.pixel
    origin = mover.motion.origin + (at - float(mover.motion.origin @ away)) * away
    return replace(mover, motion=replace(mover.motion, origin=origin))


def _control(part: _Boxed) -> OpeningPart:
    """Return what is turned or pressed: the knob that is seen in a box, or all that stands off."""
    relief = part.front.relief
    raster = relief.raster
    box = part.panel.rectangle
    for knob in knobs_on(relief, part.front.face):
        if box.holds(raster.pixels(knob.motion.origin)[:2]):
            return knob
    right, up, away = raster.side.frame
    carrier = float(np.median(part.front.face.height[_slices(box)]))
    back = raster.near - (carrier + 1.0) * raster.pixel
    low = raster.low[::-1] + (box.low - 1.0) * raster.pixel
    high = raster.low[::-1] + (box.high + 1.0) * raster.pixel
    height, across = (low + high) / 2.0
    origin = across * right + height * up + back * away
    region = box_before(raster.side, low, high, back)
    if part.stated.kind is PartKind.BUTTON:
        motion = Motion(JointKind.PRISMATIC, away, origin, 0.0, BUTTON_TRAVEL_M)
    else:
        motion = Motion.endless(away, origin)
    return OpeningPart(part.stated.kind, region, motion, 1.0, 1.0)


def _slices(box: Rectangle) -> tuple[slice, slice]:
    """Return the rows and columns of a rectangle."""
    rows, columns = zip(box.low, box.high + 1, strict=True)
    return slice(*rows), slice(*columns)


def _as_stated(mover: OpeningPart, part: StatedPart, mesh: Mesh) -> OpeningPart:
    """Return a part with the name, limits and depth that were stated, in the mesh's frame."""
    region = mover.region
    for view in part.also:
        right, up, _ = view.side.frame
        low, high = StatedFrame.of(mesh, view.side).place(view.box)
        region = Region(
            np.concatenate([region.normals, np.stack([right, -right, up, -up])]),
            np.concatenate([region.offsets, [high[0], -low[0], high[1], -low[1]]]),
        )
    mover = replace(mover, kind=part.kind, region=region)
    if part.range is None:
        return mover
    lower, upper = (each / stated_unit(mover.motion) for each in part.range)
    return replace(mover, motion=replace(mover.motion, lower=lower, upper=upper))


def stated_unit(motion: Motion) -> float:
    """Return how many stated units, degrees or millimetres, are one of a joint's, rad or m."""
    return MM if motion.kind is JointKind.PRISMATIC else float(np.degrees(1.0))
