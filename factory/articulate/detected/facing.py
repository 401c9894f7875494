"""Which way things open: furniture opens on one of two opposite sides."""

from __future__ import annotations

from ...articulation import Articulation
from ...geometry.welding import welded
from ...part import PartKind
from ...views.raster import side_facing
from ..seams.fronts import OPPOSITE

#: Panels of these kinds of object are seen from both sides, and may open either way.
BOTH_WAYS = frozenset({"door", "window"})


def without_backs(made: Articulation, kind: str) -> Articulation:
    """Return an articulation in which nothing opens behind what opens more surely.

    The back of a cabinet between its uprights looks like a door; of 319 labelled objects that open
    three have panels on opposite sides.

    Args:
        made: whose panels may open anywhere.
        kind: of the object, as the detector names it.
    """
    if kind in BOTH_WAYS:
        return made
    panels = {}
    chances = dict.fromkeys(OPPOSITE, 0.0)
    for joint in made.movable_joints:
        part = made.parts[joint.child]
        if not part.kind.closes_side and part.kind is not PartKind.PART:
            continue
        low, high = made.part_mesh(joint.child).bounds
        # Where its middle first moves.
        side = side_facing(joint.velocity((low + high) / 2.0))
        if side in OPPOSITE:
            chances[side] += part.confidence or 0.0
            if part.kind.closes_side:
                panels[joint.name] = side
    gone = {name for name, side in panels.items() if chances[side] < chances[OPPOSITE[side]]}
    return welded(made, gone)
