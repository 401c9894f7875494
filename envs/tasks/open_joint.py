"""``OpenJoint-v1``, ``OpenDoor-v1``, ``OpenDrawer-v1``: open one joint of an asset."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make an environment

from .arguments import check_share
from .catalog import known_to_maniskill
from .joint_task import JointTask


@known_to_maniskill
class OpenJointEnv(JointTask):
    """A robot stands before a closed object and opens one of its joints, however it moves.

    Success: at least ``min_open_frac`` of the joint's range, and the moving link nearly at rest.

    Args:
        min_open_frac: share of the range that counts as open.
        options: see :class:`~asset_factory.envs.tasks.joint_task.JointTask`.
    """

    def __init__(self, *args: Any, min_open_frac: float = 0.9, **options: Any) -> None:
        self.min_open_frac = check_share(type(self).__name__, "min_open_frac", min_open_frac)
        super().__init__(*args, **options)

    def start_and_goal(self, draws: dict[str, torch.Tensor]) -> tuple[torch.Tensor, torch.Tensor]:
        """Return closed as the start, and fully open as the goal."""
        return torch.zeros_like(draws["start"]), torch.ones_like(draws["goal"])

    def at_goal(self, share: torch.Tensor, goal: torch.Tensor) -> torch.Tensor:
        """Open by ``min_open_frac`` of the goal or more."""
        return share >= self.min_open_frac * goal


@known_to_maniskill
class OpenDoorEnv(OpenJointEnv):
    """A robot swings one door, lid or flap open.

    Knobs and dials, which are held close to their axis, do not count.
    """

    joint_types = ("revolute",)
    min_lever = 0.08


@known_to_maniskill
class OpenDrawerEnv(OpenJointEnv):
    """A robot pulls out one drawer, tray or sliding door."""

    joint_types = ("prismatic",)
