"""``factory solve``: a robot opens the joints of registered assets."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class Solve:
    """Have a robot open the joints of registered assets, and say which it could open and with what force.

    What was found is in <output>/solving/<id>.json, and whether one joint was opened in the
    registry, as `solved`. The same command again does only what is missing.

    Exit codes: 0 every joint was tried; 3 some could not be; 2 wrong usage; 1 some asset has no
    joint that was opened and --strict was given.
    """

    ids: Positional[tuple[str, ...]] = ()
    """Assets, as `factory list` prints them; all by default."""
    output: Path = Path("out")
    """The registry's folder."""
    joint: str | None = None
    """Only this joint of each."""
    robot: str = "any"
    """panda, fetch, or any: Fetch tries what Panda could not open."""
    workers: int = 1
    """Joints tried at once."""
    seed: int = 0
    """Of the episodes: where the robot stands, within 2 cm, and how it plans."""
    tries: int = 4
    """Episodes per joint and robot, each with other grips."""
    timeout: float = 300.0
    """Longest that one joint may take a robot [s]."""
    video: bool = False
    """Write <output>/solving/<id>-<joint>-<robot>.mp4 of what is solved; wants Vulkan."""
    strict: bool = False
    """Exit with 1 when some asset has no joint that was opened."""


def run(command: Solve) -> int:
    """Solve; returns the exit code."""
    # Tasks load gymnasium.
    from asset_factory.envs.solving.command import run as solve

    return solve(command)
