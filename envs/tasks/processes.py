"""Many environments on a CPU: one process each, since PhysX simulates one scene per process."""

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

    return AsyncVectorEnv([_Maker(task_id, options) for _ in range(count)])


class _Maker:
    """What each process calls; a class, so that it can be pickled."""

    def __init__(self, task_id: str, options: dict[str, Any]) -> None:
        self.task_id = task_id
        self.options = options

    def __call__(self) -> Any:
        import gymnasium
        from mani_skill.utils.wrappers.gymnasium import CPUGymWrapper

        return CPUGymWrapper(gymnasium.make(f"asset_factory.envs:{self.task_id}", **self.options))
