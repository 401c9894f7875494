"""Parts that somebody states, found on the mesh: exact outlines, thickness, hinges and limits."""

from .articulator import StatedArticulator

__all__ = ["StatedArticulator"]
