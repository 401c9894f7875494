"""Parts that a trained network sees on the sides of an object."""

from .agreement import load_agreement
from .articulator import DetectedArticulator

__all__ = ["DetectedArticulator", "load_agreement"]
