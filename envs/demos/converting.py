"""Actions of ``pd_joint_pos`` as actions of another control mode that take a robot the same way."""

from typing import Any

import numpy as np
import numpy.typing as npt

#: Control steps that an action may become, while the hand lags behind by more than one can do.
MOST_STEPS = 4


def act_converted(
    mode: str, actions: npt.NDArray[np.float32], original: Any, environment: Any
) -> bool:
    """Act in two environments at once: as it was, and in another control mode after it.

    Args:
        mode: of ``environment``.
        actions: of ``pd_joint_pos``, shape [step, action].
        original: an environment in ``pd_joint_pos``, after the reset.
        environment: one in ``mode``, after the same reset.

    Returns:
        Whether the task in ``environment`` says ``success`` in the end.

    Raises:
        NotImplementedError: nobody knows how to convert to ``mode``.
    """
    from mani_skill.trajectory.utils.actions import conversion

    if "ee" in mode:
        info = to_hand_poses(mode, actions, original, environment)
    else:
        info = conversion.from_pd_joint_pos(mode, actions, original, environment)
    return bool(info["success"])


def to_hand_poses(
    output_mode: str,
    ori_actions: npt.NDArray[np.float32],
    ori_env: Any,
    env: Any,
    render: bool = False,
    pbar: Any = None,
    verbose: bool = False,
) -> dict[str, Any]:
    """Move the hand to where the joint targets would have it, in the frame of the robot's base.

    Takes the place of ManiSkill's ``from_pd_joint_pos_to_ee``, and its arguments, which holds for a
    base that is turned like the world only.

    Returns:
        What the last step said besides; acting ends with the first ``success``.
    """
    import torch
    from mani_skill.utils import common

    controller = env.unwrapped.agent.controller
    source = ori_env.unwrapped.agent.controller
    arm = controller.controllers["arm"]
    target = _HandTarget(source, arm)
    info: dict[str, Any] = {"success": False}
    for action in ori_actions:
        ori_env.step(action)
        pose = target.pose()
        parts = source.to_action_dict(common.to_tensor(action, device=env.unwrapped.device))
        for _ in range(MOST_STEPS):
            command, arrived = _command(arm, pose)
            parts = {**parts, "arm": common.to_tensor(command, device=env.unwrapped.device)}
            _, _, _, _, info = env.step(controller.from_action_dict(parts))
            if render:
                env.render_human()
            if arrived or bool(info["success"]):
                break
            # What drives or lifts by steps has done so.
            parts = {
                name: part if name == "gripper" else torch.zeros_like(part)
                for name, part in parts.items()
            }
        if pbar is not None:
            pbar.update()
        if bool(info["success"]):
            break
    return info


class _HandTarget:
    """Where one controller's joint targets put the other's hand, in its base's frame."""

    def __init__(self, source: Any, arm: Any) -> None:
        self._source = source.controllers["arm"]
        self._articulation = source.articulation
        self._model = self._articulation.create_pinocchio_model()
        self._hand = int(arm.ee_link.index)
        self._base = int(arm.root_link.index)

    def pose(self) -> Any:
        values = self._articulation.get_qpos().clone()
        values[:, self._source.active_joint_indices] = self._source._target_qpos
        self._model.compute_forward_kinematics(values.cpu().numpy()[0])
        return self._model.get_link_pose(self._base).inv() * self._model.get_link_pose(self._hand)


def _command(arm: Any, pose: Any) -> tuple[npt.NDArray[np.float32], bool]:
    """Return the hand controller's command for a pose, and whether one step is enough."""
    from scipy.spatial.transform import Rotation

    goal = Rotation.from_quat(pose.q, scalar_first=True)
    turns = hasattr(arm.config, "rot_lower")
    if not arm.config.use_delta:
        command = np.append(pose.p, goal.as_euler("XYZ")) if turns else pose.p
        return np.asarray(command, dtype=np.float32), True
    now = (arm._target_pose if arm.config.use_target else arm.ee_pose_at_base).sp
    low = arm.action_space_low.cpu().numpy()[:3]
    high = arm.action_space_high.cpu().numpy()[:3]
    move = (pose.p - now.p - 0.5 * (high + low)) / (0.5 * (high - low))
    command = np.clip(move, -1.0, 1.0)
    far = bool(np.abs(move).max() > 1.0)
    if turns:
        turn = goal * Rotation.from_quat(now.q, scalar_first=True).inv()
        # The controller multiplies by the lower bound, which is negative.
        angles = turn.as_euler("XYZ") / arm.config.rot_lower
        length = float(np.linalg.norm(angles))
        command = np.append(command, angles / max(length, 1.0))
        far = far or length > 1.0
    return np.asarray(command, dtype=np.float32), not far
