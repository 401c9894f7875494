"""``CloseJoint-v1``: close one joint of an asset from a registry that stands open."""

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make an environment

from .arguments import check_share
from .catalog import known_to_maniskill
from .joint_task import JointTask

#: The joint starts open by at least this share of its range.
LEAST_OPEN = 0.5


@known_to_maniskill
class CloseJointEnv(JointTask):
    """A robot stands before an object with one joint open, and closes it.

    Success: open by at most ``max_open_frac`` of the joint's range, and the moving link nearly at
        rest.

    Args:
        max_open_frac: share of the range that still counts as closed.
        options: see :class:`~asset_factory.envs.tasks.joint_task.JointTask`.
    """

    starts = (0.5, 0.75, 1.0)

    def __init__(self, *args: Any, max_open_frac: float = 0.05, **options: Any) -> None:
        self.max_open_frac = check_share(type(self).__name__, "max_open_frac", max_open_frac)
        super().__init__(*args, **options)

    def start_and_goal(self, draws: dict[str, torch.Tensor]) -> tuple[torch.Tensor, torch.Tensor]:
        """Return a start half open or more, and closed as the goal."""
        return LEAST_OPEN + (1.0 - LEAST_OPEN) * draws["start"], torch.zeros_like(draws["goal"])

    def at_goal(self, share: torch.Tensor, goal: torch.Tensor) -> torch.Tensor:
        """Open by no more than ``max_open_frac`` beyond the goal."""
        return share <= goal + self.max_open_frac
