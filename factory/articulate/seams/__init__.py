"""Reads one-piece meshes from their sides: seams, handles, panels, lids."""

from .articulator import SeamsArticulator, articulator_for

__all__ = ["SeamsArticulator", "articulator_for"]
