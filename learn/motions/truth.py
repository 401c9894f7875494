"""Known motions, as the evidence sees objects: parts with faces, closed, each with one joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.factory.articulate.evidence import Guess, Partition
from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.posing import closed, face_parts, turned
from asset_factory.factory.mesh import FloatArray

from ..joints import way_down

#: How wrong made-up guesses are: of the axis [rad], of its place as a share of the longest side.
ANGLE_SPREAD = np.radians(15.0)
PLACE_SPREAD = 0.1
#: How often their sense is wrong, and their probability of the true kind (mean and spread).
WRONG_WAY = 0.3
KIND = (0.8, 0.25)


@dataclass(frozen=True)
class Truth:
    """One closed object, its parts (carriers have none), and the joints of parts with just one."""

    partition: Partition
    joints: dict[int, Joint]

    @property
    def size(self) -> float:
        """Return the longest side [m]."""
        return float(self.partition.mesh.extents.max())


def truth_of(articulation: Articulation, yaw: float) -> Truth:
    """Return the object closed, and turned about the vertical by ``yaw`` [rad]."""
    shut = turned(closed(articulation), yaw)
    solid = [i for i, part in enumerate(shut.parts) if i == 0 or len(part.faces)]
    number = {part: k for k, part in enumerate(solid)}
    owner = face_parts(shut)
    labels = np.array([number.get(part, 0) for part in range(len(shut.parts))])[owner]
    parents = [-1]
    joints = {}
    for part in solid[1:]:
        parent, movable = way_down(shut, part)
        parents.append(number.get(parent, 0))
        if len(movable) == 1:
            joints[number[part]] = movable[0]
    return Truth(Partition(shut.mesh, labels, np.array(parents)), joints)


def made_up_guess(joint: Joint, middle: FloatArray, size: float, rng: np.random.Generator) -> Guess:
    """Return what somebody might believe who has a rough idea of the truth.

    ``middle`` is the part's [m], shape [3], ``size`` the object's longest side [m].
    """
    aside = rng.normal(size=3)
    aside -= float(aside @ joint.axis) * joint.axis
    aside /= np.linalg.norm(aside)
    angle = abs(rng.normal(0.0, ANGLE_SPREAD))
    direction = np.cos(angle) * joint.axis + np.sin(angle) * aside
    if rng.random() < WRONG_WAY:
        direction = -direction
    nearest = joint.origin + joint.axis * float(joint.axis @ (middle - joint.origin))
    right = float(np.clip(rng.normal(*KIND), 0.03, 0.97))
    return Guess(
        turns=1.0 - right if joint.kind is JointKind.PRISMATIC else right,
        direction=direction,
        point=nearest + rng.normal(0.0, PLACE_SPREAD * size, 3),
    )
