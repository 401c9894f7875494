"""Geometric evidence for motions: given the parts, find the joint that their shapes suggest."""

from .body import Partition
from .guess import NOTHING, Guess
from .motion import JointMotion, MotionEvidence, best_motion

__all__ = ["NOTHING", "Guess", "JointMotion", "MotionEvidence", "Partition", "best_motion"]
