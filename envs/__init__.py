"""USE: registry entries as ManiSkill tasks.

Importing this package registers their names with gymnasium and loads nothing else.

==================  ===============================================================================
``OpenDrawer-v1``   open one sliding part
``OpenDoor-v1``     open one hinged part: a door, a lid, a flap
``OpenJoint-v1``    open one part, however it moves
``CloseJoint-v1``   close one part that stands open
``SetJoint-v1``     bring one part to a given opening
==================  ===============================================================================

Either import this package before ``gym.make("OpenJoint-v1", registry=DIR)``, or let gymnasium do
so: ``gym.make("asset_factory.envs:OpenJoint-v1", registry=DIR)``. ManiSkill, SAPIEN and torch are
imported by the first ``gym.make``. ``docs/maniskill.md`` tells the rest.
"""

from importlib import import_module
from typing import Any

from .tasks.catalog import TASKS, Task, register_tasks
from .tasks.processes import make_processes

__all__ = ["TASKS", "Task", "make_processes"]

register_tasks()


def __getattr__(name: str) -> Any:
    """Return the class of a task, e.g. ``OpenJointEnv``, imported when first asked for."""
    for task in TASKS:
        if name == task.class_name:
            return getattr(import_module(f"{__name__}.tasks.{task.module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
