"""USE: registry entries as ManiSkill tasks. Importing this registers them with gymnasium.

========================  =========================================================================
``OpenJoint-v1``          a robot opens one door, drawer or lid of an asset from a registry
========================  =========================================================================

Either import this package before ``gym.make("OpenJoint-v1", registry=DIR)``, or let gymnasium do so:
``gym.make("asset_factory.envs:OpenJoint-v1", registry=DIR)``.
"""

from .open_joint import OpenJointEnv

__all__ = ["OpenJointEnv"]
