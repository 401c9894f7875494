"""What a robot does in one episode: the best grip first, another one where that loses the joint."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, replace

from ..assets import FloatArray
from ..robots import CLOSED, OPEN
from .attempt import Attempt
from .driving import OVERLOAD, Driver, Stopped, sustained
from .grips import drags, grasps, pushes, unobstructed
from .planning import ArmPlan, plans
from .transit import transit

#: Grips in one episode, and ways to get to a grip that are searched for.
STAGES = 6
ROUTES = 8
#: A plan that gets the joint this far needs no other kind of grip beside it.
FAR_ENOUGH = 0.95
#: A joint that moves less than this share of its range was not moved.
MOVED = 0.02

Key = tuple[object, ...]


def act(driver: Driver, blank: Attempt, avoided: frozenset[Key]) -> tuple[Attempt, tuple[Key, ...]]:
    """Act in an episode that has just begun until it is solved or nothing is left to try.

    Args:
        driver: of the episode.
        blank: names the joint, the robot and the seed.
        avoided: grips of earlier tries.

    Returns:
        The attempt, and its grips as ``(stage, kind, label)``, so that another try takes others.
    """
    used: list[Key] = []
    kinds: list[str] = []
    useless: set[Key] = set()
    target = -1
    begun = driver.share()

    def ended(reason: str, message: str) -> tuple[Attempt, tuple[Key, ...]]:
        why = replace(blank, reason=reason, message=message, kinds=tuple(kinds), target=target)
        return replace(why, **driver.measured()), tuple(used)

    try:
        for stage in range(STAGES):
            found = _best(driver, blank.seed, stage, avoided | useless)
            if isinstance(found, _Nothing):
                if used and driver.share() < MOVED:
                    break
                return ended("short" if used else found.reason, found.message)
            plan, path = found
            if not kinds:
                target = plan.grip.target
            kinds.append(plan.grip.kind)
            # Until it is there, what goes wrong is the fault of the grip before, if there was one.
            if used:
                _approach(driver, plan, path)
            used.append(_key(stage, plan))
            if len(used) == 1:
                _approach(driver, plan, path)
            begun = driver.share()
            _take(driver, plan)
            driver.follow(plan)
            driver.back_off()
            if driver.share() - begun < MOVED:
                useless |= {_key(later, plan) for later in range(STAGES)}
    except Stopped:
        pass
    share = driver.share()
    if driver.solved:
        return ended("", "")
    peak = sustained(driver.loads)
    opened = f"open by {share:.1%}"
    if share < MOVED:
        force = f"a force of up to {peak:.0f} N"
        return ended("stuck", f"{len(used)} grips, {force}, and it is {opened}")
    if driver.overloaded:
        bore = f"the hand bore {peak:.0f} N, want at most {OVERLOAD:.0f} N"
        return ended("forced", f"{bore}; it is {opened}")
    reason = "short" if share - begun > MOVED else "slipped"
    return ended(reason, f"{len(used)} grips in {len(driver.actions)} steps left it {opened}")


@dataclass(frozen=True)
class _Nothing:
    reason: str
    message: str


def _best(
    driver: Driver, seed: int, stage: int, avoided: Set[Key]
) -> tuple[ArmPlan, FloatArray] | _Nothing:
    """Return the most promising plan with a free way to it."""
    world = driver.world
    poses = driver.world.object_poses(driver.object_values())
    found: list[ArmPlan] = []
    free = 0
    for grips in (grasps, pushes, drags):
        # The next kind is only looked at where the better one does not bring the joint all the way.
        if any(plan.shares[-1] >= FAR_ENOUGH for plan in found) or (grips is drags and found):
            break
        possible = unobstructed(world, grips(world, poses, seed), poses)
        free += len(possible)
        ways = plans(world, driver.values(), driver.object_values(), possible, seed)
        found += [plan for plan in ways if _key(stage, plan) not in avoided]
    opened = f"open by {driver.share():.1%}"
    if not free:
        message = f"{opened}, none of {len(world.targets)} targets leaves room for this hand"
        return _Nothing("no_target", message)
    if not found:
        return _Nothing("unreachable", f"{opened}, none of {free} grips is within the arm's reach")
    found.sort(key=lambda plan: -plan.worth)
    for route, plan in enumerate(found[:ROUTES]):
        path = transit(world, driver.values(), plan.entry[0], poses, seed + route)
        if path is not None:
            return plan, path
    best = f"the best {min(ROUTES, len(found))} of {len(found)} grips"
    return _Nothing("blocked", f"{opened}, no free way to {best}")


def _key(stage: int, plan: ArmPlan) -> Key:
    return (stage, plan.grip.kind, *plan.grip.label)


def _approach(driver: Driver, plan: ArmPlan, path: FloatArray) -> None:
    """Go to where the grip begins."""
    driver.grasp(OPEN if plan.grip.kind == "grasp" else CLOSED)
    driver.go(path)


def _take(driver: Driver, plan: ArmPlan) -> None:
    """Go to the grip and take hold."""
    driver.go(plan.entry[1:], 0.05)
    if plan.grip.kind == "grasp":
        driver.grasp(CLOSED)
