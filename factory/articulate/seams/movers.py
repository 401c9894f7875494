"""A mesh with parts that planes bound cut out of it; and the knobs of a one-piece mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...articulation import Articulation
from ...mesh import Mesh
from ...views.view import Views
from ..assembly import assembled
from ..rigid import rigid_articulation
from .cutting import CutMesh, Region, cut_around, inside, uncut
from .handles import cleared
from .knobs import LIKELY, knobs_on
from .placing import OpeningPart
from .relief import reliefs_of


def cut_along(mesh: Mesh, found: Sequence[Sequence[OpeningPart]]) -> CutMesh:
    """Cut a mesh along the outlines of the parts of all hypotheses."""
    cut = uncut(mesh)
    done: list[Region] = []
    for region in (mover.region for movers in found for mover in movers):
        if not any(region.same(other) for other in done):
            cut = cut_around(cut, region)
            done.append(region)
    return cut


def knobs_of(mesh: Mesh, articulator: str) -> Articulation:
    """Return a one-piece mesh with the knobs of the side that has most; else one rigid part.

    Args:
        mesh: metres, z up.
        articulator: who is asked.
    """
    sides = reliefs_of(Views(mesh)).values()
    movers = max((knobs_on(side, cleared(side)) for side in sides), key=len)
    if not movers:
        return rigid_articulation(mesh, articulator, ())
    made = cut_along(mesh, [movers]).mesh
    owner = np.zeros(len(made.faces), dtype=np.int64)
    for number, mover in enumerate(movers, start=1):
        owner[inside(made, mover.region) & (owner == 0)] = number
    proposals = [
        mover.proposal(owner == number, LIKELY) for number, mover in enumerate(movers, start=1)
    ]
    return assembled(made, owner, proposals, articulator)
