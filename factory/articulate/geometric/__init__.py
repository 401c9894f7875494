"""Articulation without learning: connected pieces, panels, handles, boxes, and a sweep for each hinge."""

from .articulator import GeometricArticulator

__all__ = ["GeometricArticulator", "connected_components"]
