"""Automatic articulation: network predictions from several sides, shape rules and evidence."""

from .articulator import AutoArticulator, articulator_for, load_auto

__all__ = ["AutoArticulator", "articulator_for", "load_auto"]
