"""What a mesh may be: its front panels or its lid, and other ways to read them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.crossings import Side
from ...mesh import Mesh
from .fronts import AROUND, Front, fronts_of
from .lids import Lid, find_lids
from .motions import Opening, openings_of
from .panels import FrontPanel, Layout, layouts_of
from .placing import OpeningPart, lid_mover, panel_mover
from .relief import Relief, reliefs_of
from .straight import straightening

MOST_READINGS = 4
#: Log-odds of a lid where no seam runs around.
NO_LID = -6.0
#: A panel may reach so far into a lid [pixels].
RIM = 4
#: Fronts face -Y or +X of the object frame (glTF's +z and +x), if anything is usual.
USUAL_FRONT = {Side.FRONT: 0.3, Side.RIGHT: 0.2, Side.BACK: 0.0, Side.LEFT: 0.0}
#: What is flatter than this share of its longest extent holds nothing.
SHEET = 0.02
#: Another way to open is worth a reading of its own from this probability.
LEAST_OTHER = 0.1


@dataclass(frozen=True)
class MeshReading:
    """One way to read a mesh.

    Attributes:
        movers: what opens, and how.
        notes: what was assumed, one sentence each.
        probability: of this reading among all, 0 to 1.
    """

    movers: tuple[OpeningPart, ...]
    notes: tuple[str, ...]
    probability: float


def read(mesh: Mesh) -> tuple[MeshReading, ...]:
    """The readings of a mesh (metres, z up), the likeliest first, at most four."""
    if mesh.extents.min() <= SHEET * mesh.extents.max():
        return ()
    straight = straightening(mesh)
    if straight is None:
        return read_reliefs(reliefs_of(mesh))
    turn = np.eye(4)
    turn[:3, :3] = straight
    found = read_reliefs(reliefs_of(mesh.transformed(turn)))
    return tuple(
        replace(each, movers=tuple(mover.turned(straight.T) for mover in each.movers))
        for each in found
    )


def read_reliefs(reliefs: Mapping[Side, Relief]) -> tuple[MeshReading, ...]:
    """The readings of an object that is seen from its sides and from above."""
    fronts = fronts_of(reliefs)
    lids = find_lids(fronts, reliefs[Side.TOP])
    odds = lids[0].value if lids else NO_LID
    layouts = {
        side: layouts_of(fronts[side].scene, fronts[side].rectangles(), odds) for side in AROUND
    }
    side = max(AROUND, key=lambda each: _front_value(layouts[each], each))
    plans = _plans(layouts[side], lids[0] if lids else None)
    values = np.array([plan.value for plan in plans])
    shares = np.exp(values - values.max())
    shares /= shares.sum()
    found = [
        reading
        for plan, share in zip(plans, shares.tolist(), strict=True)
        if share >= LEAST_OTHER and (plan.panels or plan.lid)
        for reading in _readings(fronts, side, plan, share)
    ]
    return tuple(sorted(found, key=lambda reading: -reading.probability)[:MOST_READINGS])


def _front_value(layouts: Sequence[Layout], side: Side) -> float:
    return layouts[0].value + USUAL_FRONT[side] if layouts else 0.0


@dataclass(frozen=True, eq=False)
class _Plan:
    """What opens of an object, however it does."""

    panels: tuple[FrontPanel, ...]
    lid: Lid | None
    value: float


def _plans(layouts: Sequence[Layout], lid: Lid | None) -> list[_Plan]:
    """Layouts of the front with and without a lid above them, the likeliest first."""
    found = [_Plan(layout.panels, None, layout.value) for layout in layouts]
    if lid is not None and lid.value > 0.0:
        for layout in layouts:
            below = tuple(
                panel for panel in layout.panels if panel.rectangle.high[0] <= lid.row + RIM
            )
            value = lid.value + sum(panel.value for panel in below)
            found.append(_Plan(below, lid, value))
        found.append(_Plan((), lid, lid.value))
    found.append(_Plan((), None, 0.0))
    different = {(plan.panels, plan.lid): plan for plan in reversed(found)}
    return sorted(different.values(), key=lambda plan: -plan.value)


def _readings(
    fronts: Mapping[Side, Front], side: Side, plan: _Plan, share: float
) -> list[MeshReading]:
    """The likeliest way in which a plan opens, and those in which one part opens otherwise."""
    ways = [
        _panel_ways(fronts[side], opening)
        for opening in openings_of(fronts[side].scene, plan.panels)
    ]
    if plan.lid is not None:
        ways.append(_lid_ways(fronts, plan.lid))
    first = tuple(each[0] for each in ways)
    found = [_reading(first, share)]
    for index, each in enumerate(ways):
        for other in each[1:]:
            if other.sure >= LEAST_OTHER:
                movers = (*first[:index], other, *first[index + 1 :])
                found.append(_reading(movers, share))
    return found


def _panel_ways(front: Front, opening: Opening) -> list[OpeningPart]:
    confidence = confidence_of(opening.panel.value)
    return [
        panel_mover(front, opening.panel, way, front.relief.depth, confidence, share)
        for way, share in opening.ways
    ]


def _lid_ways(fronts: Mapping[Side, Front], lid: Lid) -> list[OpeningPart]:
    values = np.array([value for _, value in lid.hinges])
    shares = np.exp(2.0 * (values - values.max()))
    shares /= shares.sum()
    confidence = confidence_of(lid.value)
    return [
        lid_mover(fronts, lid, hinge, confidence, share)
        for (hinge, _), share in zip(lid.hinges, shares.tolist(), strict=True)
    ]


def _reading(movers: tuple[OpeningPart, ...], share: float) -> MeshReading:
    return MeshReading(movers, (), share * float(np.prod([mover.sure for mover in movers])))


def confidence_of(value: float) -> float:
    """Probability of a part, by its log-odds."""
    return float(1.0 / (1.0 + np.exp(-value)))
