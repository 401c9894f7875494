"""Geometric evidence for motions: given the parts, find the joint that their shapes suggest."""

from .body import Partition
from .guess import NOTHING, Guess
from .motion import Finding, Motion, best_motion

__all__ = ["NOTHING", "Finding", "Guess", "Motion", "Partition", "best_motion"]
