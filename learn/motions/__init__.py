"""Fits the weights of motion evidence, and usual ranges, to objects whose motions are known."""

from .fitting import fit_motions
from .motion_sample import MotionSample, motion_samples
from .writing import motions_text

__all__ = ["MotionSample", "fit_motions", "motion_samples", "motions_text"]
