"""One-piece meshes, of which network and rules of shape see nothing: read from their sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...articulation import Articulation
from ...geometry.components import connected_components
from ...mesh import Mesh
from ...models.particulate.surface import Surface
from ..proposal import Hypothesis
from ..pruning import keep_parts
from ..seams import SeamsArticulator
from .trust import Trust

#: One piece is one surface, or one with so much of the area and crumbs of at most so much.
LARGEST = 0.9
CRUMB = 0.05


@dataclass(frozen=True)
class MeshOrigin:
    """How a mesh was made.

    Attributes:
        one_piece: whether it is one surface, but for crumbs.
        reconstructed: whether that bends a little everywhere, as no modeller has it.
    """

    one_piece: bool
    reconstructed: bool

    @classmethod
    def of(cls, mesh: Mesh) -> MeshOrigin:
        """Tell how any mesh was made."""
        surface = Surface.of(mesh.vertices, mesh.faces)
        areas = np.bincount(connected_components(mesh), weights=surface.areas)
        whole = float(areas.sum())
        if not whole > 0.0:
            return cls(one_piece=False, reconstructed=False)
        areas = np.sort(areas)
        alone = areas[-1] >= LARGEST * whole and (areas[:-1] <= CRUMB * whole).all()
        return cls(bool(alone), surface.reconstructed)

    @property
    def is_generated(self) -> bool:
        """Return whether it is what image-to-3D tools give: network and rules see rubbish in it."""
        return self.one_piece and self.reconstructed


def seam_hypotheses(mesh: Mesh, least: float, articulator: str) -> tuple[Hypothesis, ...]:
    """Return what may open of a mesh of one piece, the likeliest hypothesis first.

    Args:
        mesh: metres, z up.
        least: probability below which a part is left fixed, 0 to 1.
        articulator: who is asked.
    """
    sure = [_sure(each.articulation, least) for each in SeamsArticulator().hypotheses(mesh)]
    return tuple(Hypothesis.of(replace(each, articulator=articulator)) for each in different(sure))


def different(articulations: Sequence[Articulation]) -> tuple[Articulation, ...]:
    """Return those that do not move as an earlier one does."""
    first = {_motions(each): each for each in reversed(articulations)}
    return tuple(each for each in articulations if first[_motions(each)] is each)


def _motions(articulation: Articulation) -> str:
    joints = articulation.joints
    return repr([(joint.name, joint.axis.tolist(), joint.upper) for joint in joints])


def _sure(articulation: Articulation, least: float) -> Articulation:
    """Return the same with doubtful parts joined to the rest."""
    parts = articulation.parts
    return keep_parts(
        articulation, [k for k in range(1, len(parts)) if (parts[k].confidence or 0.0) >= least]
    )


def least_of(trust: Trust, asked: float | None) -> float:
    """Return the probability below which a part is left fixed."""
    return trust.least if asked is None else asked
