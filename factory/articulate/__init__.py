"""Mesh -> Articulation: one file per articulator, behind one Protocol."""

from .articulator import Articulator

__all__ = ["Articulator"]
