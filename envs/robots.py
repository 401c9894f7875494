"""The robots: how large they are where they are put, their hands, and what their actions say."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .assets import FloatArray

#: A normalised gripper command: as wide as it goes, and as firmly closed.
OPEN = 1.0
CLOSED = -1.0
#: A normalised step of Fetch's torso stands for this much [m].
TORSO_STEP = 0.1


@dataclass(frozen=True)
class Robot:
    """A robot in its rest pose, in its base frame: x ahead, z up.

    The hand frame is the same for all: z ahead, between the fingers, y along which they close.

    Attributes:
        mobile: whether it drives: x, y and turn of its base are the first three joint values, and
            the first of ``joints`` lifts its arm. Others are mounted at a height that suits the
            handle.
        shoulder: what the arm reaches from [m], shape [3].
        lift: how far the shoulder can be lowered [m].
        near, far: comfortable distances between shoulder and gripper [m].
        body: radius and height of a cylinder around the base [m].
        arm: points of the arm [m], shape [count, 3]; everything is within ``arm_radius`` of them or
            the body.
        rest: joint values [rad] or [m] of that pose, in ManiSkill's order.
        joints: whose values are planned.
        tip: link that the hand frame belongs to.
        turn: hand frame in the tip's frame, shape [3, 3].
        length: of the fingers beyond the origin of the tip [m].
        fingers: links that touch.
        palm: link that they are mounted on.
        finger_joints: their joints.
        opening: of each finger when the gripper is open [m].
    """

    mobile: bool
    shoulder: tuple[float, float, float]
    lift: float
    near: float
    far: float
    body: tuple[float, float]
    arm: FloatArray = field(repr=False, compare=False)
    arm_radius: float
    rest: tuple[float, ...]
    joints: tuple[str, ...]
    tip: str
    turn: FloatArray
    length: float
    fingers: tuple[str, str]
    palm: str
    finger_joints: tuple[str, str]
    opening: float

    def action(
        self, goal: FloatArray, now: FloatArray, gripper: float, drive: FloatArray
    ) -> FloatArray:
        """Return what ``env.step`` takes in ``pd_joint_pos``.

        Args:
            goal: values of :attr:`joints`.
            now: the same as they are.
            gripper: from closed, -1, to open, 1.
            drive: speed ahead [m/s] and of turning [rad/s] of a robot that drives.
        """
        if not self.mobile:
            return np.append(goal, gripper).astype(np.float32)
        lift = np.clip((goal[0] - now[0]) / TORSO_STEP, -1.0, 1.0)
        body = [gripper, 0.0, 0.0, lift, *np.clip(drive / (1.0, 3.14), -1.0, 1.0)]
        return np.append(goal[1:], body).astype(np.float32)


#: Measured on ManiSkill's robots: Fetch in its rest keyframe, Panda in its maker's ready pose,
#: which reaches out less. Rows of an arm are x, y and z of its points.
ROBOTS = {
    "panda": Robot(
        mobile=False,
        shoulder=(0.0, 0.0, 0.333),
        lift=0.0,
        near=0.3,
        far=0.85,
        body=(0.14, 0.45),
        arm=np.column_stack(
            [
                [-0.2, -0.19, -0.05, 0.1, 0.22, *[0.307] * 7],
                [0, 0, 0, 0, 0, 0, -0.08, -0.08, 0, 0, 0.08, 0.08],
                [0.5, 0.6, 0.65, 0.68, 0.7, 0.66, *[0.49, 0.55] * 3],
            ]
        ),
        arm_radius=0.07,
        rest=(0, -math.pi / 4, 0, -3 * math.pi / 4, 0, math.pi / 2, math.pi / 4, 0.04, 0.04),
        joints=tuple(f"panda_joint{i}" for i in range(1, 8)),
        tip="panda_hand_tcp",
        turn=np.eye(3),
        length=0.010,
        fingers=("panda_leftfinger", "panda_rightfinger"),
        palm="panda_hand",
        finger_joints=("panda_finger_joint1", "panda_finger_joint2"),
        opening=0.04,
    ),
    "fetch": Robot(
        mobile=True,
        shoulder=(0.033, 0.0, 1.112),
        lift=0.386,
        near=0.35,
        far=0.9,
        body=(0.29, 1.15),
        arm=np.column_stack(
            [
                [0.1, 0.25, 0.31, 0.5, 0.62, 0.57, 0.51, 0.51, 0.51],
                [0, -0.08, -0.11, -0.07, -0.05, -0.03, 0, 0.06, -0.06],
                [1.4, 1.36, 1.47, 1.51, 1.53, 1.4, 1.25, 1.25, 1.25],
            ]
        ),
        arm_radius=0.08,
        rest=(0, 0, 0, 0.386, 0, -0.37, 0.562, -1.032, 0.695, 0.955, -0.1, 2.077, 0, 0.015, 0.015),
        joints=(
            "torso_lift_joint",
            "shoulder_pan_joint",
            "shoulder_lift_joint",
            "upperarm_roll_joint",
            "elbow_flex_joint",
            "forearm_roll_joint",
            "wrist_flex_joint",
            "wrist_roll_joint",
        ),
        tip="gripper_link",
        turn=np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
        length=0.031,
        fingers=("l_gripper_finger_link", "r_gripper_finger_link"),
        palm="gripper_link",
        finger_joints=("l_gripper_finger_joint", "r_gripper_finger_joint"),
        opening=0.05,
    ),
}
