"""The articulation of an input, remembered: the network that it takes is not asked twice the same."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..articulation import Articulation, Joint, Part, Weights
from ..intake.intake import Intake
from ..keys import articulate_key
from ..mesh import FloatArray, IntArray, Mesh
from ..runtime.stages import Stages
from .choose import articulate


@dataclass(frozen=True)
class _Shape:
    """What posing changes of a mesh; appearance stays with the faces."""

    vertices: FloatArray
    faces: IntArray
    corner_normals: FloatArray | None

    @classmethod
    def of(cls, mesh: Mesh) -> _Shape:
        return cls(mesh.vertices, mesh.faces, mesh.corner_normals)

    def on(self, mesh: Mesh) -> Mesh:
        return replace(
            mesh, vertices=self.vertices, faces=self.faces, corner_normals=self.corner_normals
        )


@dataclass(frozen=True)
class _Tree:
    """An articulation without the mesh that it was given.

    Attributes:
        posed: the mesh's shape, where a joint's range leaves out the input's pose, so that the
            articulator moved it.
    """

    parts: tuple[Part, ...]
    joints: tuple[Joint, ...]
    articulator: str
    notes: tuple[str, ...]
    weights: tuple[Weights, ...]
    posed: _Shape | None = None


def articulated(intake: Intake, loaded: str, stages: Stages) -> Articulation:
    """As :func:`~.choose.articulate`, with the settings of ``stages``.

    Args:
        intake: the loaded input.
        loaded: key of all that it was loaded from.
        stages: with the settings, and what is remembered.

    Raises:
        InputRejected: as the articulator does, or did.
    """
    config = stages.config

    def tree() -> _Tree:
        made = articulate(intake, config.articulator, config.particulate, config.auto)
        posed = None if made.mesh is intake.mesh else _Shape.of(made.mesh)
        return _Tree(made.parts, made.joints, made.articulator, made.notes, made.weights, posed)

    kept = stages.recall("articulate", _Tree, articulate_key(loaded, config), tree)
    mesh = intake.mesh if kept.posed is None else kept.posed.on(intake.mesh)
    return Articulation(mesh, kept.parts, kept.joints, kept.articulator, kept.notes, kept.weights)
