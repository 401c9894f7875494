"""A hinge without limits that runs into something turns as far as it is free, either way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...articulate.ranges import CLEAR_DIFFERENCE, MOST_TURN, box_volumes
from ...articulation import Articulation, Joint, JointKind
from ...asset import Asset
from ...geometry.posing import face_parts
from ...manufacture.plan import Plan
from ...manufacture.repair import RepairKind
from ...manufacture.separate.along import LEAST_M
from ...manufacture.separate.sweep import free_until
from ...mesh import FloatArray
from .evidence import RepairEvidence, record_change
from .mend import PLANED_M, Mended, with_mended
from .shorten import FREE_M


def find_limits(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every blocked hinge without limits with those that its surroundings give it.

    One that turns freely all the way has none still. One that is free over less than the share of a
    quarter turn that a joint may be shortened to is left to other repairs, and so are knobs and
    caps: the object is as large wherever they stand.
    """
    asset = evidence.asset
    if "sweep_penetration" not in evidence.codes:
        return None
    found = []
    mimics = {j.name: j.mimic for j in asset.articulation.joints if j.mimic is not None}
    coupled = mimics.keys() | {mimic.leader for mimic in mimics.values()}
    least = evidence.config.least_range_share * np.pi / 2.0
    for name in evidence.jammed():
        joint = asset.articulation.joint(name)
        # Guesses are hung anew by those who made them.
        stated = joint.confidence is None and joint.name not in coupled
        if joint.kind is not JointKind.CONTINUOUS or not stated:
            continue
        low, drawn, high = _sizes(asset.articulation, joint, (-np.pi / 2.0, 0.0, np.pi / 2.0))
        if max(low, high) <= (1.0 + CLEAR_DIFFERENCE) * drawn:
            continue
        ended = opening(asset.articulation, _free_about_the_drawn_pose(asset, joint))
        if ended.range >= least:
            told = record_change(RepairKind.LIMITS_FOUND, ended, ended.lower, ended.upper)
            found.append(Mended(ended, told))
    return with_mended(plan, found)


def _free_about_the_drawn_pose(asset: Asset, joint: Joint) -> Joint:
    """Return the hinge between the two ends up to which nothing gets deeper than as drawn.

    But for so much on the way as the cut that follows may plane off.
    """
    onwards = replace(joint, kind=JointKind.REVOLUTE, lower=0.0, upper=MOST_TURN)
    backwards = replace(onwards, axis=-joint.axis)
    lower, upper = (
        free_until(asset, way, PLANED_M, FREE_M, LEAST_M) for way in (backwards, onwards)
    )
    return replace(onwards, lower=-lower, upper=upper)


def opening(articulation: Articulation, joint: Joint) -> Joint:
    """Return a hinge whose limits nobody stated, closed where the object is smallest.

    That is at an end of its range, or as drawn: then it opens from there, the way that is longer.
    """
    flipped = replace(joint, axis=-joint.axis, lower=-joint.upper, upper=-joint.lower)
    low, drawn, high = _sizes(articulation, joint, (joint.lower, 0.0, joint.upper))
    if drawn <= (1.0 + CLEAR_DIFFERENCE) * min(low, high):
        longer = joint if joint.upper >= -joint.lower else flipped
        return replace(longer, lower=0.0)
    return joint if low < high else flipped


def _sizes(articulation: Articulation, joint: Joint, values: Sequence[float]) -> FloatArray:
    """Return the volume of the box around the object at each value of a joint [m3]."""
    inside = np.isin(face_parts(articulation), articulation.carried(joint.child))
    return box_volumes(articulation.mesh, inside, joint, values)
