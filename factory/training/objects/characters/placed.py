"""The whole object stretched or mirrored, its joints with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from ....articulation import Articulation, Joint
from ....mesh import FloatArray

#: An axis this much off a coordinate axis still counts as along it.
ALONG = 1e-6


def stretched(articulation: Articulation, factors: npt.ArrayLike) -> Articulation:
    """The object scaled by a factor per axis; by their geometric mean where a joint lies aslant.

    A part turns as rigidly after stretching as before, but two of its sides may come to meet what
    they missed.

    Args:
        articulation: any.
        factors: along x, y and z, all above 0, shape [3].
    """
    wanted = np.asarray(factors, dtype=np.float64)
    if wanted.shape != (3,) or not (wanted > 0.0).all():
        raise ValueError(f"factors are {wanted.tolist()}, want three above 0")
    if any(np.abs(joint.axis).max() < 1.0 - ALONG for joint in articulation.movable_joints):
        wanted = np.full(3, float(np.prod(wanted)) ** (1.0 / 3.0))
    joints = tuple(_stretched(joint, wanted) for joint in articulation.joints)
    return replace(
        articulation, mesh=articulation.mesh.transformed(np.diag([*wanted, 1.0])), joints=joints
    )


def mirrored(articulation: Articulation) -> Articulation:
    """The object as its mirror image, left for right (x negated); opening stays positive."""
    flip = np.array([-1.0, 1.0, 1.0])
    joints = tuple(
        replace(
            joint,
            axis=(-1.0 if joint.turns else 1.0) * flip * joint.axis,
            origin=flip * joint.origin,
        )
        for joint in articulation.joints
    )
    return replace(
        articulation, mesh=articulation.mesh.transformed(np.diag([*flip, 1.0])), joints=joints
    )


def _stretched(joint: Joint, factors: FloatArray) -> Joint:
    along = 1.0 if joint.turns else float(factors[np.abs(joint.axis).argmax()])
    return replace(
        joint, origin=factors * joint.origin, lower=joint.lower * along, upper=joint.upper * along
    )
