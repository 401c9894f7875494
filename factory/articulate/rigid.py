"""The articulator that moves nothing."""

import numpy as np

from ..articulation import Articulation, Part
from ..config import BuildConfig
from ..intake.intake import Intake
from ..mesh import Mesh


class RigidArticulator:
    """One part and no joints: for chairs, rocks, and anything that must not move."""

    name = "rigid"

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the whole mesh (metres, z up) as the one part ``base``. Never fails."""
        return rigid_articulation(mesh, self.name)


def articulator_for(intake: Intake, config: BuildConfig) -> RigidArticulator:
    """Return the same one for every input."""
    return RigidArticulator()


def rigid_articulation(mesh: Mesh, articulator: str, notes: tuple[str, ...] = ()) -> Articulation:
    """Return all faces of ``mesh`` as the part ``base``, without joints, and why in ``notes``."""
    return Articulation(
        mesh=mesh,
        parts=(Part("base", np.arange(len(mesh.faces))),),
        joints=(),
        articulator=articulator,
        notes=notes,
    )
