"""What a mesh may be: its front panels or its lid, and other ways to read them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.crossings import Side
from ...mesh import IntArray, Mesh
from .fronts import AROUND, Front, fronts_of
from .lids import Lid, find_lids
from .motions import Opening, openings_of
from .placing import OpeningPart, lid_mover, panel_mover
from .relief import relief_of

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
    fronts = fronts_of(mesh, pieces)
    side = max(AROUND, key=lambda each: _front_value(fronts[each]))
    lids = find_lids(fronts, relief_of(mesh, Side.TOP))
    front_value = _front_value(fronts[side])
    lid_value = lids[0].value if lids else -np.inf
    if lid_value >= LEAST_LID and lid_value > front_value - 1.0:
        return _lid_readings(fronts, lids)
    if front_value >= LEAST_FRONT:
        return _front_readings(fronts[side])
    return ()


def _front_value(front: Front) -> float:
    return front.value + USUAL_FRONT[front.relief.side] if front.panels else 0.0


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


def _front_readings(front: Front) -> tuple[MeshReading, ...]:
    openings = openings_of(front.relief, front.panels)
    best = _reading(front, openings)
    found = [best]
    for index, opening in enumerate(openings):
        for rank, (_, share) in enumerate(opening.ways[1:], start=1):
            if share < LEAST_OTHER:
                continue
            ways = (opening.ways[rank], *opening.ways[:rank], *opening.ways[rank + 1 :])
            other = (*openings[:index], replace(opening, ways=ways), *openings[index + 1 :])
            found.append(_reading(front, other))
    found[1:] = sorted(found[1:], key=lambda reading: -reading.probability)
    return tuple(found[:MOST_READINGS])


def _reading(front: Front, openings: tuple[Opening, ...]) -> MeshReading:
    behind = front.relief.depth
    movers = tuple(
        panel_mover(
            front,
            opening.panel,
            opening.way,
            behind,
            confidence_of(opening.panel.value),
            opening.ways[0][1],
        )
        for opening in openings
    )
    probability = float(np.prod([mover.confidence * mover.sure for mover in movers]))
    return MeshReading(movers, (), probability)
