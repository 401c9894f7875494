"""What a mesh may be: its front panels or its lid, and other ways to read them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.crossings import Side
from ...mesh import IntArray, Mesh
from .fronts import AROUND, Front, fronts_of
from .layouts import layout_of, value_of
from .lids import Lid, find_lids
from .motions import Opening, openings_of
from .panels import FrontPanel, choose
from .placing import OpeningPart, lid_mover, panel_mover
from .relief import Relief, reliefs_of
from .straight import straightening

MOST_READINGS = 4
#: What a front or a lid must be worth, and by how much a lid must beat a front.
LEAST_FRONT = 2.0
LEAST_LID = 1.2
#: Fronts face -Y or +X of the object frame (glTF's +z and +x), if anything is usual.
USUAL_FRONT = {Side.FRONT: 0.3, Side.RIGHT: 0.2, Side.BACK: 0.0, Side.LEFT: 0.0}
#: What is flatter than this share of its longest extent holds nothing.
SHEET = 0.02
#: Another way to open is worth a reading of its own from this probability.
LEAST_OTHER = 0.1
#: By how much what was learned must prefer its own panels to those of the rules, in log-odds.
MARGIN = 2.0
#: Value of a panel that is right as often as not, and how fast confidence grows with it.
EVEN = 1.5
SLOPE = 0.8


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


def read(mesh: Mesh, pieces: IntArray | None = None) -> tuple[MeshReading, ...]:
    """The readings of a mesh (metres, z up), the likeliest first, at most four.

    Args:
        mesh: metres, z up.
        pieces: that it is made of, by face, whose borders are seams too; one by default.
    """
    if mesh.extents.min() <= SHEET * mesh.extents.max():
        return ()
    straight = straightening(mesh)
    if straight is None:
        return read_reliefs(reliefs_of(mesh, pieces))
    turn = np.eye(4)
    turn[:3, :3] = straight
    found = read_reliefs(reliefs_of(mesh.transformed(turn), pieces))
    return tuple(
        replace(each, movers=tuple(mover.turned(straight.T) for mover in each.movers))
        for each in found
    )


def read_reliefs(reliefs: Mapping[Side, Relief]) -> tuple[MeshReading, ...]:
    """The readings of an object that is seen from its sides and from above."""
    fronts = fronts_of(reliefs)
    found = {side: fronts[side].rectangles() for side in AROUND}
    ruled = {side: choose(fronts[side].scene, found[side]) for side in AROUND}
    side = max(AROUND, key=lambda each: _front_value(ruled[each], each))
    lids = find_lids(fronts, reliefs[Side.TOP])
    front_value = _front_value(ruled[side], side)
    lid_value = lids[0].value if lids else -np.inf
    rules_odds = value_of(fronts[side].scene, ruled[side], found[side])
    if lid_value >= LEAST_LID and (lid_value > front_value - 1.0 or rules_odds < 0.0):
        return _lid_readings(fronts, lids)
    by_rules: tuple[MeshReading, ...] = ()
    if front_value >= LEAST_FRONT:
        by_rules = _front_readings(fronts[side], ruled[side], _ruled_confidence)
    else:
        rules_odds = 0.0
    learned = {each: layout_of(fronts[each].scene, found[each]) for each in AROUND}
    other = max(AROUND, key=lambda each: learned[each].value + USUAL_FRONT[each])
    if learned[other].value <= max(rules_odds + MARGIN, 0.0):
        return by_rules
    by_learning = _front_readings(fronts[other], learned[other].panels, _learned_confidence)
    return (*by_learning[: MOST_READINGS - 1], *by_rules)[:MOST_READINGS]


def _front_value(panels: Sequence[FrontPanel], side: Side) -> float:
    return sum(panel.value for panel in panels) + USUAL_FRONT[side] if panels else 0.0


def _ruled_confidence(panel: FrontPanel) -> float:
    return confidence_of(panel.value)


def _learned_confidence(panel: FrontPanel) -> float:
    return float(1.0 / (1.0 + np.exp(-panel.value)))


def confidence_of(value: float) -> float:
    """Probability of a part, by what speaks for it."""
    return float(1.0 / (1.0 + np.exp(-SLOPE * (value - EVEN))))


def _lid_readings(fronts: Mapping[Side, Front], lids: list[Lid]) -> tuple[MeshReading, ...]:
    lid = lids[0]
    values = np.array([value for _, value in lid.hinges])
    shares = np.exp(2.0 * (values - values.max()))
    shares /= shares.sum()
    sure = confidence_of(lid.value)
    return tuple(
        MeshReading((lid_mover(fronts, lid, hinge, sure, float(share)),), (), sure * float(share))
        for (hinge, _), share in zip(lid.hinges, shares, strict=True)
        if share >= LEAST_OTHER
    )[:MOST_READINGS]


def _front_readings(
    front: Front, panels: Sequence[FrontPanel], confidence: Callable[[FrontPanel], float]
) -> tuple[MeshReading, ...]:
    openings = openings_of(front.scene, panels)
    best = _reading(front, openings, confidence)
    found = [best]
    for index, opening in enumerate(openings):
        for rank, (_, share) in enumerate(opening.ways[1:], start=1):
            if share < LEAST_OTHER:
                continue
            ways = (opening.ways[rank], *opening.ways[:rank], *opening.ways[rank + 1 :])
            other = (*openings[:index], replace(opening, ways=ways), *openings[index + 1 :])
            found.append(_reading(front, other, confidence))
    found[1:] = sorted(found[1:], key=lambda reading: -reading.probability)
    return tuple(found[:MOST_READINGS])


def _reading(
    front: Front, openings: tuple[Opening, ...], confidence: Callable[[FrontPanel], float]
) -> MeshReading:
    behind = front.relief.depth
    movers = tuple(
        panel_mover(
            front,
            opening.panel,
            opening.way,
            behind,
            confidence(opening.panel),
            opening.ways[0][1],
        )
        for opening in openings
    )
    probability = float(np.prod([mover.confidence * mover.sure for mover in movers]))
    return MeshReading(movers, (), probability)
