"""A parallel gripper, as coarse as a hand has to be to fit all of them."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot


@dataclass(frozen=True)
class Gripper:
    """Two fingers that close on each other, before a palm; after the hands of Panda, Fetch [m].

    Attributes:
        opening: widest gap between the fingers that counts fully: Panda's.
        widest: widest gap of any of the hands: Fetch's.
        play: left on each side of a grasped part while the hand comes near.
        finger_width: of a finger, across the direction in which they close.
        finger_thickness: of a finger, along it.
        depths: how far fingertips reach behind the point that they take hold at, best first; and
            what each is worth beside the best.
        finger_length: from fingertip to palm.
        palm: half its size along the closing direction, and across it.
        palm_depth: of the palm, away from the object.
        gaps: free space behind an edge that a finger hooks, best first; worth as of ``depths``.
        off: how far from a surface a finger is that lies against it.
        arm: half the width of what follows the palm.
        arm_reach: how far from the point the way out of the object is looked at.
    """

    opening: float = 0.08
    widest: float = 0.10
    play: float = 0.003
    finger_width: float = 0.02
    finger_thickness: float = 0.012
    depths: tuple[tuple[float, float], ...] = ((0.02, 1.0), (0.014, 0.85), (0.008, 0.65))
    finger_length: float = 0.045
    palm: tuple[float, float] = (0.10, 0.03)
    palm_depth: float = 0.08
    gaps: tuple[tuple[float, float], ...] = ((0.02, 1.0), (0.012, 0.7))
    off: float = 0.0005
    arm: float = 0.04
    arm_reach: float = 1.0

    @property
    def length(self) -> float:
        """Return how far it reaches back from its fingertips [m]."""
        return self.finger_length + self.palm_depth

    @property
    def reach(self) -> float:
        """Return the distance from the fingertips within which all of it lies [m]."""
        return hypot(*self.palm, self.length)


GRIPPER = Gripper()
