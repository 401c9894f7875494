"""ManiSkill's replay tool on our demonstrations.

    python -m asset_factory.envs.demos.replay --traj-path FILE.h5

Takes that tool's own flags, of ``python -m mani_skill.trajectory.replay_trajectory``, and besides
``--registry DIR``, for a registry that has moved since. What differs: no renderer is asked for
unless pictures are wanted, tasks are found in files that the tool itself wrote, and ``-c
pd_ee_...`` works for a robot that does not look along x.
"""

from __future__ import annotations

import multiprocessing
import sys
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ..loading import replaced
from ..tasks.arguments import BLIND_MODES
from ..tasks.catalog import TASKS
from .converting import to_hand_poses


def replay(arguments: Sequence[str]) -> None:
    """Replay; ``arguments`` are those of the command line.

    Raises:
        SystemExit: wrong usage.
    """
    from mani_skill.trajectory import replay_trajectory as tool

    own = ArgumentParser(add_help=False, allow_abbrev=False)
    own.add_argument("--registry")
    told, rest = own.parse_known_args(arguments)
    wanted = tool.parse_args(rest)
    if not (wanted.save_video or wanted.vis) and wanted.obs_mode in (None, *BLIND_MODES):
        wanted.render_mode = None
    if wanted.num_envs > 1 and "ee" in (wanted.target_control_mode or ""):
        mode = f"--target-control-mode {wanted.target_control_mode}"
        own.error(f"--num-envs must be 1 with {mode}, not {wanted.num_envs}")
    with _told(told.registry):
        tool.main(wanted)


@contextmanager
def _told(registry: str | None) -> Iterator[None]:
    """Tell the tool, within this, where the registry is and which package a task belongs to."""
    from mani_skill.trajectory.utils.actions import conversion
    from mani_skill.utils import io_utils

    load = io_utils.load_json

    def told(filename: Any) -> Any:
        data = load(filename)
        info = data["env_info"]
        if info["env_id"] in {task.id for task in TASKS}:
            info["env_id"] = f"asset_factory.envs:{info['env_id']}"
        if registry is not None:
            info["env_kwargs"]["registry"] = registry
        # Its recorder leaves out what limits an episode.
        info["env_kwargs"].setdefault("max_episode_steps", info["max_episode_steps"])
        return data

    with (
        replaced(io_utils, "load_json", told),
        replaced(conversion, "from_pd_joint_pos_to_ee", to_hand_poses),
    ):
        yield


if __name__ == "__main__":
    # As ManiSkill's tool does, whose processes cannot be forked.
    multiprocessing.set_start_method("spawn")
    replay(sys.argv[1:])
