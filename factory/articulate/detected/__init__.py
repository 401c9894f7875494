"""Parts that a trained network sees on the sides of an object."""

from .articulator import DetectedArticulator

__all__ = ["DetectedArticulator"]
