"""Cutting hulls apart where the parts themselves are apart: what convex decomposition added is taken off again.

A hull bulges over the dents of the surface it stands for, so hulls of neighbouring parts may meet where the parts do
not. Each such pair of hulls is cut by a plane between them, at every sampled pose of the joints that move the two
parts against one another. Where the parts' own solids overlap by more than a tolerance nothing is cut: a cut there
would hide a fault of the asset.
"""

from .separate import Separation, separate

__all__ = ["Separation", "separate"]
