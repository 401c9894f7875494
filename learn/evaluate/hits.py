"""Of all true moving parts, the share whose joint is right in one respect; missed is wrong."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import FloatArray

from ..bodies import face_centres
from .pairing import Pairing

#: A match that covers a part by no more than this is of another part.
FOUND_IOU = 0.5
#: An axis within these is right: the angle [deg], and the distances as shares of the longest side.
RIGHT_ANGLE_DEG = 5.0
RIGHT_OFFSET = 0.05
STRICT_OFFSET = 0.02


def hits(pairing: Pairing) -> dict[str, tuple[float, ...]]:
    """Return 1 or 0 per true moving part, in the bodies' order; 0 unless found and moving.

    Returns:
        ``type_of_all``: the type is right. ``axis_of_all``: an axis that both have is there, and
        all such are within 5 degrees. ``joint_right``: both of these, and the axis of the turn, if
        there is one, within 5 % of the longest side. Of the true parts that turn:
        ``place_of_all``, ``place_of_all_strict``: the prediction turns about an axis within 5 % and
        2 % of the longest side of the true one; which way it points is not asked.
    """
    names = ("type_of_all", "axis_of_all", "place_of_all", "place_of_all_strict", "joint_right")
    true = pairing.true
    predicted = pairing.predicted
    found = {name: np.zeros(len(true)) for name in names}
    for (real, guess), iou in zip(pairing.pairs, pairing.iou, strict=True):
        if not true.moving[real] or not predicted.moving[guess] or iou <= FOUND_IOU:
            continue
        alike = true.kind(real) == predicted.kind(guess)
        parallel = max(angles(pairing, real, guess), default=np.inf) < RIGHT_ANGLE_DEG
        place = offset(pairing, real, guess)
        share = np.inf if place is None else place / pairing.size
        found["type_of_all"][real] = alike
        found["axis_of_all"][real] = parallel
        found["place_of_all"][real] = share < RIGHT_OFFSET
        found["place_of_all_strict"][real] = share < STRICT_OFFSET
        found["joint_right"][real] = alike and parallel and (place is None or share < RIGHT_OFFSET)
    turning = np.array([true.turn(body) is not None for body in range(len(true))])
    moving = true.moving
    asked = {name: moving & turning if name.startswith("place") else moving for name in names}
    return {name: tuple(found[name][asked[name]].tolist()) for name in names}


def angles(pairing: Pairing, real: int, guess: int) -> list[float]:
    """Return the angles between two bodies' axes, of turns and slides, either way [deg]."""
    true = pairing.true
    predicted = pairing.predicted
    both = (true.turn(real), predicted.turn(guess)), (true.slide(real), predicted.slide(guess))
    cosines = [abs(one.axis @ other.axis) for one, other in both if one and other]
    return [float(np.degrees(np.arccos(np.clip(each, 0.0, 1.0)))) for each in cosines]


def offset(pairing: Pairing, real: int, guess: int) -> float | None:
    """Return the distance of two turn axes [m], at the true one's point next to the part.

    ``None`` unless both turn.
    """
    ours = pairing.true.turn(real)
    theirs = pairing.predicted.turn(guess)
    if ours is None or theirs is None:
        return None
    mesh = pairing.true.articulation.mesh
    own = pairing.true.labels == real
    middle: FloatArray = np.average(face_centres(mesh)[own], axis=0, weights=face_areas(mesh)[own])
    at = ours.origin + ours.axis * float(ours.axis @ (middle - ours.origin)) - theirs.origin
    return float(np.linalg.norm(at - theirs.axis * float(theirs.axis @ at)))
