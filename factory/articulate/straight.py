"""How an object stands: its sides need not look along the axes of its file."""

from __future__ import annotations

import numpy as np

from ..articulation import rotation_about
from ..mesh import FloatArray, Mesh
from .geometric.scene import headings_of

#: Directions this near are one [degrees].
SPREAD = 4
#: Less of a turn is left as it is [degrees].
LEAST_TURN = 1.0
#: The sides of what is not round hold this share of all that looks sideways.
LEAST_SHARE = 0.3
_QUARTER = 90


def straightening(mesh: Mesh) -> FloatArray | None:
    """Return the rotation about z that makes an object's sides look along the axes, shape [3, 3].

    By at most an eighth of a turn; ``None`` for objects that are straight or round.
    """
    heading, area = headings_of(mesh.vertices[mesh.faces])
    angle = np.degrees(heading) % _QUARTER
    most = np.bincount(angle.astype(np.int64) % _QUARTER, area, _QUARTER)
    near = np.sum([np.roll(most, by) for by in range(-SPREAD, SPREAD + 1)], axis=0)
    if not near.max() > LEAST_SHARE * area.sum():
        return None
    off = (angle - near.argmax() - 0.5 + _QUARTER / 2) % _QUARTER - _QUARTER / 2
    one = np.abs(off) <= SPREAD + 0.5
    turn = float(near.argmax()) + 0.5 + float(np.average(off[one], weights=area[one]))
    turn = (turn + _QUARTER / 2) % _QUARTER - _QUARTER / 2
    if abs(turn) < LEAST_TURN:
        return None
    return rotation_about([0.0, 0.0, 1.0], -np.radians(turn))
