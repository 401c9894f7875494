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
    near = _MotionTree(world, object_poses, start)
    far = _MotionTree(world, object_poses, goal)
    for number in range(NODES):
        tree, other = (near, far) if number % 2 == 0 else (far, near)
        sample = start.copy()
        sample[columns] = rng.uniform(np.maximum(lower, -np.pi), np.minimum(upper, np.pi))
        if tree.extend(sample) and other.connect(tree.nodes[-1]):
            return _shortened(world, near.branch()[::-1] + far.branch()[1:], object_poses, rng)
    return None


class _MotionTree:
    """Configurations that can be reached from the first one along straight free lines.

    Attributes:
        nodes: joint values, shape [degree] each, in the order in which they were added.
    """

    def __init__(self, world: RobotWorld, object_poses: FloatArray, root: FloatArray) -> None:
        self._world = world
        self._object_poses = object_poses
        self._parents = [-1]
        self.nodes = [root]

    def extend(self, sample: FloatArray) -> bool:
        """Extend the nearest node towards a sample; tell whether the line was free."""
        nearest = int(np.argmin(np.linalg.norm(np.array(self.nodes) - sample, axis=1)))
        offset = sample - self.nodes[nearest]
        share = min(1.0, GROW / max(float(np.abs(offset).max()), 1e-9))
        step = self.nodes[nearest] + offset * share
        if not _free(self._world, self.nodes[nearest], step, self._object_poses):
            return False
        self.nodes.append(step)
        self._parents.append(nearest)
        return True

    def connect(self, sample: FloatArray) -> bool:
        """Extend the tree to a sample; tell whether it was reached."""
        while self.extend(sample):
            if np.abs(self.nodes[-1] - sample).max() < 1e-9:
                return True
        return False

    def branch(self) -> list[FloatArray]:
        """Return the nodes from the last one to the first."""
        found = []
        index = len(self.nodes) - 1
        while index >= 0:
            found.append(self.nodes[index])
            index = self._parents[index]
        return found


def _free(world: RobotWorld, first: FloatArray, last: FloatArray, object_poses: FloatArray) -> bool:
    """Tell whether the straight line is free; its start does not count, since the arm is there."""
    count = max(1, int(np.ceil(np.abs(last - first).max() / CHECK)))
    line = first + (last - first) * (np.arange(1, count + 1) / count)[:, None]
    return not world.hits(line, object_poses[None]).any()


def _shortened(
    world: RobotWorld, path: list[FloatArray], object_poses: FloatArray, rng: np.random.Generator
) -> FloatArray:
    """Return the path with shortcuts along straight free lines, shape [station, degree]."""
    for _ in range(SHORTCUTS):
        if len(path) < 3:
            break
        first, last = sorted(rng.choice(len(path), size=2, replace=False))
        if last - first > 1 and _free(world, path[first], path[last], object_poses):
            path = path[: first + 1] + path[last:]
    return np.array(path)
