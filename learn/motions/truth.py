"""Known motions, as the evidence sees objects: parts with faces, closed, each with one joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.factory.articulate.evidence import Guess, Partition
from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.posing import closed, turned
from asset_factory.factory.mesh import FloatArray

from ..bodies import bodies_of

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
    bodies = bodies_of(turned(closed(articulation), yaw))
    single = {body: own[0] for body, own in enumerate(bodies.joints) if len(own) == 1}
    mesh = bodies.articulation.mesh
    return Truth(Partition(mesh, bodies.labels, np.array(bodies.parents)), single)


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
