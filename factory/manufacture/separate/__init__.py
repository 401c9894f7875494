"""Cuts the hulls of neighbouring parts apart, so that engines see a real joint's clearance.

Hulls meet for three reasons. A hull bulges over the dents of the surface it stands for, so hulls
may meet where the parts do not; what decomposition added is taken off again. Parts that a joint
holds (a stem in its socket, a pole in its tube) are often modelled as overlapping solids; the
hidden share is taken out of the collision geometry, and the report says how deep it was.
And doors are modelled without the room that their edge needs to turn, or overlapping their
neighbour; that is cut back in the collision geometry within a budget, and the report says how much.
Each pair of hulls is cut by planes, at every sampled pose of the joints that move the two parts
against one another, and along slides between them. A part deep in a solid body turns or is pressed
in a pit there.

Never cut: parts that a joint hits away from its hinge, and more than a joiner would take off.
A cut there would hide a fault of the asset.
"""

from .separate import Separation, SeparationRefusal, separate

__all__ = ["Separation", "SeparationRefusal", "separate"]
