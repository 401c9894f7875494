"""The robots' hands, and what an action of each says in ``pd_joint_pos``."""

from dataclasses import dataclass

import numpy as np

from ..assets import FloatArray

#: A normalised gripper command: as wide as it goes, and as firmly closed.
OPEN = 1.0
CLOSED = -1.0
#: A normalised step of Fetch's torso stands for this much [m].
TORSO_STEP = 0.1


@dataclass(frozen=True)
class Robot:
    """A robot that solves.

    The hand frame is the same for all: z ahead, between the fingers, y along which they close.

    Attributes:
        tip: link that the hand frame belongs to.
        turn: hand frame in the tip's frame, shape [3, 3].
        length: of the fingers beyond the origin of the tip [m].
        fingers: links that touch.
        palm: link that they are mounted on.
        arm: joints that reach; with ``lift``, if there is one, before them.
        lift: a joint that raises the arm.
        drives: whether it has a base that drives, whose x, y and turn are the first three joint
            values.
        finger_joints: their joints.
        opening: of each finger when the gripper is open [m].
    """

    tip: str
    turn: FloatArray
    length: float
    fingers: tuple[str, str]
    palm: str
    arm: tuple[str, ...]
    lift: str | None
    drives: bool
    finger_joints: tuple[str, str]
    opening: float

    @property
    def joints(self) -> tuple[str, ...]:
        """Return the joints whose values are planned."""
        return self.arm if self.lift is None else (self.lift, *self.arm)

    def action(
        self, goal: FloatArray, now: FloatArray, gripper: float, drive: FloatArray
    ) -> FloatArray:
        """Return what ``env.step`` takes.

        Args:
            goal: values of :attr:`joints`.
            now: the same as they are.
            gripper: from closed, -1, to open, 1.
            drive: speed ahead [m/s] and of turning [rad/s] of a robot that drives.
        """
        if self.lift is None:
            return np.append(goal, gripper).astype(np.float32)
        lift = np.clip((goal[0] - now[0]) / TORSO_STEP, -1.0, 1.0)
        body = [gripper, 0.0, 0.0, lift, *np.clip(drive / (1.0, 3.14), -1.0, 1.0)]
        return np.append(goal[1:], body).astype(np.float32)


SOLVERS = {
    "panda": Robot(
        tip="panda_hand_tcp",
        turn=np.eye(3),
        length=0.010,
        fingers=("panda_leftfinger", "panda_rightfinger"),
        palm="panda_hand",
        arm=tuple(f"panda_joint{i}" for i in range(1, 8)),
        lift=None,
        drives=False,
        finger_joints=("panda_finger_joint1", "panda_finger_joint2"),
        opening=0.04,
    ),
    "fetch": Robot(
        tip="gripper_link",
        turn=np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
        length=0.031,
        fingers=("l_gripper_finger_link", "r_gripper_finger_link"),
        palm="gripper_link",
        arm=(
            "shoulder_pan_joint",
            "shoulder_lift_joint",
            "upperarm_roll_joint",
            "elbow_flex_joint",
            "forearm_roll_joint",
            "wrist_flex_joint",
            "wrist_roll_joint",
        ),
        lift="torso_lift_joint",
        drives=True,
        finger_joints=("l_gripper_finger_joint", "r_gripper_finger_joint"),
        opening=0.05,
    ),
}
