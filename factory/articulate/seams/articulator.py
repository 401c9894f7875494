"""The articulator of one-piece meshes: what opens, read from its sides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...articulation import Articulation
from ...config import BuildConfig
from ...intake.intake import Intake
from ...mesh import Mesh
from ...views.view import Views
from ..assembly import assembled
from ..proposal import Hypothesis
from ..rigid import rigid_articulation
from .cutting import CutMesh, Region, cut_around, inside, uncut
from .hypotheses import Movers, hypotheses_of_views

NAME = "seams"


class SeamsArticulator:
    """Finds doors, drawers, flaps and lids of a one-piece mesh by seams, handles and shape."""

    name = NAME

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the likeliest hypothesis of ``mesh`` [m], z up; one rigid part if nothing opens.

        The mesh of the answer is cut along the outlines of its parts.
        """
        return self.hypotheses(mesh)[0].articulation

    def hypotheses(self, mesh: Mesh) -> tuple[Hypothesis, ...]:
        """Return what ``mesh`` may be, the likeliest first, at most four.

        All share one mesh: the given one, cut along the outlines of all their parts.
        """
        found = hypotheses_of_views(Views(mesh))
        if not found:
            note = "no seam or handle on its sides speaks for a door, drawer or lid"
            return (Hypothesis.of(rigid_articulation(mesh, self.name, (note,))),)
        cut = cut_along(mesh, found)
        return tuple(Hypothesis.of(_articulation(cut.mesh, movers)) for movers in found)


def articulator_for(intake: Intake, config: BuildConfig) -> SeamsArticulator:
    """Return the same one for every input."""
    return SeamsArticulator()


def cut_along(mesh: Mesh, found: Sequence[Movers]) -> CutMesh:
    """Cut a mesh along the outlines of the parts of all hypotheses."""
    cut = uncut(mesh)
    done: list[Region] = []
    for region in (mover.region for movers in found for mover in movers):
        if not any(region.same(other) for other in done):
            cut = cut_around(cut, region)
            done.append(region)
    return cut


def _articulation(mesh: Mesh, movers: Movers) -> Articulation:
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    for number, mover in enumerate(movers, start=1):
        owner[inside(mesh, mover.region) & (owner == 0)] = number
    found = [mover.proposal(owner == number) for number, mover in enumerate(movers, start=1)]
    return assembled(mesh, owner, found, NAME)
