"""Fits the weights of motion evidence, and usual ranges, to objects whose motions are known."""

from .fitting import fit_motions
from .lesson import Lesson, lessons_of
from .writing import motions_text

__all__ = ["Lesson", "fit_motions", "lessons_of", "motions_text"]
