"""The articulator of one-piece meshes: what opens, read from its sides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...articulation import Articulation, Joint, Part
from ...config import BuildConfig
from ...intake.intake import Intake
from ...mesh import Mesh
from ..naming import JOINT_SUFFIX, numbered
from ..rigid import rigid_articulation
from .cutting import CutMesh, Region, cut_around, inside, uncut
from .reading import MeshReading, read

NAME = "seams"


class SeamsArticulator:
    """Finds doors, drawers, flaps and lids of a one-piece mesh by seams, handles and shape."""

    name = NAME

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the likeliest reading of ``mesh`` (metres, z up); one rigid part if nothing opens.

        The mesh of the answer is cut along the outlines of its parts.
        """
        return self.readings(mesh)[0]

    def readings(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return what ``mesh`` may be, the likeliest first, at most four.

        All share one mesh: the given one, cut along the outlines of all their parts.
        """
        found = read(mesh)
        if not found:
            note = "nothing on its sides looks like a door, drawer or lid"
            return (rigid_articulation(mesh, self.name, (note,)),)
        return _articulations(mesh, found)


def articulator_for(intake: Intake, config: BuildConfig) -> SeamsArticulator:
    """Return the same one for every input."""
    return SeamsArticulator()


def _articulations(mesh: Mesh, found: Sequence[MeshReading]) -> tuple[Articulation, ...]:
    cut = uncut(mesh)
    done: list[Region] = []
    for region in (mover.region for reading in found for mover in reading.movers):
        if not any(region.same(other) for other in done):
            cut = cut_around(cut, region)
            done.append(region)
    return tuple(_articulation(cut, reading) for reading in found)


def _articulation(cut: CutMesh, reading: MeshReading) -> Articulation:
    owner = np.zeros(len(cut.mesh.faces), dtype=np.int64)
    for number, mover in enumerate(reading.movers, start=1):
        owner[inside(cut.mesh, mover.region) & (owner == 0)] = number
    parts = [Part("base", np.flatnonzero(owner == 0))]
    joints: list[Joint] = []
    names = numbered(mover.name for mover in reading.movers)
    for number, (name, mover) in enumerate(zip(names, reading.movers, strict=True), start=1):
        parts.append(Part(name, np.flatnonzero(owner == number), mover.confidence))
        joints.append(
            Joint(
                name=f"{name}_{JOINT_SUFFIX[mover.kind]}",
                kind=mover.kind,
                parent=0,
                child=number,
                axis=mover.axis,
                origin=mover.origin,
                lower=mover.lower,
                upper=mover.upper,
                confidence=mover.confidence * mover.sure,
            )
        )
    return Articulation(cut.mesh, tuple(parts), tuple(joints), NAME, reading.notes)
