"""From a grip to joint values: take hold, and go along with the joint as far as the arm can."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..assets import FloatArray
from .grips import STANDOFF, Grip
from .world import BoolArray, RobotWorld

#: Starting points of the search for joint values per grip, and its iterations.
STARTS = 8
ITERATIONS = 50
#: How well a hand pose has to be reached [m], [rad].
NEAR_M = 0.004
NEAR_RAD = 0.08
#: How much of a hinge's turning the hand does not go along with, and how far off it may turn on the
#: way [rad].
LAGS = (0.0, 0.5, 1.0)
#: Stations of the whole way of a joint, iterations for each, longest step of a joint between two
#: [rad].
WAY_STATIONS = 24
WAY_ITERATIONS = 8
LEAP = 0.7
#: A grip is worth nothing if the joint gets less far than this share of its range.
LEAST = 0.04
#: Plans that are looked at closely, and how many good ones are enough.
FINALISTS = 40
ENOUGH = 4
#: Of these so many at once, and stations of the straight way to a grip.
TOGETHER = 8
ENTRY_STATIONS = 5


@dataclass(frozen=True)
class ArmPlan:
    """A grip, how to get there and what to do then.

    Attributes:
        grip: which.
        entry: from in front of it to the grip, values of all joints, shape [station, degree].
        way: on the joint's way, shape [station, degree].
        shares: how far open the joint is at each, shape [station].
        hands: hand frames on the way, shape [station, 4, 4].
        worth: to sort by.
    """

    grip: Grip
    entry: FloatArray
    way: FloatArray
    shares: FloatArray
    hands: FloatArray
    worth: float


def plans(
    world: RobotWorld, values: FloatArray, object_values: FloatArray, grips: list[Grip], seed: int
) -> list[ArmPlan]:
    """Return what could be done with some grips, the most promising first.

    Args:
        world: the episode.
        values: of the robot's joints now, shape [degree].
        object_values: of the object's joints now, shape [degree].
        grips: at which the hand is free.
        seed: of the random starting points.
    """
    if not grips:
        return []
    starts = _starts(world, values, seed)
    which = np.repeat(np.arange(len(grips)), len(starts))
    hands = np.array([grip.hand for grip in grips])[which]
    found, off = world.reach(hands, np.tile(starts, (len(grips), 1)), ITERATIONS)
    near = np.flatnonzero((off[:, 0] < NEAR_M) & (off[:, 1] < NEAR_RAD))
    good = _different(world, found, which.tolist(), near.tolist())
    if not good:
        return []
    candidates = _ways(world, found[good], [grips[which[row]] for row in good], object_values)
    candidates.sort(key=lambda plan: -plan.worth)
    return _checked(world, candidates, object_values)


def motion(
    world: RobotWorld,
    object_values: FloatArray,
    hands: FloatArray,
    lag: FloatArray,
    shares: FloatArray,
) -> FloatArray:
    """Hand frames that go along with the joint, shape [share, count, 4, 4].

    Args:
        world: the episode.
        object_values: of the object's joints when the hand is at ``hands``.
        hands: shape [count, 4, 4].
        lag: how much of a hinge's turning each hand leaves out, shape [count].
        shares: how far the joint is open, shape [share].
    """
    now = world.object_poses(object_values)
    _, axis = world.axis(now)
    slides = world.object_chain.slides[world.mover]
    span = world.joint.upper - world.joint.lower
    placed = np.empty((len(shares), *hands.shape))
    for row, share in enumerate(shares):
        then = world.object_poses(object_values, share)
        placed[row] = then[world.mover] @ np.linalg.inv(now[world.mover]) @ hands
        if not slides:
            back = -lag * (share - world.share(object_values)) * span
            turn = Rotation.from_rotvec(back[:, None] * axis).as_matrix()
            placed[row, :, :3, :3] = turn @ placed[row, :, :3, :3]
    return placed


def _starts(world: RobotWorld, values: FloatArray, seed: int) -> FloatArray:
    """Return joint values to search from: those of now, and random ones, shape [start, degree]."""
    rng = np.random.default_rng(seed)
    starts = np.tile(values, (STARTS, 1))
    free = list(world.free)
    lower, upper = world.chain.limits[free].T
    shares = rng.uniform(0.15, 0.85, size=(STARTS - 1, len(free)))
    starts[1:, free] = lower + (upper - lower) * shares
    return starts


def _different(
    world: RobotWorld, found: FloatArray, which: list[int], rows: list[int]
) -> list[int]:
    """Select of solutions for one grip, shape [solution, degree], those of ``rows`` that differ."""
    kept: dict[tuple[int, ...], int] = {}
    for row in rows:
        key = (which[row], *np.round(found[row, list(world.free)] / 0.6).astype(int).tolist())
        kept.setdefault(key, row)
    return list(kept.values())


def _ways(
    world: RobotWorld, values: FloatArray, grips: list[Grip], object_values: FloatArray
) -> list[ArmPlan]:
    """Follow the joint from every solution, with every lag."""
    slides = world.object_chain.slides[world.mover]
    lags = (0.0,) if slides else LAGS
    row = np.repeat(np.arange(len(values)), len(lags))
    lag = np.tile(lags, len(values))
    now = world.share(object_values)
    count = max(3, int(np.ceil(WAY_STATIONS * (1.0 - now))))
    shares = np.linspace(now, 1.0, count + 1)[1:]
    hands = np.array([grip.hand for grip in grips])[row]
    goals = motion(world, object_values, hands, lag, shares)
    current = values[row]
    alive = np.ones(len(row), dtype=bool)
    steps = []
    far = np.zeros(len(row), dtype=int)
    for goal in goals:
        following, off = world.reach(goal, current, WAY_ITERATIONS)
        alive &= _follows(current, following, off)
        far += alive
        current = np.where(alive[:, None], following, current)
        steps.append(current)
        if not alive.any():
            break
    found = []
    for index in range(len(row)):
        stations = far[index]
        if stations == 0 or shares[stations - 1] - now < min(LEAST, 0.5 * (1.0 - now)):
            continue
        grip = grips[row[index]]
        worth = (shares[stations - 1] - now) / (1.0 - now) * (0.3 + grip.score) - 0.03 * lag[index]
        way = np.array([step[index] for step in steps[:stations]])
        start = values[row[index]][None]
        hands = goals[:stations, index]
        found.append(ArmPlan(grip, start, way, shares[:stations], hands, float(worth)))
    return found


def _follows(current: FloatArray, following: FloatArray, off: FloatArray) -> BoolArray:
    """Tell which hands went where they should without a leap of a joint, shape [count]."""
    leap = np.abs(following - current).max(axis=1)
    return np.asarray((off[:, 0] < 2 * NEAR_M) & (off[:, 1] < 2 * NEAR_RAD) & (leap < LEAP))


def _checked(
    world: RobotWorld, candidates: list[ArmPlan], object_values: FloatArray
) -> list[ArmPlan]:
    """Return the best candidates that run into nothing, cut where they do."""
    closed = world.object_poses(object_values)
    passed: list[ArmPlan] = []
    looked = _of_each_grip(candidates, 3)[:FINALISTS]
    for start in range(0, len(looked), TOGETHER):
        together = looked[start : start + TOGETHER]
        # A look can only lower what a plan is worth.
        if sum(other.worth >= together[0].worth for other in passed) >= ENOUGH:
            break
        for plan in _entered(world, together):
            checked = _check(world, plan, closed, object_values)
            if checked is not None:
                passed.append(checked)
    return sorted(passed, key=lambda plan: -plan.worth)


def _of_each_grip(candidates: list[ArmPlan], most: int) -> list[ArmPlan]:
    """Select at most so many of every grip, in their order."""
    kept = []
    counts = Counter[tuple[object, ...]]()
    for plan in candidates:
        key = (plan.grip.kind, *plan.grip.label)
        counts[key] += 1
        if counts[key] <= most:
            kept.append(plan)
    return kept


def _check(
    world: RobotWorld, plan: ArmPlan, closed: FloatArray, object_values: FloatArray
) -> ArmPlan | None:
    before = _gripped(world, plan.entry[:1], plan.grip, opened=True)
    if world.hits(before, closed[None])[0]:
        return None
    poses = np.array([world.object_poses(object_values, share) for share in plan.shares])
    hit = world.hits(_gripped(world, plan.way, plan.grip, opened=False), poses, touching=True)
    stations = int(np.argmax(hit)) if hit.any() else len(hit)
    now = world.share(object_values)
    if stations == 0 or plan.shares[stations - 1] - now < min(LEAST, 0.5 * (1.0 - now)):
        return None
    kept = float((plan.shares[stations - 1] - now) / (plan.shares[-1] - now))
    parts = {name: getattr(plan, name)[:stations] for name in ("way", "shares", "hands")}
    return replace(plan, worth=plan.worth * kept, **parts)


def _entered(world: RobotWorld, plans: list[ArmPlan]) -> list[ArmPlan]:
    """Return the plans whose grips the arm reaches along a straight line."""
    starts = np.array([plan.entry[0] for plan in plans])
    hands = np.array([plan.grip.hand for plan in plans])
    fine = np.ones(len(plans), dtype=bool)
    steps = [starts]
    current = starts
    for back in np.linspace(0.0, STANDOFF, ENTRY_STATIONS + 1)[1:]:
        moved = hands.copy()
        moved[:, :3, 3] -= back * hands[:, :3, 2]
        following, off = world.reach(moved, current, WAY_ITERATIONS)
        fine &= _follows(current, following, off)
        current = following
        steps.append(current)
    entries = np.array(steps[::-1]).transpose(1, 0, 2)
    return [replace(plans[i], entry=entries[i]) for i in np.flatnonzero(fine)]


def _gripped(world: RobotWorld, values: FloatArray, grip: Grip, opened: bool) -> FloatArray:
    """Return joint values, gripper as before, ``opened`` or at a grip; shape [count, degree]."""
    values = values.copy()
    held = world.robot.opening if opened else 0.5 * grip.opening
    values[:, list(world.grippers)] = held if grip.kind == "grasp" else 0.0
    return values
