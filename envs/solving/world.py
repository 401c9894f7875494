"""An episode as a planner sees it, without the simulator: robot, object and target joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.factory.export.manifest import ManifestTarget

from ..assets import FloatArray, OpenableJoint, RegisteredAsset
from ..geometry import carried_links
from ..robots import ROBOTS, Robot
from .kinematics import Chain, reach, read_chain
from .solids import Balls, LinkHulls, object_pieces, robot_balls

BoolArray = npt.NDArray[np.bool_]

#: Lowest that a point of the arm may be [m]; how deep it may seem to be in what it touches, fingers
#: in what they hold.
FLOOR = 0.005
YIELDING = 0.006
HOLDING = 0.012


@dataclass(frozen=True)
class GraspTarget:
    """A place to take hold, in the frame of the link that is held: see ``docs/targets.md``.

    Attributes:
        number: among all targets of the asset.
        link: index of the link that is held.
        stated: what the asset says of it.
    """

    number: int
    link: int
    stated: ManifestTarget


@dataclass(frozen=True)
class RobotWorld:
    """What does not change during an episode.

    Attributes:
        robot: which one.
        chain, root: its links, and the pose of its root, shape [4, 4].
        tip: index of the link that carries the hand frame.
        free: indices of the joint values that are planned.
        grippers: indices of the fingers' joint values.
        fingers, palm: indices of those links.
        balls: its surface; links on the ground are left out.
        object_chain, object_root, pieces: the same of the object.
        joint: to be opened.
        degree: index of its value among the object's.
        mover: index of the link it moves.
        carried: indices of all links that move with it.
        targets: the asset's interaction targets of that joint, best first.
    """

    robot: Robot
    chain: Chain
    root: FloatArray
    tip: int
    free: tuple[int, ...]
    grippers: tuple[int, ...]
    fingers: tuple[int, ...]
    palm: int
    balls: Balls
    object_chain: Chain
    object_root: FloatArray
    pieces: LinkHulls
    joint: OpenableJoint
    degree: int
    mover: int
    carried: tuple[int, ...]
    targets: tuple[GraspTarget, ...]

    def object_poses(self, values: FloatArray, share: float | None = None) -> FloatArray:
        """Return the poses of the object's links, shape [link, 4, 4].

        Args:
            values: of its joints, shape [degree].
            share: how far the joint is open instead.
        """
        values = values.copy()
        if share is not None:
            values[self.degree] = self.joint.lower + share * (self.joint.upper - self.joint.lower)
        return np.asarray(self.object_chain.forward(values[None], self.object_root)[0])

    def share(self, values: FloatArray) -> float:
        """Return how far the joint is open."""
        lower = self.joint.lower
        return float((values[self.degree] - lower) / (self.joint.upper - lower))

    def axis(self, poses: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return a point of the joint's axis [m] and its direction, in the world, shapes [3]."""
        parent = self.object_chain.parents[self.mover]
        frame = poses[parent] @ self.object_chain.before[self.mover]
        return frame[:3, 3], frame[:3, 0]

    def hand(self, poses: FloatArray) -> FloatArray:
        """Return the hand frame, shape [count, 4, 4], of link poses, shape [count, link, 4, 4]."""
        hand = poses[:, self.tip].copy()
        hand[:, :3, :3] = hand[:, :3, :3] @ self.robot.turn
        return hand

    def reach(
        self, hands: FloatArray, starts: FloatArray, iterations: int
    ) -> tuple[FloatArray, FloatArray]:
        """Return joint values that bring the hand to frames, see :func:`~.kinematics.reach`.

        Args:
            hands: shape [count, 4, 4].
            starts: values to begin from, shape [count, degree].
            iterations: how often they are improved.
        """
        tips = hands.copy()
        tips[:, :3, :3] = hands[:, :3, :3] @ self.robot.turn.T
        return reach(self.chain, self.tip, self.root, tips, starts, self.free, iterations)

    def hits(
        self, values: FloatArray, object_poses: FloatArray, touching: bool = False
    ) -> BoolArray:
        """Return which configurations run into the object or the ground, shape [count].

        Args:
            values: of the robot's joints, shape [count, degree].
            object_poses: shape [count, link, 4, 4], or [1, link, 4, 4] if it keeps still.
            touching: the fingers may be at moving links, and the rest as near as contacts give way.
        """
        points = self.balls.placed(self.chain.forward(values, self.root))
        hit = points[..., 2].min(axis=1) < FLOOR
        if not touching:
            inside = self.pieces.distance(points, object_poses) < self.balls.radius
            return np.asarray(hit | inside.any(axis=1))
        finger = np.isin(self.balls.link, self.fingers)
        yielding = self.balls.radius[~finger] - YIELDING
        rest = self.pieces.distance(points[:, ~finger], object_poses) < yielding
        fingers = self.pieces.distance(points[:, finger], object_poses, self.carried) < 0.0
        # A hand that does not turn with what it holds may end up with a finger through it.
        fingers |= self.pieces.distance(points[:, finger], object_poses) < -HOLDING
        return np.asarray(hit | rest.any(axis=1) | fingers.any(axis=1))


def read_world(task: Any) -> RobotWorld:
    """Return the world of a task's running episode.

    Args:
        task: a :class:`~asset_factory.envs.tasks.joint_task.JointTask` after ``reset``, with one
            environment.
    """
    robot = ROBOTS[str(task.robot_uids)]
    agent = task.agent.robot
    part = task._parts[0]
    arm = agent._objs[0]
    thing = part._objs[0]
    chain = read_chain(arm)
    object_chain = read_chain(thing)
    links = [link.name for link in agent.links]
    object_links = [link.name for link in part.links]
    degrees = {joint.name: i for i, joint in enumerate(agent.active_joints)}
    record = task.asset_record
    joint = task.target
    fingers = tuple(links.index(name) for name in robot.fingers)
    free = tuple(degrees[name] for name in robot.joints)
    moving = [index for index in range(len(links)) if chain.depends(index, free)]
    return RobotWorld(
        robot=robot,
        chain=chain,
        root=matrix_of(arm.pose),
        tip=links.index(robot.tip),
        free=free,
        grippers=tuple(degrees[name] for name in robot.finger_joints),
        fingers=fingers,
        palm=links.index(robot.palm),
        balls=robot_balls(arm, fingers).of(moving),
        object_chain=object_chain,
        object_root=matrix_of(thing.pose),
        pieces=object_pieces(thing),
        joint=joint,
        degree=[other.name for other in part.active_joints].index(joint.name),
        mover=object_links.index(joint.child),
        carried=tuple(sorted(map(object_links.index, carried_links(record, joint)))),
        targets=read_targets(record, joint, object_links),
    )


def read_targets(
    record: RegisteredAsset, joint: OpenableJoint, links: Sequence[str]
) -> tuple[GraspTarget, ...]:
    """Return a joint's interaction targets, best first."""
    named = enumerate(record.manifest.targets)
    own = ((number, target) for number, target in named if target.joint == joint.name)
    found = (GraspTarget(number, links.index(target.part), target) for number, target in own)
    return tuple(sorted(found, key=lambda target: -target.stated.score))


def matrix_of(pose: Any) -> FloatArray:
    """Return a pose of SAPIEN's, shape [4, 4]."""
    return np.asarray(pose.to_transformation_matrix(), dtype=float)
