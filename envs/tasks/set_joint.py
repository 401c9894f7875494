"""``SetJoint-v1``: bring one joint of an asset from a registry to a given opening."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make an environment

from .arguments import check_share
from .catalog import known_to_maniskill
from .joint_task import JointTask

#: Start and goal are at least this share of the range apart.
LEAST_WAY = 0.2


@known_to_maniskill
class SetJointEnv(JointTask):
    """A robot brings a joint from anywhere to the observation's ``goal_fraction``.

    Success: within ``tolerance`` of the goal, and the moving link nearly at rest.
    ``reset(options={"goal": 0.4})`` decides for one episode.

    Args:
        tolerance: share of the joint's range.
        options: see :class:`~asset_factory.envs.tasks.joint_task.JointTask`.
    """

    starts = (0.0, 0.25, 0.5, 0.75, 1.0)

    def __init__(self, *args: Any, tolerance: float = 0.05, **options: Any) -> None:
        self.tolerance = check_share(type(self).__name__, "tolerance", tolerance)
        super().__init__(*args, **options)

    def start_and_goal(self, draws: dict[str, torch.Tensor]) -> tuple[torch.Tensor, torch.Tensor]:
        """Start anywhere; the goal uniform at least ``LEAST_WAY`` away."""
        start = draws["start"]
        below = (start - LEAST_WAY).clamp(min=0.0)
        above = (1.0 - LEAST_WAY - start).clamp(min=0.0)
        along = draws["goal"] * (below + above)
        return start, torch.where(along < below, along, start + LEAST_WAY + along - below)

    def at_goal(self, share: torch.Tensor, goal: torch.Tensor) -> torch.Tensor:
        """Tell whether it is within ``tolerance``."""
        return (share - goal).abs() <= self.tolerance
