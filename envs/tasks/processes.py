"""Many environments on a CPU: one process each, since PhysX simulates one scene per process."""

from __future__ import annotations

from functools import partial
from typing import Any


def make_processes(task_id: str, count: int, **options: Any) -> Any:
    """Make an ``AsyncVectorEnv`` of gymnasium's, of ``count`` environments with numpy observations.

    ``reset(seed=s)`` seeds environment i with ``s + i``, and each then behaves as a single
    environment with that seed.

    Args:
        task_id: one of :data:`~asset_factory.envs.TASKS`.
        count: how many processes.
        options: for ``gym.make``: ``registry`` and whatever else the task takes.
    """
    from gymnasium.vector import AsyncVectorEnv

    return AsyncVectorEnv([partial(_made_here, task_id, options)] * count)


def _made_here(task_id: str, options: dict[str, Any]) -> Any:
    """Return one environment, in the process that asks."""
    import gymnasium
    from mani_skill.utils.wrappers.gymnasium import CPUGymWrapper

    return CPUGymWrapper(gymnasium.make(f"asset_factory.envs:{task_id}", **options))
