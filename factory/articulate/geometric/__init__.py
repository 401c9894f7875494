"""Articulation without learning: connected pieces, panels, handles, boxes, and hinge sweeps."""

from .articulator import GeometricArticulator, articulator_for

__all__ = ["GeometricArticulator", "articulator_for"]
