"""Baskets of wire behind a door: they slide out, as in a dishwasher."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...articulation import JointKind
from ...mesh import IntArray
from ...part import PartKind
from ..proposal import Motion
from .movers import Mover
from .scene import FRONT, SIDEWAYS, UP, Scene

THIN = 0.03
"""Two sides of a wire are at most this share of the object's diagonal."""
LEAST_WIRES = 12
WIDE = 0.6
DEEP = 0.4
HIGH = 0.04
"""Of the object's sides: what a basket fills at least. A flat grid is a shelf and stays."""
TRAVEL = 0.92
"""Of its depth, as for drawers."""


def find_racks(scene: Scene, doors: tuple[Mover, ...], taken: IntArray) -> tuple[Mover, ...]:
    """Find baskets inside the object behind a door in its front, top to bottom."""
    free = np.ones(len(scene.low), dtype=bool)
    free[taken] = False
    thin = np.sort(scene.extents, axis=1)[:, 1] <= THIN * float(np.linalg.norm(scene.size))
    wires = np.flatnonzero(free & thin)
    if len(wires) < LEAST_WIRES or not doors:
        return ()
    found = []
    for group in _clusters(scene, wires):
        low = scene.low[group].min(axis=0)
        high = scene.high[group].max(axis=0)
        sides = (high - low) / scene.size
        basket = sides[SIDEWAYS] >= WIDE and sides[FRONT] >= DEEP and sides[UP] >= HIGH
        middle = (low + high) / 2.0
        if (
            len(group) < LEAST_WIRES
            or not basket
            or not any(_behind(scene, door, middle) for door in doors)
        ):
            continue
        travel = TRAVEL * float(high[FRONT] - low[FRONT])
        guess = ("is a basket of wire behind a door; how far it slides is assumed",)
        outwards = np.array([0.0, -1.0, 0.0])
        motion = Motion(JointKind.PRISMATIC, outwards, middle, 0.0, travel)
        found.append(Mover(PartKind.RACK, motion, group, guess))
    return tuple(sorted(found, key=lambda m: -float(m.motion.origin[UP])))


def _behind(scene: Scene, door: Mover, point: np.ndarray) -> bool:
    low = scene.low[door.pieces].min(axis=0)
    high = scene.high[door.pieces].max(axis=0)
    across = [SIDEWAYS, UP]
    return bool(
        (low <= point)[across].all() and (point <= high)[across].all() and low[FRONT] < point[FRONT]
    )


def _clusters(scene: Scene, pieces: IntArray) -> list[IntArray]:
    """Return the pieces whose boxes touch, directly or through others."""
    low = scene.low[pieces]
    high = scene.high[pieces]
    hair = scene.touch / 4.0
    touching = np.ones((len(pieces), len(pieces)), dtype=bool)
    for axis in range(3):
        touching &= low[:, None, axis] <= high[None, :, axis] + hair
        touching &= high[:, None, axis] >= low[None, :, axis] - hair
    labels = connected_components(coo_matrix(touching), directed=False)[1]
    return [pieces[labels == k] for k in np.unique(labels)]
