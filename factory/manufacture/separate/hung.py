"""Whether a joint turns its part as people hang doors, knobs and lids, or slides it straight."""

from __future__ import annotations

import numpy as np

from ...articulation import Joint
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..hinges import is_crooked
from .budget import SeenSurface

#: A part that reaches beyond its axis by this share of its reach turns about its middle.
MIDDLE_SHARE = 0.5


def well_hung(surface: SeenSurface | None, joint: Joint, config: SeparateConfig) -> bool:
    """Whether a joint runs straight, and turns its part about an edge or its middle.

    Args:
        surface: of the part that it moves; ``None`` for a carrier.
        joint: to be looked at.
        config: how far beyond its axis a part that hangs at an edge may reach.
    """
    if is_crooked(joint.axis):
        return False
    return not joint.turns or at_an_edge(surface, joint, config) or about_its_middle(surface, joint)


def at_an_edge(surface: SeenSurface | None, joint: Joint, config: SeparateConfig) -> bool:
    """Whether a part reaches to its axis, and no further beyond it than may be planed off."""
    if surface is None:
        return False
    arms = _arms(surface, joint)
    near = max(float(np.linalg.norm(arms, axis=1).min()), _reach(arms)[1])
    return near <= planed_limit(config, surface.diagonal)


def about_its_middle(surface: SeenSurface | None, joint: Joint) -> bool:
    """Whether a part reaches about as far to one side of its axis as to the other."""
    if surface is None:
        return True
    ahead, behind = _reach(_arms(surface, joint))
    return behind > MIDDLE_SHARE * ahead


def planed_limit(config: SeparateConfig, diagonal: float) -> float:
    """How much may be planed off a part of this diagonal [m], in [m]."""
    return max(config.tolerance_m, min(config.planed_m, config.planed_share * diagonal))


def _arms(surface: SeenSurface, joint: Joint) -> FloatArray:
    """From a joint's axis to each point of a surface, across the axis [m], shape [n, 3]."""
    arms = surface.points - joint.origin
    return np.asarray(arms - np.outer(arms @ joint.axis, joint.axis))


def _reach(arms: FloatArray) -> tuple[float, float]:
    """How far from an axis points reach towards their middle [m], and how far beyond the axis."""
    middle = (arms.min(axis=0) + arms.max(axis=0)) / 2.0
    along = arms @ middle / max(float(np.linalg.norm(middle)), 1e-9)
    return float(along.max()), -float(along.min())
