"""Fits how the evidence for a part's motion weighs, and how far parts go, to objects whose motions are known."""

from .fitting import fit_motions
from .lesson import Lesson, lessons_of
from .writing import motions_text

__all__ = ["Lesson", "fit_motions", "lessons_of", "motions_text"]
