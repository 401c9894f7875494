"""Geometric evidence for motions: given the parts, find the joint that their shapes suggest."""

from .body import Partition
from .guess import NOTHING, Guess
from .motion import MotionEvidence, best_motion

__all__ = ["NOTHING", "Guess", "MotionEvidence", "Partition", "best_motion"]
