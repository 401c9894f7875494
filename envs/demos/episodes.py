"""Which episodes are demonstrated, in which shard each belongs, and what came of one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from asset_factory.factory.runtime.code import code_digest
from asset_factory.factory.runtime.keys import installed_version
from asset_factory.factory.runtime.store import stage_key

from ..assets import RegisteredAsset
from ..solving.attempt import SOLVER
from ..solving.record import UNJUDGED
from ..solving.solve import STEPS

#: Of the layout of what is written.
VERSION = 1
#: What says how an episode is written.
RECORDER = ("asset_factory.envs.demos.recording",)
#: What the bits of a trajectory depend on besides this package.
LIBRARIES = ("mani_skill", "sapien", "mplib", "numpy")
#: The control mode that the solver acts in.
SOLVED_IN = "pd_joint_pos"


@dataclass(frozen=True)
class Settings:
    """What all episodes of one folder share.

    Attributes:
        task: id, e.g. ``OpenJoint-v1``.
        robot: ``panda`` or ``fetch``.
        obs_mode, control_mode: as in ``gymnasium.make``.
        tries: grips that are tried until an episode counts as failed.
        keep_failures: whether the best failed try becomes a trajectory too, its success false.
    """

    task: str = "OpenJoint-v1"
    robot: str = "panda"
    obs_mode: str = "state"
    control_mode: str = SOLVED_IN
    tries: int = 4
    keep_failures: bool = False

    def env_info(self, registry: str) -> dict[str, Any]:
        """Return what ``gymnasium.make(env_id, **env_kwargs)`` takes to make the environment."""
        arguments = {
            "registry": registry,
            "robot_uids": self.robot,
            "control_mode": self.control_mode,
            "obs_mode": self.obs_mode,
            "sim_backend": "physx_cpu",
            "max_episode_steps": STEPS,
        }
        # With the module before it gymnasium imports this package by itself.
        named = f"asset_factory.envs:{self.task}"
        return {"env_id": named, "env_kwargs": arguments, "max_episode_steps": STEPS}


@dataclass(frozen=True)
class Episode:
    """One that is to be demonstrated.

    Attributes:
        asset, digest: which, and the SHA-256 of its manifest.
        joint: to be opened.
        seed: of the reset and of the planner.
    """

    asset: str
    digest: str
    joint: str
    seed: int

    def key(self, settings: Settings) -> str:
        """Return the name of everything that the trajectory depends on."""
        code = code_digest(*SOLVER, *RECORDER)
        libraries = {name: installed_version(name) for name in LIBRARIES}
        return stage_key("episode", code, libraries, settings, self)


@dataclass(frozen=True)
class Shard:
    """Episodes of one asset that lie in one file.

    Attributes:
        name: of the files, without ending.
        episodes: in the order of the file.
    """

    name: str
    episodes: tuple[Episode, ...]

    def key(self, settings: Settings) -> str:
        """Return the name of everything that the file's content depends on."""
        return stage_key("shard", [episode.key(settings) for episode in self.episodes])


@dataclass(frozen=True)
class Taken:
    """What came of an episode.

    Attributes:
        episode: which.
        success: the task's own, after the last action of the trajectory.
        reason, message: why not; empty with success.
        open_fraction: of the joint's range, at the end of the best try.
        steps: control steps of the trajectory, or of the best try if none was kept.
        info: ManiSkill's entry for the trajectory; ``None`` if there is none.
    """

    episode: Episode
    success: bool
    reason: str = ""
    message: str = ""
    open_fraction: float = 0.0
    steps: int = 0
    info: dict[str, Any] | None = None

    @property
    def judged(self) -> bool:
        """Return whether it says something of the joint."""
        return self.reason not in UNJUDGED


def make_shards(
    assets: Iterable[RegisteredAsset], seeds: Sequence[int], size: int
) -> tuple[Shard, ...]:
    """Return every joint of every asset with every seed, in files of at most ``size`` episodes.

    A file holds one asset, and further seeds come last: more assets, and more seeds of the same
    ones, leave full files as they are.
    """
    shards = []
    for asset in assets:
        named = product(seeds, (joint.name for joint in asset.openable))
        wanted = [Episode(asset.id, asset.digest, joint, seed) for seed, joint in named]
        for number, start in enumerate(range(0, len(wanted), size)):
            shards.append(Shard(f"{asset.id}-{number:03d}", tuple(wanted[start : start + size])))
    return tuple(shards)
