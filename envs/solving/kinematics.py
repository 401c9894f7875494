"""A robot's link tree as arrays: many poses at once, and joint values for many hand poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from asset_factory.factory.mesh import cross

from ..assets import FloatArray

#: Joints without an end are searched this far to both sides [rad].
ENDLESS = 2.0 * np.pi
#: Damping of the least squares, longest step of a joint [rad] or [m], and pull toward the middle of
#: the limits.
DAMPING = 1e-4
STEP = 0.3
CENTRING = 0.02
#: How close to a limit a joint may come [rad] or [m].
LIMIT_MARGIN = 0.01


@dataclass(frozen=True)
class Chain:
    """An articulation without its simulator.

    Attributes:
        parents: index of each link's parent, which comes before it; -1 for the root.
        before: joint frame in the parent's frame, shape [link, 4, 4]; a joint acts about or along
            its x axis.
        after: the link's frame in the moved joint frame, shape [link, 4, 4].
        degree: index of each link's joint value, -1 if it has none.
        slides: whether it moves along the axis instead of turning about it.
        limits: lowest and highest joint values [rad] or [m], shape [degree, 2].
    """

    parents: tuple[int, ...]
    before: FloatArray
    after: FloatArray
    degree: tuple[int, ...]
    slides: tuple[bool, ...]
    limits: FloatArray

    def forward(
        self, values: FloatArray, root: FloatArray, only: Sequence[int] | None = None
    ) -> FloatArray:
        """Pose of every link in the world, shape [count, link, 4, 4].

        Args:
            values: of the joints [rad] or [m], shape [count, degree].
            root: pose of the root link, shape [4, 4].
            only: links to fill in, parents first; the others' poses mean nothing.
        """
        poses = np.empty((len(values), len(self.parents), 4, 4))
        for index in range(len(self.parents)) if only is None else only:
            parent = self.parents[index]
            if parent < 0:
                poses[:, index] = root
                continue
            frame = poses[:, parent] @ self.before[index]
            if self.degree[index] >= 0:
                frame = frame @ _moved(values[:, self.degree[index]], self.slides[index])
            poses[:, index] = frame @ self.after[index]
        return poses

    def jacobian(self, poses: FloatArray, tip: int, free: Sequence[int]) -> FloatArray:
        """Return a link's Jacobian in ``free``: linear, then angular; shape [count, 6, free]."""
        columns = np.zeros((len(poses), 6, len(free)))
        place = {degree: column for column, degree in enumerate(free)}
        at = poses[:, tip, :3, 3]
        for index in self.line(tip):
            column = place.get(self.degree[index])
            if column is None:
                continue
            frame = poses[:, self.parents[index]] @ self.before[index]
            axis = frame[:, :3, 0]
            if self.slides[index]:
                columns[:, :3, column] = axis
            else:
                columns[:, :3, column] = cross(axis, at - frame[:, :3, 3])
                columns[:, 3:, column] = axis
        return columns

    def line(self, link: int) -> tuple[int, ...]:
        """Return the links that carry a link, from the root to itself."""
        above = []
        while link >= 0:
            above.append(link)
            link = self.parents[link]
        return tuple(above[::-1])

    def depends(self, link: int, degrees: Sequence[int]) -> bool:
        """Return whether a link moves when any of some joint values does."""
        return any(self.degree[above] in degrees for above in self.line(link))


def read_chain(articulation: Any) -> Chain:
    """Return the chain of a SAPIEN articulation."""
    links = articulation.links
    index = {link.name: i for i, link in enumerate(links)}
    order = {joint.name: i for i, joint in enumerate(articulation.active_joints)}
    limits = np.array(articulation.get_qlimits(), dtype=float).reshape(-1, 2)
    limits = np.where(np.isfinite(limits), limits, np.array([-ENDLESS, ENDLESS]))
    before = [link.joint.pose_in_parent.to_transformation_matrix() for link in links]
    after = [link.joint.pose_in_child.inv().to_transformation_matrix() for link in links]
    return Chain(
        tuple(-1 if link.parent is None else index[link.parent.name] for link in links),
        np.array(before, dtype=float),
        np.array(after, dtype=float),
        tuple(order.get(link.joint.name, -1) for link in links),
        tuple("prismatic" in link.joint.type for link in links),
        limits,
    )


def reach(
    chain: Chain,
    tip: int,
    root: FloatArray,
    goals: FloatArray,
    starts: FloatArray,
    free: Sequence[int],
    iterations: int,
) -> tuple[FloatArray, FloatArray]:
    """Return joint values that bring link ``tip`` to poses: damped least squares, within limits.

    S. Buss, "Introduction to inverse kinematics with Jacobian transpose, pseudoinverse and damped
    least squares methods" (2004); what the task leaves free moves toward the middle of the limits.

    Args:
        chain: the robot.
        tip: index of the link.
        root: pose of the root link, shape [4, 4].
        goals: of the tip in the world, shape [count, 4, 4].
        starts: values to begin from, shape [count, degree].
        free: which of them may change.
        iterations: how often.

    Returns:
        The values, shape [count, degree], and how far off they leave the tip [m], [rad], shape
        [count, 2].
    """
    values = starts.copy()
    columns = list(free)
    lower = chain.limits[columns, 0] + LIMIT_MARGIN
    upper = chain.limits[columns, 1] - LIMIT_MARGIN
    middle = 0.5 * (lower + upper)
    width = upper - lower
    line = chain.line(tip)
    for _ in range(iterations):
        poses = chain.forward(values, root, line)
        error = pose_error(poses[:, tip], goals)
        # Half a radian and half a metre at most at once, or the step is far from linear.
        error /= np.maximum(np.abs(error).max(axis=1, keepdims=True) / 0.5, 1.0)
        jacobian = chain.jacobian(poses, tip, columns)
        square = jacobian @ jacobian.transpose(0, 2, 1) + DAMPING * np.eye(6)
        rest = CENTRING * (middle - values[:, columns]) / width
        inside = (jacobian @ rest[:, :, None])[:, :, 0]
        solved = np.linalg.solve(square, (error - inside)[:, :, None])
        step = rest + (jacobian.transpose(0, 2, 1) @ solved)[:, :, 0]
        values[:, columns] = np.clip(values[:, columns] + np.clip(step, -STEP, STEP), lower, upper)
    error = pose_error(chain.forward(values, root, line)[:, tip], goals)
    off = [np.linalg.norm(part, axis=1) for part in (error[:, :3], error[:, 3:])]
    return values, np.stack(off, axis=1)


def pose_error(poses: FloatArray, goals: FloatArray) -> FloatArray:
    """Return the twist from poses to goals: a shift [m], then a turn [rad], shape [count, 6].

    Poses and goals have shape [count, 4, 4].
    """
    turn = goals[:, :3, :3] @ poses[:, :3, :3].transpose(0, 2, 1)
    skew = turn - turn.transpose(0, 2, 1)
    twice = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], 1)
    length = np.linalg.norm(twice, axis=1)
    angle = np.arctan2(length, np.trace(turn, axis1=1, axis2=2) - 1.0)
    # A turn by half a circle has no direction here; any will do for one step.
    unit = twice / np.maximum(length, 1e-9)[:, None]
    axis = np.where(length[:, None] > 1e-9, unit, np.array([0.0, 0.0, 1.0]))
    return np.concatenate([goals[:, :3, 3] - poses[:, :3, 3], axis * angle[:, None]], axis=1)


def _moved(value: FloatArray, slides: bool) -> FloatArray:
    """Return the motion along or about x, shape [count, 4, 4]."""
    motion = np.tile(np.eye(4), (len(value), 1, 1))
    if slides:
        motion[:, 0, 3] = value
    else:
        cos = np.cos(value)
        sin = np.sin(value)
        motion[:, 1, 1] = cos
        motion[:, 1, 2] = -sin
        motion[:, 2, 1] = sin
        motion[:, 2, 2] = cos
    return motion
