"""Articulation by everybody who has something to say: a network from several sides, rules of shape, and evidence."""

from .articulator import AutoArticulator, load_auto

__all__ = ["AutoArticulator", "load_auto"]
