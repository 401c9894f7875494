"""``OpenDrawer-v1``: open one sliding part of an asset from a registry."""

from .catalog import known_to_maniskill
from .open_joint import OpenJointEnv


@known_to_maniskill
class OpenDrawerEnv(OpenJointEnv):
    """A robot pulls out one drawer, tray or sliding door."""

    joint_types = ("prismatic",)
