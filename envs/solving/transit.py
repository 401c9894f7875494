"""Free motion of the arm: a straight line in joint space, or RRT-Connect if that is blocked."""

from __future__ import annotations

import numpy as np

from ..assets import FloatArray
from .world import RobotWorld

#: Joint values are checked this far apart, and a tree grows by so much [rad].
CHECK = 0.12
GROW = 0.4
#: Nodes of a tree, and tries at a shortcut.
NODES = 400
SHORTCUTS = 30


def transit(
    world: RobotWorld, start: FloatArray, goal: FloatArray, object_poses: FloatArray, seed: int
) -> FloatArray | None:
    """Return a collision-free path in joint space, shape [station, degree]; ``None``: none found.

    J. Kuffner, S. LaValle, "RRT-Connect: an efficient approach to single-query path planning"
    (2000).

    Args:
        world: the episode.
        start: values of all joints, shape [degree].
        goal: likewise; the gripper stays as in ``start``.
        object_poses: of the object's links, which keep still.
        seed: of the random samples.
    """
    goal = goal.copy()
    goal[list(world.grippers)] = start[list(world.grippers)]
    if _free(world, start, goal, object_poses):
        return np.array([start, goal])
    if world.hits(goal[None], object_poses[None])[0]:
        return None
    rng = np.random.default_rng(seed)
    columns = list(world.free)
    lower, upper = world.chain.limits[columns].T
    trees = ([start], [goal])
    parents: tuple[list[int], list[int]] = ([-1], [-1])
    side = 0
    for _ in range(NODES):
        sample = start.copy()
        sample[columns] = rng.uniform(np.maximum(lower, -np.pi), np.minimum(upper, np.pi))
        added = _extend(world, trees[side], parents[side], sample, object_poses)
        if added is not None:
            other = 1 - side
            met = _connect(world, trees[other], parents[other], trees[side][added], object_poses)
            if met is not None:
                ends = (added, met) if side == 0 else (met, added)
                path = (
                    _branch(trees[0], parents[0], ends[0])[::-1]
                    + _branch(trees[1], parents[1], ends[1])[1:]
                )
                return _shortened(world, path, object_poses, rng)
        side = 1 - side
    return None


def _free(world: RobotWorld, first: FloatArray, last: FloatArray, object_poses: FloatArray) -> bool:
    """Tell whether the straight line is free; its start does not count, since the arm is there."""
    count = max(1, int(np.ceil(np.abs(last - first).max() / CHECK)))
    line = first + (last - first) * (np.arange(1, count + 1) / count)[:, None]
    return not world.hits(line, object_poses[None]).any()


def _extend(
    world: RobotWorld,
    tree: list[FloatArray],
    parents: list[int],
    sample: FloatArray,
    object_poses: FloatArray,
) -> int | None:
    nearest = int(np.argmin(np.linalg.norm(np.array(tree) - sample, axis=1)))
    offset = sample - tree[nearest]
    step = tree[nearest] + offset * min(1.0, GROW / max(float(np.abs(offset).max()), 1e-9))
    if not _free(world, tree[nearest], step, object_poses):
        return None
    tree.append(step)
    parents.append(nearest)
    return len(tree) - 1


def _connect(
    world: RobotWorld,
    tree: list[FloatArray],
    parents: list[int],
    sample: FloatArray,
    object_poses: FloatArray,
) -> int | None:
    while True:
        added = _extend(world, tree, parents, sample, object_poses)
        if added is None:
            return None
        if np.abs(tree[added] - sample).max() < 1e-9:
            return added


def _branch(tree: list[FloatArray], parents: list[int], index: int) -> list[FloatArray]:
    branch = []
    while index >= 0:
        branch.append(tree[index])
        index = parents[index]
    return branch


def _shortened(
    world: RobotWorld, path: list[FloatArray], object_poses: FloatArray, rng: np.random.Generator
) -> FloatArray:
    for _ in range(SHORTCUTS):
        if len(path) < 3:
            break
        first, last = sorted(rng.choice(len(path), size=2, replace=False))
        if last - first > 1 and _free(world, path[first], path[last], object_poses):
            path = path[: first + 1] + path[last:]
    return np.array(path)
