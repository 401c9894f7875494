"""``factory solve``: a robot opens the joints of registered assets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import Exit, RegistryError
from ..runtime.layout import SOLVING
from ..runtime.terminal import complain, say
from .flags import AssetIds, check_effort, require_maniskill

if TYPE_CHECKING:
    from asset_factory.envs.assets import OpenableJoint, RegisteredAsset
    from asset_factory.envs.solving.attempt import Attempt

ROBOTS = ("panda", "fetch")


@dataclass(frozen=True)
class Solve:
    """Have a robot open the joints of registered assets; say which it could, and with what force.

    What was found is in <output>/solving/<id>.json, and whether one joint was opened in the
    registry, as `solved`. The same command again does only what is missing.

    Exit codes: 0 every joint was tried; 3 some could not be; 2 wrong usage; 1 some asset has no
    joint that was opened and --strict was given.

    Example: factory solve --output out/ --seed 0
    """

    ids: AssetIds = ()
    """Assets, as `factory list` prints them, or their beginnings; all by default."""
    output: Path = Path("out")
    """The registry's folder."""
    joint: str | None = None
    """Only this joint of each."""
    robot: Literal["panda", "fetch", "any"] = "any"
    """Who tries; of any, Fetch tries what Panda could not open."""
    workers: int = 1
    """Joints tried at once."""
    seed: int = 0
    """Seed of the episodes: where the robot stands, within 2 cm, and how it plans."""
    tries: int = 4
    """Episodes per joint and robot, each with other grips."""
    timeout: float = 300.0
    """Longest that one joint may take a robot [s]."""
    video: bool = False
    """Film solved joints: <output>/solving/<id>-<joint>-<robot>.mp4, and on the asset's page."""
    strict: bool = False
    """Exit with 1 when some asset has no joint that was opened."""


def run(command: Solve) -> int:
    """Solve; returns the exit code."""
    from asset_factory.envs.assets import read_registry
    from asset_factory.envs.solving.printing import print_table, show_attempt
    from asset_factory.envs.solving.record import UNJUDGED, SolveRecord, read_record, write_record

    from ..registry import Registry
    from ..report.pages import require_libraries
    from .report import report_after

    check_effort(command, ("workers", "tries"))
    require_maniskill("solving wants")
    if command.video:
        require_libraries("--video: the report")
    registry = Registry(command.output)
    assets = _wanted(read_registry(command.output), command)
    records: dict[str, SolveRecord] = {}
    for asset in assets.values():
        records[asset.id] = read_record(command.output, asset.id, asset.digest)
    for robot in ROBOTS if command.robot == "any" else (command.robot,):
        missing = [
            (asset.id, joint.name)
            for asset in assets.values()
            for joint in _joints(asset, command)
            if records[asset.id].wants(joint.name, robot, command.seed, command.tries)
            or (
                # A film is taken of the actions, which no record keeps.
                command.video
                and records[asset.id].is_solved(joint.name, robot)
                and not _film_path(command, asset.id, joint.name, robot).exists()
            )
        ]
        for number, attempt in enumerate(_attempts(command, missing, robot), start=1):
            records[attempt.asset] = records[attempt.asset].noting(attempt, command.tries)
            write_record(command.output, records[attempt.asset])
            show_attempt(number, len(missing), attempt)
    for asset in assets.values():
        verdict = records[asset.id].verdict([joint.name for joint in asset.openable])
        if verdict:
            registry.note(asset.id, solved=verdict)
    shown = {}
    for asset in assets.values():
        shown[asset.id] = records[asset.id].of([joint.name for joint in _joints(asset, command)])
    if command.video:
        report_after(command.output, command.workers)
    print_table(shown)
    solved = sum(any(row["solved"] for row in rows) for rows in shown.values())
    say(f"{solved} of {len(shown)} assets have at least one solved joint")
    if any(row["reason"] in UNJUDGED for rows in shown.values() for row in rows):
        return Exit.UNJUDGED
    return Exit.REJECTED if command.strict and solved < len(shown) else Exit.OK


def _wanted(assets: dict[str, RegisteredAsset], command: Solve) -> dict[str, RegisteredAsset]:
    """Return the assets that the flags name. Raises RegistryError naming those there are."""
    from asset_factory.envs.assets import listed, named

    wanted = named(assets, command.ids, command.output)
    if command.joint is not None:
        for asset in wanted.values() if command.ids else ():
            asset.joint(command.joint)
        wanted = {id: asset for id, asset in wanted.items() if _joints(asset, command)}
        if not wanted:
            names = sorted({joint.name for asset in assets.values() for joint in asset.openable})
            there = f"there are {listed(names)}"
            raise RegistryError(f"no joint {command.joint!r} in {command.output}; {there}")
    return wanted


def _joints(asset: RegisteredAsset, command: Solve) -> list[OpenableJoint]:
    return [joint for joint in asset.openable if command.joint in (None, joint.name)]


def _attempts(command: Solve, missing: list[tuple[str, str]], robot: str) -> Iterator[Attempt]:
    """Try joints, given with their assets, in processes that may die."""
    from asset_factory.envs.solving.solve import SolveTask, answered, attempted
    from asset_factory.sim_checks.processes.isolation import Limits

    from ..jobs import LocalExecutor
    from ..jobs.executor import Call

    how = (robot, command.seed, command.tries)
    tasks = [SolveTask(str(command.output), id, joint, *how) for id, joint in missing]
    calls = [Call(f"{task.asset_id} {task.joint}", {"task": task}) for task in tasks]
    limits = Limits(wall_s=command.timeout)
    for call, outcome in LocalExecutor(command.workers, retries=0).run(attempted, calls, limits):
        attempt = answered(outcome, call.arguments["task"])
        if command.video and attempt.solved:
            _film(command, attempt)
        yield attempt


def _film(command: Solve, attempt: Attempt) -> None:
    """Write a video, or say why there is none."""
    from asset_factory.envs.solving.film import LONGEST_S, film
    from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

    path = _film_path(command, attempt.asset, attempt.joint, attempt.robot)
    part = path.with_name(f".{path.name}")
    arguments = str(command.output), attempt, part
    outcome = run_isolated(film, *arguments, limits=Limits(wall_s=LONGEST_S))
    if outcome.failure is None:
        part.replace(path)
        return
    part.unlink(missing_ok=True)
    complain(f"no video of {attempt.asset} {attempt.joint}: {outcome.detail}")


def _film_path(command: Solve, asset: str, joint: str, robot: str) -> Path:
    return command.output / SOLVING / f"{asset}-{joint}-{robot}.mp4"
