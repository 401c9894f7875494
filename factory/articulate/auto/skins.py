"""One-piece meshes, of which network and rules of shape see nothing: read from their sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import Articulation, Part
from ...geometry.areas import face_areas
from ...geometry.components import connected_components
from ...mesh import Mesh
from ..seams import SeamsArticulator
from .trust import Trust

#: A skin is one surface, or one with so much of the area and crumbs of at most so much.
LARGEST = 0.9
CRUMB = 0.05


def is_skin(mesh: Mesh) -> bool:
    """Whether a mesh is one surface, but for crumbs."""
    areas = np.bincount(connected_components(mesh), weights=face_areas(mesh))
    whole = float(areas.sum())
    if not whole > 0.0:
        return False
    areas = np.sort(areas)
    return bool(areas[-1] >= LARGEST * whole and (areas[:-1] <= CRUMB * whole).all())


def skin_articulation(mesh: Mesh, least: float, articulator: str) -> Articulation | None:
    """What opens of a skin, by the likeliest reading of its sides; ``None`` if nothing is sure.

    Args:
        mesh: metres, z up.
        least: probability below which a part is left fixed, 0 to 1.
        articulator: who is asked.
    """
    if not is_skin(mesh):
        return None
    found = SeamsArticulator().articulate(mesh)
    sure = [
        index
        for index, part in enumerate(found.parts)
        if index > 0 and (part.confidence or 0.0) >= least
    ]
    if not sure:
        return None
    left = np.setdiff1d(np.arange(len(found.parts)), sure)
    base = Part(found.parts[0].name, np.concatenate([found.parts[index].faces for index in left]))
    joints = tuple(
        replace(found.joints[index - 1], child=number) for number, index in enumerate(sure, start=1)
    )
    kept = (base, *(found.parts[index] for index in sure))
    return replace(found, parts=kept, joints=joints, articulator=articulator)


def least_of(trust: Trust, asked: float | None) -> float:
    """The probability below which a part is left fixed."""
    return trust.least if asked is None else asked
