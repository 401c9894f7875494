"""Reads one-piece meshes from their sides: seams, handles, panels, lids."""

from .articulator import SeamsArticulator, articulator_for, readings

__all__ = ["SeamsArticulator", "articulator_for", "readings"]
