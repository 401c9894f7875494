"""Geometric evidence for motions: given parts, find the joint that the shapes themselves speak for."""

from .body import Partition
from .guess import NOTHING, Guess
from .motion import Finding, Motion, best_motion

__all__ = ["NOTHING", "Finding", "Guess", "Motion", "Partition", "best_motion"]
