"""Baskets of wire behind a door: they slide out, as in a dishwasher."""

from __future__ import annotations

import numpy as np

from ...articulation import JointKind
from ...mesh import IntArray
from ...part import PartKind
from ..proposal import Motion
from .movers import DRAWER_SHARE, Mover
from .scene import FRONT, RECT, SIDEWAYS, UP, Scene

THIN = 0.03
"""Two sides of a wire are at most this share of the object's diagonal."""
LEAST_WIRES = 12
WIDE = 0.6
DEEP = 0.4
HIGH = 0.04
"""Of the object's sides: what a basket fills at least. A flat grid is a shelf and stays."""


def find_racks(scene: Scene, doors: tuple[Mover, ...], taken: IntArray) -> tuple[Mover, ...]:
    """Find baskets inside the object behind a door in its front, top to bottom."""
    free = np.ones(len(scene.low), dtype=bool)
    free[taken] = False
    thin = np.sort(scene.extents, axis=1)[:, 1] <= THIN * float(np.linalg.norm(scene.size))
    wires = np.flatnonzero(free & thin)
    if len(wires) < LEAST_WIRES or not doors:
        return ()
    found = []
    labels = scene.label_touching(wires, scene.touch / 4.0)
    for group in (wires[labels == label] for label in np.unique(labels)):
        low, high = scene.box_of(group)
        sides = (high - low) / scene.size
        basket = sides[SIDEWAYS] >= WIDE and sides[FRONT] >= DEEP and sides[UP] >= HIGH
        middle = (low + high) / 2.0
        if (
            len(group) < LEAST_WIRES
            or not basket
            or not any(_behind(scene, door, middle) for door in doors)
        ):
            continue
        travel = DRAWER_SHARE * float(high[FRONT] - low[FRONT])
        guess = ("is a basket of wire behind a door; how far it slides is assumed",)
        outwards = np.array([0.0, -1.0, 0.0])
        motion = Motion(JointKind.PRISMATIC, outwards, middle, 0.0, travel)
        found.append(Mover(PartKind.RACK, motion, group, guess))
    return tuple(sorted(found, key=lambda m: -float(m.motion.origin[UP])))


def _behind(scene: Scene, door: Mover, point: np.ndarray) -> bool:
    low, high = scene.box_of(door.pieces)
    across = (low <= point) & (point <= high)
    return bool(across[RECT].all() and low[FRONT] < point[FRONT])
