"""How much of the object moves as it truly does: faces weighted by area, nothing sampled.

Parts are matched by the area that they share. ``found`` is a true moving part whose match covers it
by more than half (intersection over union) and moves of itself; types, axes and ranges are compared
where the match covers so much.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import FloatArray

from ..bodies import bodies_of
from .joints import FOUND_IOU, joint_figures
from .pairing import Pairing, paired, shared_areas
from .score import Score

#: Shares of their range by which joints are opened to compare where faces get to.
STATES = (0.25, 0.5, 0.75, 1.0)
#: Farthest that a face may be from where it truly is, as a share of the object's longest side.
TOLERANCE = 0.05
STRICT_TOLERANCE = 0.02
#: And as a share of how far its part went: what moves little is told from what does not.
TRAVEL_TOLERANCE = 0.5
#: A joint that turns so far [rad] comes back to where it was.
WHOLE_TURN = 2.0 * np.pi - 0.01


def physical(true: Articulation, predicted: Articulation) -> Score:
    """Compare two articulations of the same mesh, faces in the same order and the same pose.

    Returns:
        Of the object: ``part_miou`` (mean of both directions, a part without match is 0), and
        ``articulated_iou`` of moving parts, where only faces that get where they truly get are
        shared; ``articulated_iou_strict`` with a smaller tolerance.
        Of its parts: ``recall``, ``precision``, ``left_fixed``, ``still_moved``, and figures of
        their joints, see :func:`.joints.joint_figures`.

    Raises:
        ValueError: the two are over different meshes.
    """
    if len(true.mesh.faces) != len(predicted.mesh.faces):
        raise ValueError(
            f"{len(predicted.mesh.faces)} predicted faces for {len(true.mesh.faces)} true ones"
        )
    areas = face_areas(true.mesh)
    real, guess = (bodies_of(_without_needless_ends(each)) for each in (true, predicted))
    pairing = _with_aligned_turns(paired(real, guess, areas))
    of_true, of_predicted = pairing.spread(pairing.iou)
    values = {"part_miou": (of_true.mean() + of_predicted.mean()) / 2.0}
    for suffix, tolerance in (("", TOLERANCE), ("_strict", STRICT_TOLERANCE)):
        values[f"articulated_iou{suffix}"] = _motion_aware(pairing, areas, tolerance)
    return Score(values, _shares(pairing) | joint_figures(pairing))


def _without_needless_ends(articulation: Articulation) -> Articulation:
    """Take the ends from joints that turn all the way round, whatever the file calls them."""

    def endless(joint: Joint) -> Joint:
        if joint.kind is not JointKind.REVOLUTE or joint.range < WHOLE_TURN:
            return joint
        return replace(joint, kind=JointKind.CONTINUOUS, lower=-np.pi, upper=np.pi)

    return replace(articulation, joints=tuple(endless(joint) for joint in articulation.joints))


def _motion_aware(pairing: Pairing, areas: FloatArray, tolerance: float) -> float:
    """Return the intersection over union of moving bodies, averaged over states and both ways."""
    true = pairing.true
    predicted = pairing.predicted
    farthest = tolerance * pairing.size
    true_area = pairing.shared.sum(axis=1)
    predicted_area = pairing.shared.sum(axis=0)
    closed = true.centres_at(0.0)
    total = np.zeros(len(pairing.pairs))
    for share in STATES:
        at = true.centres_at(share)
        guessed = predicted.centres_at(share)
        travel = np.zeros(len(true))
        np.maximum.at(travel, true.labels, np.linalg.norm(at - closed, axis=1))
        told = np.minimum(farthest, TRAVEL_TOLERANCE * travel)
        allowed = np.where(true.mobile, told, farthest)
        right = np.linalg.norm(at - guessed, axis=1) <= allowed[true.labels]
        met = shared_areas(true, predicted, areas * right)
        for index, (real, guess) in enumerate(pairing.pairs):
            if true.moving[real] == predicted.moving[guess]:
                both = true_area[real] + predicted_area[guess]
                total[index] += met[real, guess] / (both - met[real, guess])
    of_true, of_predicted = pairing.spread(total / len(STATES))
    chosen = of_true[true.moving], of_predicted[predicted.moving]
    return sum(float(values.mean()) if len(values) else 0.0 for values in chosen) / 2.0


def _shares(pairing: Pairing) -> dict[str, tuple[float, ...]]:
    """Return per moving part whether it was found, is right, was left fixed, is still."""
    true = pairing.true
    predicted = pairing.predicted
    shared = pairing.shared
    real, guess = pairing.pairs.T
    good = (pairing.iou > FOUND_IOU) & true.moving[real] & predicted.moving[guess]
    found, right = pairing.spread(good.astype(np.float64))
    left = shared[:, ~predicted.mobile].sum(axis=1) > 0.5 * shared.sum(axis=1)
    still = shared[~true.mobile].sum(axis=0) > 0.5 * shared.sum(axis=0)
    return {
        "recall": tuple(found[true.moving]),
        "precision": tuple(right[predicted.moving]),
        "left_fixed": tuple(left[true.moving].astype(float)),
        "still_moved": tuple(still[predicted.moving].astype(float)),
    }


def _with_aligned_turns(pairing: Pairing) -> Pairing:
    """Turn axes of endless joints to match their true ones, as their sign means nothing."""
    flipped = set()
    for real, guess in pairing.pairs:
        ours = pairing.true.joint(real, turns=True)
        theirs = pairing.predicted.joint(guess, turns=True)
        if ours is None or theirs is None:
            continue
        if ours.kind is theirs.kind is JointKind.CONTINUOUS and ours.axis @ theirs.axis < 0.0:
            flipped.add(theirs.name)
    whole = pairing.predicted.articulation
    joints = tuple(replace(j, axis=-j.axis) if j.name in flipped else j for j in whole.joints)
    return replace(pairing, predicted=bodies_of(replace(whole, joints=joints)))
