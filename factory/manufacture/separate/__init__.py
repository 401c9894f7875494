"""Cuts the hulls of neighbouring parts apart, so that engines see a real joint's clearance.

Hulls meet for two reasons. A hull bulges over the dents of the surface it stands for, so hulls may
meet where the parts do not; what decomposition added is taken off again. And parts that a joint
holds (a stem in its socket, a pole in its tube) are often modelled as overlapping
solids; what is hidden there at rest is taken out of the collision geometry, and the report says how
deep it was. Each pair of hulls is cut by a plane, at every sampled pose of the joints that move the
two parts against one another.

What is never cut: parts that penetrate deeper as a joint moves, and parts that overlap
without a joint between them. A cut there would hide a fault of the asset.
"""

from .separate import Separation, SeparationRefusal, separate

__all__ = ["Separation", "SeparationRefusal", "separate"]
