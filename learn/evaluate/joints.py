"""Joints of true moving parts against those of the predicted parts that stand for them."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import FloatArray

from ..bodies import Bodies, face_centres
from .pairing import Pairing

#: A match that covers a part by no more than this is of another part.
FOUND_IOU = 0.5
#: An axis within these is right: the angle [deg], and the distances as shares of the longest side.
RIGHT_ANGLE_DEG = 5.0
RIGHT_OFFSET = 0.05
STRICT_OFFSET = 0.02
#: Share of the range after which the directions of opening are compared.
FIRST_SHARE = 0.25
JointPair = tuple[Joint | None, Joint | None]
NAMES = (
    "type_of_all", "axis_of_all", "place_of_all", "place_of_all_strict", "joint_right",
    "type_accuracy", "axis_angle_deg", "axis_offset", "opens_right_way", "range_error_rad",
    "range_error_size",
)  # fmt: skip


def joint_figures(pairing: Pairing) -> dict[str, tuple[float, ...]]:
    """Return numbers by name, each of the true moving parts that it applies to, in their order.

    Returns:
        1 or 0 of all of them, 0 unless a part that moves was found for it: ``type_of_all``: the
        type is right. ``axis_of_all``: an axis that both have is there, and all such are within 5
        degrees. ``joint_right``: both of these, and the axis of the turn, if there is one, within
        5 % of the longest side. Of those that turn: ``place_of_all``, ``place_of_all_strict``: the
        prediction turns about an axis within 5 % and 2 % of the longest side of the true one; which
        way it points is not asked.
        Of those that were found: ``type_accuracy``. Of those found that move: ``axis_angle_deg``,
        ``axis_offset`` (share of the longest side), ``opens_right_way``, ``range_error_rad``,
        ``range_error_size`` (share of the longest side).
    """
    true = pairing.true
    predicted = pairing.predicted
    partners: dict[int, int] = dict(pairing.pairs[pairing.iou > FOUND_IOU].tolist())
    figures: dict[str, list[float]] = {name: [] for name in NAMES}
    mesh = true.articulation.mesh
    centres = face_centres(mesh)
    areas = face_areas(mesh)
    for real in np.flatnonzero(true.moving).tolist():
        guess = partners.get(real)
        mover = guess if guess is not None and predicted.moving[guess] else None
        alike = guess is not None and true.kind(real) == predicted.kind(guess)
        turns, slides = (
            (true.joint(real, way), None if mover is None else predicted.joint(mover, way))
            for way in (True, False)
        )
        angle = max(_angles(turns, slides), default=None)
        own = true.labels == real
        place = _offset(turns, np.average(centres[own], axis=0, weights=areas[own]), pairing.size)
        parallel = angle is not None and angle < RIGHT_ANGLE_DEG
        near = place is not None and place < RIGHT_OFFSET
        figures["type_of_all"].append(alike)
        figures["axis_of_all"].append(parallel)
        figures["joint_right"].append(alike and parallel and (place is None or near))
        if turns[0] is not None:
            figures["place_of_all"].append(near)
            figures["place_of_all_strict"].append(place is not None and place < STRICT_OFFSET)
        if guess is not None:
            figures["type_accuracy"].append(alike)
        if angle is not None:
            figures["axis_angle_deg"].append(angle)
        if place is not None:
            figures["axis_offset"].append(place)
        for name, unit, (ours, theirs) in (("rad", 1.0, turns), ("size", pairing.size, slides)):
            if ours and theirs and ours.kind is not JointKind.CONTINUOUS:
                figures[f"range_error_{name}"].append(abs(ours.range - theirs.range) / unit)
        endless = turns[0] is not None and turns[0].kind is JointKind.CONTINUOUS
        if mover is not None and (slides[0] is not None or not endless):
            bodies = ((true, real), (predicted, mover))
            ways = (_opening(*each, centres[own]) for each in bodies)
            along = float((areas[own] * np.einsum("ij,ij->i", *ways)).sum())
            figures["opens_right_way"].append(along > 0.0)
    return {name: tuple(map(float, values)) for name, values in figures.items()}


def _angles(*pairs: JointPair) -> list[float]:
    """Return the angles between the axes of joints that both have, either way [deg]."""
    cosines = [abs(ours.axis @ theirs.axis) for ours, theirs in pairs if ours and theirs]
    return [float(np.degrees(np.arccos(np.clip(each, 0.0, 1.0)))) for each in cosines]


def _offset(turns: JointPair, middle: FloatArray, size: float) -> float | None:
    """Return how far two axes are apart, at the true one's point next to a part, over the size.

    ``None`` unless both turn; ``middle`` is the part's [m], shape [3].
    """
    ours, theirs = turns
    if ours is None or theirs is None:
        return None
    at = ours.origin + ours.axis * float(ours.axis @ (middle - ours.origin)) - theirs.origin
    return float(np.linalg.norm(at - theirs.axis * float(theirs.axis @ at))) / size


def _opening(bodies: Bodies, body: int, points: FloatArray) -> FloatArray:
    """Return how points of a body begin to move by its own joints [m], shape [point_count, 3]."""
    change = bodies.own_motion(body, FIRST_SHARE) - bodies.own_motion(body, 0.0)
    return np.asarray(points @ change[:3, :3].T + change[:3, 3])
