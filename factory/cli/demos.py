"""``factory demos``: what a robot does with registered assets, kept for imitation."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro
from tyro.conf import Positional

from ..registry import Split


@dataclass(frozen=True)
class Demos:
    """Write what a scripted robot does as demonstrations in ManiSkill's layout, for imitation.

    <to>/<asset>-<number>.h5 with its .json holds trajectories of one asset, and <to>/summary.json
    how many there are of each joint, and why not more. The same command again makes only the files
    that are missing.

    Exit codes: 0 every episode was tried; 3 some could not be, and the same command tries them
    again; 2 wrong usage; 1 there is no success and --strict was given.
    """

    to: Path
    """Folder of demonstrations."""
    ids: Positional[tuple[str, ...]] = ()
    """Assets, as `factory list` prints them; all by default."""
    output: Path = Path("out")
    """The registry's folder; the demonstrations refer to it as it is written here."""
    joint: str | None = None
    """Only this joint of each."""
    category: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """Only objects of this category; may be given several times."""
    split: Split | None = None
    """Only assets to train on, or only those to test on."""
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
    """What is observed, as in `gymnasium.make`; none for actions and states of the simulation alone."""
    control_mode: str = "pd_joint_pos"
    """What actions say; the solver's own is pd_joint_pos, from which they are converted."""
    keep_failures: bool = False
    """Keep the best try of a failed episode as a trajectory with success false."""
    strict: bool = False
    """Exit with 1 when no episode succeeded."""


def run(command: Demos) -> int:
    """Make demonstrations; returns the exit code."""
    # Tasks load gymnasium.
    from asset_factory.envs.demos.command import run as demonstrate

    return demonstrate(command)
