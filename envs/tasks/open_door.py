"""``OpenDoor-v1``: open one hinged part of an asset from a registry."""

from .catalog import known_to_maniskill
from .open_joint import OpenJointEnv


@known_to_maniskill
class OpenDoorEnv(OpenJointEnv):
    """A robot swings one door, lid or flap open.

    Knobs and dials, which are held close to their axis, do not count.
    """

    joint_types = ("revolute",)
    min_lever = 0.08
