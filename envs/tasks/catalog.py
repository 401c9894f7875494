"""The tasks there are, in one list, and how gymnasium and ManiSkill come to know them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Task:
    """One task.

    Attributes:
        id: what ``gym.make`` takes.
        module: file in this package, without its ending.
        class_name: the environment's class in it.
        max_episode_steps: control steps until an episode is cut off.
    """

    id: str
    module: str
    class_name: str
    max_episode_steps: int = 200


TASKS: tuple[Task, ...] = (
    Task("OpenDrawer-v1", "open_joint", "OpenDrawerEnv"),
    Task("OpenDoor-v1", "open_joint", "OpenDoorEnv"),
    Task("OpenJoint-v1", "open_joint", "OpenJointEnv"),
    Task("CloseJoint-v1", "close_joint", "CloseJointEnv"),
    Task("SetJoint-v1", "set_joint", "SetJointEnv"),
)


def register_tasks() -> None:
    """Register the names with gymnasium, if installed; a task's module loads when one is made."""
    try:
        import gymnasium
        from gymnasium.envs.registration import WrapperSpec
    except ImportError:
        return
    for task in TASKS:
        if task.id in gymnasium.registry:
            continue
        # As ManiSkill's own decorator does: its checker refuses batched tensors, its time limit
        # counts them.
        wrapper = "mani_skill.utils.registration:TimeLimitWrapper"
        steps = {"max_episode_steps": task.max_episode_steps}
        limit = WrapperSpec("MSTimeLimit", wrapper, steps)
        gymnasium.register(
            task.id,
            entry_point=f"{__package__}.{task.module}:{task.class_name}",
            max_episode_steps=task.max_episode_steps,
            disable_env_checker=True,
            additional_wrappers=(limit,),
        )


def known_to_maniskill(environment: type[Any]) -> type[Any]:
    """List a task's class, as its decorator, where ManiSkill's tools look for it."""
    from mani_skill.utils.registration import REGISTERED_ENVS, register

    task = next(task for task in TASKS if task.class_name == environment.__name__)
    if task.id not in REGISTERED_ENVS:
        register(task.id, environment, max_episode_steps=task.max_episode_steps)
    return environment
