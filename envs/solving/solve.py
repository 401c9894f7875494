"""Whether a robot opens a joint: scripted episodes of ``OpenJoint-v1`` until one is solved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.sim_checks.processes.isolation import (
    Failure,
    Limits,
    Outcome,
    WarmChild,
    run_isolated,
)

from ..assets import listed, read_registry
from ..robots import ROBOTS
from .attempt import Attempt

#: The task and what it is made with; another registry and robot are all that changes.
TASK = "asset_factory.envs:OpenJoint-v1"
STEPS = 600
#: Episodes for one joint.
TRIES = 4
#: Longest that one joint may take [s].
TIMEOUT_S = 300.0


@dataclass(frozen=True)
class SolveTask:
    """What a child is asked to open: see :func:`solve_joint`."""

    registry: str
    asset_id: str
    joint: str
    robot: str
    seed: int
    tries: int


def solve_joint(
    registry: str | Path,
    asset_id: str,
    joint: str,
    *,
    robot: str = "panda",
    seed: int = 0,
    tries: int = TRIES,
    timeout_s: float = TIMEOUT_S,
    child: WarmChild | None = None,
) -> Attempt:
    """Have a robot open a joint of a registered asset, in a process of its own.

    Args:
        registry: folder that ``factory build --output`` wrote.
        asset_id: what to open,
        joint: and which part of it.
        robot: ``panda`` or ``fetch``.
        seed: of the episode: where the robot stands, and how it plans.
        tries: episodes, each with other grips, until one is solved.
        timeout_s: for all of them [s].
        child: process to use, for many calls one after the other; ``None`` starts one.

    Returns:
        The solved episode, or the one that got farthest. It depends on the arguments alone, but for
        ``seconds`` and where time ran out.

    Raises:
        RegistryError: no such registry, asset or joint.
        ConfigError: no such robot.
    """
    _require_there(registry, asset_id, joint, robot)
    task = SolveTask(str(registry), asset_id, joint, robot, seed, tries)
    ask = run_isolated if child is None else child.call
    return answered(ask(attempted, task, limits=Limits(wall_s=timeout_s)), task)


def answered(outcome: Outcome[Attempt], task: SolveTask) -> Attempt:
    """Return what a child running :func:`attempted` said, or how it failed.

    Raises what the user got wrong.
    """
    if outcome.failure is None:
        return replace(outcome.unwrap(), seconds=outcome.seconds)
    if isinstance(outcome.error, (ConfigError, RegistryError)):
        raise outcome.error
    reason = "failed" if outcome.failure is Failure.RAISED else outcome.failure
    return replace(_nothing(task), reason=reason, message=outcome.detail, seconds=outcome.seconds)


def attempted(task: SolveTask) -> Attempt:
    """Solve as :func:`solve_joint`, in this process, which native code may take down."""
    environment = make_episodes(task.registry, task.robot)
    try:
        return _solve_in(environment, task)
    finally:
        environment.close()


def _require_there(registry: str | Path, asset_id: str, joint: str, robot: str) -> None:
    """Raise what :func:`solve_joint` raises, before a process is started to find out."""
    if robot not in ROBOTS:
        raise ConfigError(f"no robot {robot!r}; want one of {', '.join(ROBOTS)}")
    assets = read_registry(registry)
    if asset_id not in assets:
        there = listed(sorted(assets))
        raise RegistryError(f"{registry}: no asset {asset_id!r}; there are {there}")
    assets[asset_id].joint(joint)


def make_episodes(registry: str | Path, robot: str = "panda", **options: Any) -> Any:
    """Return the environment that attempts are made in; ``options`` go to ``gymnasium.make``."""
    import gymnasium

    return gymnasium.make(
        TASK,
        registry=str(registry),
        robot_uids=robot,
        control_mode="pd_joint_pos",
        sim_backend="physx_cpu",
        max_episode_steps=options.pop("max_episode_steps", STEPS),
        **options,
    )


def replay(
    environment: Any, attempt: Attempt, watch: Callable[[], None] | None = None
) -> tuple[bool, float]:
    """Take an attempt's actions again.

    Args:
        environment: as :func:`make_episodes` makes it.
        attempt: whose.
        watch: called after the reset and after every action.

    Returns:
        The task's ``success`` after the last action, and how far the joint is open.
    """
    environment.reset(seed=attempt.seed, options=attempt.options)
    success = False
    share = 0.0
    if watch is not None:
        watch()
    for action in attempt.actions:
        _, _, _, _, info = environment.step(action)
        success = bool(info["success"])
        share = float(info["open_fraction"])
        if watch is not None:
            watch()
    return success, share


def _solve_in(environment: Any, task: SolveTask) -> Attempt:
    best = _nothing(task)
    avoided: frozenset[tuple[object, ...]] = frozenset()
    for number in range(task.tries):
        attempt, used = _try(environment, replace(best, tries=number + 1), avoided)
        if attempt.solved:
            again, share = replay(environment, attempt)
            if again and share == attempt.open_fraction:
                return attempt
            first = f"{attempt.open_fraction:.3%} the first time"
            message = f"open by {first} and {share:.3%} the second"
            attempt = replace(attempt, solved=False, reason="irreproducible", message=message)
        if number == 0 or attempt.open_fraction > best.open_fraction:
            best = attempt
        best = replace(best, tries=number + 1)
        if not used:
            break
        # What did not move it at all will not the next time either; else the last grip lost it.
        avoided |= set(used) if attempt.reason == "stuck" else {used[-1]}
    return best


def _try(
    environment: Any, blank: Attempt, avoided: frozenset[tuple[object, ...]]
) -> tuple[Attempt, tuple[tuple[object, ...], ...]]:
    """Return one episode, and the grips it took."""
    from .driving import Driver
    from .strategy import act
    from .world import read_world

    environment.reset(seed=blank.seed, options=blank.options)
    task = environment.unwrapped
    driver = Driver(environment, read_world(task), STEPS)
    return act(driver, replace(blank, digest=task.asset_record.digest), avoided)


def _nothing(task: SolveTask) -> Attempt:
    return Attempt(task.asset_id, "", task.joint, task.robot, task.seed, solved=False)
