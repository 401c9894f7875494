"""What ``factory demos`` does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from asset_factory.factory.cli.demos import Demos
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.runtime import exits

from ..tasks.arguments import check_effort

if TYPE_CHECKING:
    from ..assets import RegisteredAsset
    from .episodes import Settings

#: Control modes that joint targets can be converted to, and the solver's own.
CONTROL_MODES = (
    "pd_joint_pos",
    "pd_joint_delta_pos",
    "pd_joint_target_delta_pos",
    "pd_ee_delta_pose",
    "pd_ee_target_delta_pose",
    "pd_ee_pose",
)


def run(command: Demos) -> int:
    """Make demonstrations; returns the exit code."""
    from asset_factory.factory.runtime.store import write_json

    from .episodes import make_shards
    from .folder import hold
    from .making import Making
    from .printing import print_summary, sum_up

    settings = _settings(command)
    assets = _wanted(command)
    shards = make_shards(
        assets, range(command.seed, command.seed + command.per_joint), command.shard_size
    )
    with hold(command.to, settings, shards):
        making = Making(str(command.output), command.to, settings, command.workers, command.timeout)
        found = dict(making.run(shards))
        taken = [each for shard in shards for each in found[shard]]
        summary = sum_up(taken, settings)
        write_json(command.to / "summary.json", summary)
    print_summary(summary)
    counts = f"{summary['successes']} of {summary['episodes']} episodes succeeded"
    print(f"{counts}, {summary['trajectories']} trajectories in {command.to}")
    if not all(each.judged for each in taken):
        return exits.UNJUDGED
    return exits.REJECTED if command.strict and not summary["successes"] else exits.OK


def _settings(command: Demos) -> Settings:
    """How all episodes are made. Raises ConfigError for what cannot be."""
    from .episodes import Settings

    check_effort(command, ("per_joint", "shard_size", "workers", "tries"))
    if command.control_mode not in CONTROL_MODES:
        raise ConfigError(
            f"--control-mode: no {command.control_mode!r}; want one of {', '.join(CONTROL_MODES)}"
        )
    if command.robot == "fetch" and command.control_mode == "pd_ee_pose":
        raise ConfigError("--control-mode: Fetch has no 'pd_ee_pose'; want pd_ee_delta_pose")
    try:
        import h5py  # noqa: F401
        import mani_skill  # noqa: F401
    except ImportError as error:
        raise ConfigError(
            f"demonstrations want ManiSkill ({error}); pip install 'asset-factory[maniskill]'"
        ) from error
    return Settings(
        command.task,
        command.robot,
        command.obs_mode,
        command.control_mode,
        command.tries,
        command.keep_failures,
    )


def _wanted(command: Demos) -> list[RegisteredAsset]:
    """The assets that the flags leave, each with the joints that they leave, by id. Raises what they have wrong."""
    from asset_factory import envs

    from ..assets import named, read_registry
    from ..selection import Wanted, select
    from ..tasks.catalog import TASKS

    assets = read_registry(command.output)
    assets = named(assets, command.ids, command.output)
    task = getattr(envs, next(task.class_name for task in TASKS if task.id == command.task))
    wanted = Wanted(
        joint=command.joint,
        categories=command.category,
        joint_types=task.joint_types,
        split=command.split,
        min_lever=task.min_lever,
    )
    return list(select(assets, wanted).values())
