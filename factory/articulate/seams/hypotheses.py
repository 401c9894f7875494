"""What a mesh may be: its front panels or its lid, and other ways in which they may open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...views.raster import Side
from ...views.view import Views
from .appliances import appliance_door
from .candidates import is_among
from .fronts import AROUND, Front, fronts_of
from .groups import FrontPanel
from .handles import cleared
from .knobs import knobs_on
from .layouts import layout_of, value_of
from .lids import Lid, find_lids
from .motions import Opening, openings_of
from .panels import choose
from .placing import OpeningPart, lid_mover, panel_mover
from .rectangles import Rectangle
from .relief import Relief, reliefs_of
from .straight import straightening

MOST = 4
#: What a front or a lid must be worth, and by how much a lid must beat a front.
LEAST_FRONT = 2.0
LEAST_LID = 1.2
#: Fronts face -Y or +X of the object frame (glTF's +z and +x), if anything is usual.
USUAL_FRONT = {Side.FRONT: 0.3, Side.RIGHT: 0.2, Side.BACK: 0.0, Side.LEFT: 0.0}
#: What is flatter than this share of its longest extent holds nothing.
SHEET = 0.02
#: Another way to open is worth a hypothesis of its own from this probability.
LEAST_OTHER = 0.1
#: By how much what was learned must prefer its own panels to those of the rules, in log-odds.
MARGIN = 2.0
#: A panel of which the picture network sees less than this share is none.
LEAST_SEEN = 0.15
#: Of panels of which it sees that much nobody else's doubts count.
CLEAR = 0.85
#: What is closed by grooves and steps to this, and has a handle that stands off so far [pixels],
#: is one, whoever sees it.
EVIDENT = 0.9
STANDS_OFF = 4.0
#: Several with handles, each closed to this, are no drawing on a chest.
SHUT = 0.75
#: Value of a panel that is right as often as not, and how fast confidence grows with it.
EVEN = 1.5
SLOPE = 0.8


#: What opens, if one hypothesis is right.
Movers = tuple[OpeningPart, ...]


def hypotheses_of_views(views: Views) -> tuple[Movers, ...]:
    """Return what may open of a mesh (metres, z up), the likeliest first, at most four.

    Args:
        views: of the mesh; the borders between its parts are seams too.
    """
    mesh = views.mesh
    if mesh.extents.min() <= SHEET * mesh.extents.max():
        return ()
    straight = straightening(mesh)
    if straight is None:
        return hypotheses_of_reliefs(reliefs_of(views))
    found = hypotheses_of_reliefs(reliefs_of(Views(mesh.turned(straight), views.owner)))
    return tuple(tuple(mover.turned(straight.T) for mover in movers) for movers in found)


def hypotheses_of_reliefs(reliefs: Mapping[Side, Relief]) -> tuple[Movers, ...]:
    """Return what may open of an object that is seen from its sides and from above."""
    seen = _Sides.of(reliefs)
    top = reliefs[Side.TOP]
    knobs = {side: knobs_on(each.relief, each.scene.face) for side, each in seen.fronts.items()}
    knobs[Side.TOP] = knobs_on(top, cleared(top))
    side = max(knobs, key=lambda each: len(knobs[each]))
    if not knobs[side]:
        return _openings(seen, has_knobs=False)
    found = _openings(seen, has_knobs=True) or _appliance_hypotheses(seen, side)
    return tuple(_with(movers, knobs[side]) for movers in found)


def _appliance_hypotheses(seen: _Sides, side: Side) -> tuple[Movers, ...]:
    """Return hypotheses of an object with knobs on one side: its door, if any."""
    door = appliance_door(seen.fronts[side], seen.found[side]) if side in AROUND else None
    if door is not None and not _is_seen(seen.fronts[side], door.panel):
        door = None
    openings = () if door is None else (door,)
    return (_movers(seen.fronts, side, openings),)


def _with(movers: Movers, knobs: Sequence[OpeningPart]) -> Movers:
    """Return what opens, with those knobs that sit on nothing of it."""
    fixed = [
        knob
        for knob in knobs
        if not any(mover.region.holds(knob.motion.origin) for mover in movers)
    ]
    return (*movers, *fixed)


def _probability(movers: Movers) -> float:
    """Return the probability that all of it is right, as if each were independent."""
    return float(np.prod([mover.probability for mover in movers]))


def _openings(seen: _Sides, *, has_knobs: bool) -> tuple[Movers, ...]:
    """Return the openings, without knobs; with some it is an appliance, whose top is no lid."""
    odds = value_of(seen.front.scene, seen.panels, seen.found[seen.side])
    if not has_knobs and seen.has_lid(odds < 0.0 and not seen.is_clear):
        return _lid_hypotheses(seen.fronts, seen.lids)
    by_rules = seen.front_hypotheses()
    layouts = {side: layout_of(seen.fronts[side].scene, seen.found[side]) for side in AROUND}
    side = max(AROUND, key=lambda each: layouts[each].value + USUAL_FRONT[each])
    learned = layouts[side]
    if by_rules and side is seen.side and seen.has_all_of(learned.panels):
        return by_rules
    if learned.value <= max((odds if by_rules else 0.0) + MARGIN, 0.0):
        return by_rules
    others = seen.hypotheses_of(side, learned.panels)
    return (*others[: MOST - 1], *by_rules)[:MOST]


@dataclass(frozen=True, eq=False)
class _Sides:
    """What rules find on the sides of an object.

    Attributes:
        fronts: the four sides.
        found: rectangles of each that are closed by seams.
        side: the one with the panels.
        panels: of that side.
        lids: the likeliest first.
    """

    fronts: Mapping[Side, Front]
    found: Mapping[Side, tuple[Rectangle, ...]]
    side: Side
    panels: tuple[FrontPanel, ...]
    lids: list[Lid]

    @classmethod
    def of(cls, reliefs: Mapping[Side, Relief]) -> _Sides:
        fronts = fronts_of(reliefs)
        found = {side: fronts[side].rectangles() for side in AROUND}
        panels = {side: choose(fronts[side].scene, found[side]) for side in AROUND}
        side = max(AROUND, key=lambda each: _front_value(panels[each], each))
        return cls(fronts, found, side, panels[side], find_lids(fronts, reliefs[Side.TOP]))

    @property
    def front(self) -> Front:
        """Return the side with the panels."""
        return self.fronts[self.side]

    @property
    def value(self) -> float:
        """Return what speaks for the panels."""
        return _front_value(self.panels, self.side)

    @property
    def is_clear(self) -> bool:
        """Return whether the picture network is sure of all of several panels."""
        areas = [panel.rectangle.area for panel in self.panels]
        shown = [self.front.sight.shows(panel.rectangle) for panel in self.panels]
        return len(areas) > 1 and bool(np.average(shown, weights=areas) >= CLEAR)

    @property
    def is_evident(self) -> bool:
        """Return whether each of several panels has a handle and seams around it."""
        return len(self.panels) > 1 and all(
            panel.handles and panel.rectangle.closed >= SHUT for panel in self.panels
        )

    def has_lid(self, doubtful: bool) -> bool:
        """Tell whether it is a lid that opens, and no panels; ``doubtful`` ones do not count."""
        if not self.lids or self.lids[0].value < LEAST_LID:
            return False
        if self.is_evident or not self.lids[0].is_seen(beside_panels=len(self.panels) > 1):
            return False
        of_lid = all(self.front.sight.is_of_lid(panel.rectangle) for panel in self.panels)
        return doubtful or of_lid or self.lids[0].value > self.value - 1.0

    def has_all_of(self, few: Sequence[FrontPanel]) -> bool:
        """Tell whether ``few`` are among the panels, and the others have handles and seams."""
        own = [panel.rectangle for panel in self.panels]
        those = [panel.rectangle for panel in few]
        if not those or not all(is_among(each, own) for each in those):
            return False
        others = [panel for panel in self.panels if not is_among(panel.rectangle, those)]
        seams = self.found[self.side]
        return all(
            panel.handles and (not panel.cut or is_among(panel.rectangle, seams))
            for panel in others
        )

    def front_hypotheses(self) -> tuple[Movers, ...]:
        """Return the panels, if there is enough to them."""
        if self.value < LEAST_FRONT:
            return ()
        sure = [replace(each, value=_log_odds(each.value)) for each in self.panels]
        return self.hypotheses_of(self.side, sure)

    def hypotheses_of(self, side: Side, panels: Sequence[FrontPanel]) -> tuple[Movers, ...]:
        """Return panels of one side whose values are log-odds; with others that fit better."""
        front = self.fronts[side]
        seen = [panel for panel in panels if _is_seen(front, panel)]
        if not seen:
            return ()
        openings = openings_of(front.scene, seen, front.sight)
        best = _movers(self.fronts, side, openings)
        found = [best]
        for index, opening in enumerate(openings):
            for rank, (_, share) in enumerate(opening.ways[1:], start=1):
                if share < LEAST_OTHER:
                    continue
                ways = (opening.ways[rank], *opening.ways[:rank], *opening.ways[rank + 1 :])
                other = (*openings[:index], replace(opening, ways=ways), *openings[index + 1 :])
                found.append(_movers(self.fronts, side, other))
        found[1:] = sorted(found[1:], key=lambda movers: -_probability(movers))
        return tuple(found[:MOST])


def _front_value(panels: Sequence[FrontPanel], side: Side) -> float:
    return sum(panel.value for panel in panels) + USUAL_FRONT[side] if panels else 0.0


def _log_odds(value: float) -> float:
    """Return the log-odds of a part, by what rules find to speak for it."""
    return SLOPE * (value - EVEN)


def _chance(log_odds: float) -> float:
    return float(1.0 / (1.0 + np.exp(-log_odds)))


def _lid_hypotheses(fronts: Mapping[Side, Front], lids: list[Lid]) -> tuple[Movers, ...]:
    lid = lids[0]
    values = np.array([value for _, value in lid.hinges])
    shares = np.exp(2.0 * (values - values.max()))
    shares /= shares.sum()
    sure = _chance(_log_odds(lid.value))
    return tuple(
        (lid_mover(fronts, lid, hinge, sure, float(share)),)
        for (hinge, _), share in zip(lid.hinges, shares, strict=True)
        if share >= LEAST_OTHER
    )[:MOST]


def _is_seen(front: Front, panel: FrontPanel) -> bool:
    """Tell whether the network sees a panel, or nobody needs to: a handle within a groove."""
    pulled = panel.handle is not None and panel.handle.height >= STANDS_OFF
    evident = pulled and float(panel.rectangle.relief.min()) >= EVIDENT
    return evident or front.sight.shows(panel.rectangle) >= LEAST_SEEN


def _movers(
    fronts: Mapping[Side, Front],
    side: Side,
    openings: tuple[Opening, ...],
) -> Movers:
    return tuple(
        panel_mover(
            fronts,
            side,
            opening.panel,
            opening.way,
            _chance(opening.panel.value),
            opening.ways[0][1],
        )
        for opening in openings
    )
