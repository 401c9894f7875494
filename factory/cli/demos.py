"""``factory demos``: what a robot does with registered assets, kept for imitation."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..registry.where import wanted
from ..runtime.terminal import say
from .flags import AssetIds, check_effort, require_maniskill, require_writable

if TYPE_CHECKING:
    from asset_factory.envs.assets import RegisteredAsset
    from asset_factory.envs.demos.episodes import Settings

#: Control modes that joint targets can be converted to, and the solver's own.
ControlMode = Literal[
    "pd_joint_pos",
    "pd_joint_delta_pos",
    "pd_joint_target_delta_pos",
    "pd_ee_delta_pose",
    "pd_ee_target_delta_pose",
    "pd_ee_pose",
]


@dataclass(frozen=True)
class Demos:
    """Record a scripted robot's demonstrations, in ManiSkill's layout.

    <to>/<asset>-<number>.h5 with its .json holds trajectories of one asset, and <to>/summary.json
    how many there are of each joint, and why not more. The same command again makes only the files
    that are missing.

    Exit codes: 0 every episode was tried; 3 some could not be, and the same command tries them
    again; 2 wrong usage; 1 there is no success and --strict was given.

    Example: factory demos --output out/ --to demos/
    """

    to: Path
    """Folder of demonstrations."""
    ids: AssetIds = ()
    """Assets, as `factory list` prints them; all by default."""
    output: Path = Path("out")
    """The registry's folder; the demonstrations refer to it as it is written here."""
    joint: str | None = None
    """Only this joint of each."""
    where: str = ""
    """Only assets that meet conditions, such as "category = fridge and split = train"."""
    task: Literal["OpenJoint-v1", "OpenDoor-v1", "OpenDrawer-v1"] = "OpenJoint-v1"
    """What is demonstrated; doors are hinged parts, drawers sliding ones."""
    robot: Literal["panda", "fetch"] = "panda"
    """Who does it."""
    per_joint: int = 4
    """Episodes of each joint, one per seed."""
    seed: int = 0
    """The first seed: of where the robot stands, within 2 cm, and of how it plans."""
    tries: int = 4
    """Grips that are tried until an episode counts as failed."""
    shard_size: int = 50
    """Most episodes in one file."""
    workers: int = 1
    """Episodes made at once."""
    timeout: float = 600.0
    """Longest that one episode may take [s]."""
    obs_mode: str = "state"
    """What is observed, as in `gymnasium.make`; none for the simulation's actions and states."""
    control_mode: ControlMode = "pd_joint_pos"
    """What actions say; the solver's own is pd_joint_pos, from which they are converted."""
    keep_failures: bool = False
    """Keep the best try of a failed episode as a trajectory with success false."""
    strict: bool = False
    """Exit with 1 when no episode succeeded."""


def run(command: Demos) -> int:
    """Make demonstrations; returns the exit code."""
    from asset_factory.envs.demos.episodes import make_shards
    from asset_factory.envs.demos.folder import hold
    from asset_factory.envs.demos.making import Making
    from asset_factory.envs.demos.printing import print_summary, sum_up

    from ..runtime.store import write_json

    settings = _settings(command)
    assets = _wanted(command)
    seeds = range(command.seed, command.seed + command.per_joint)
    shards = make_shards(assets, seeds, command.shard_size)
    require_writable(command.to, "--to")
    with hold(command.to, settings, shards):
        making = Making(str(command.output), command.to, settings, command.workers, command.timeout)
        found = dict(making.run(shards))
        taken = [each for shard in shards for each in found[shard]]
        summary = sum_up(taken, settings)
        write_json(command.to / "summary.json", summary)
    print_summary(summary)
    counts = f"{summary['successes']} of {summary['episodes']} episodes succeeded"
    say(f"{counts}, {summary['trajectories']} trajectories in {command.to}")
    if not all(each.judged for each in taken):
        return Exit.UNJUDGED
    return Exit.REJECTED if command.strict and not summary["successes"] else Exit.OK


def _settings(command: Demos) -> Settings:
    """Return how all episodes are made. Raises ConfigError for what cannot be."""
    from asset_factory.envs.demos.episodes import Settings

    check_effort(command, ("per_joint", "shard_size", "workers", "tries"))
    if command.robot == "fetch" and command.control_mode == "pd_ee_pose":
        raise ConfigError("--control-mode: Fetch has no 'pd_ee_pose'; want pd_ee_delta_pose")
    require_maniskill("demonstrations want", "h5py")
    from mani_skill.envs.utils.observations import parse_obs_mode_to_struct

    try:
        parse_obs_mode_to_struct(command.obs_mode)
    except AssertionError as error:
        # It would be told at the first episode.
        want = "want state, state_dict, none, or pictures such as rgb+depth"
        raise ConfigError(f"--obs-mode: no {command.obs_mode!r}; {want}") from error
    modes = (command.obs_mode, command.control_mode)
    return Settings(command.task, command.robot, *modes, command.tries, command.keep_failures)


def _wanted(command: Demos) -> list[RegisteredAsset]:
    """Select assets and their joints, by id; raises what the flags have wrong."""
    from asset_factory import envs
    from asset_factory.envs.assets import named, read_registry
    from asset_factory.envs.selection import Wanted, select
    from asset_factory.envs.tasks.catalog import TASKS

    assets = read_registry(command.output)
    ids = command.ids
    if command.where:
        registry = Registry(command.output)
        found = {entry.id for entry in registry.walk(wanted(registry, command.where))}
        ids = tuple(id for id in (ids or assets) if id in found)
        if not ids:
            raise ConfigError(f"--where: none of these assets has {command.where}")
    assets = named(assets, ids, command.output)
    task = getattr(envs, next(task.class_name for task in TASKS if task.id == command.task))
    asked = Wanted(joint=command.joint, joint_types=task.joint_types, min_lever=task.min_lever)
    return list(select(assets, asked).values())
