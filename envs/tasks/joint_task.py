"""Shared by all tasks: an episode, its state, observations and reward."""

from __future__ import annotations

from typing import Any

import sapien  # noqa: TID253 - this module is only imported to make an environment
import torch  # noqa: TID253
from mani_skill.utils import common  # noqa: TID253
from mani_skill.utils.geometry.rotation_conversions import quaternion_apply  # noqa: TID253
from mani_skill.utils.structs import Pose  # noqa: TID253

from ..assets import OpenableJoint, RegisteredAsset
from ..placement import Place
from ..robots import ROBOTS
from ..targets import named_slot
from .arguments import check_share
from .joint_scene import JointScene

#: A link that turns or moves faster has been thrown, not brought somewhere [rad/s], [m/s].
STATIC_TURN = 1.0
STATIC_MOVE = 0.1
MAX_REWARD = 5.0
#: Beyond this share of its range from where it began a joint counts as being moved, and reaching
#: has been done.
STARTED_SHARE = 0.01
START_NOISE_M = 0.02
START_NOISE_RAD = 0.04


class JointTask(JointScene):
    """A robot brings one joint of the object before it to a goal; see :class:`JointScene`."""

    # What a task says.

    def start_and_goal(self, draws: dict[str, torch.Tensor]) -> tuple[torch.Tensor, torch.Tensor]:
        """Start and goal of the joint in shares of its range, from uniform draws; all [chosen]."""
        raise NotImplementedError

    def at_goal(self, share: torch.Tensor, goal: torch.Tensor) -> torch.Tensor:
        """Tell whether a joint open by ``share`` is where it is to be, all shapes [environment]."""
        raise NotImplementedError

    # One episode.

    def _after_reconfigure(self, options: dict[str, Any]) -> None:
        super()._after_reconfigure(options)
        #: Where the joint is to go and where it began, shares of its range, shape [2, environment].
        self._goal_start = torch.zeros(2, self.num_envs, device=self.device)

    def _initialize_episode(self, env_idx: torch.Tensor, options: dict[str, Any]) -> None:
        draws = self._draw(env_idx)
        slots = self._choose_slots(env_idx, draws["joint"], options.get("joint"))
        self.targets.choose(env_idx, slots)
        start, goal = (value.to(torch.float32) for value in self.start_and_goal(draws))
        if "goal" in options:
            goal = torch.full_like(goal, check_share(type(self).__name__, "goal", options["goal"]))
        self._goal_start[0, env_idx] = goal
        self._goal_start[1, env_idx] = start
        if not self.gpu_sim_enabled:
            self._resist(env_idx, draws)
        values = self.targets.opened(self._closed[env_idx], env_idx, start)
        self.asset.set_qpos(values)
        self.asset.set_qvel(torch.zeros_like(values))
        if self.agent is not None:
            self._place_robot(env_idx, draws)

    def _choose_slots(
        self, env_idx: torch.Tensor, draw: torch.Tensor, joint: str | None
    ) -> torch.Tensor:
        if joint is None:
            return self.targets.drawn(env_idx, draw)
        slots = [named_slot(self.assets[index], joint) for index in env_idx.tolist()]
        return torch.tensor(slots, device=self.device)

    def _place_robot(self, env_idx: torch.Tensor, draws: dict[str, torch.Tensor]) -> None:
        drawn = torch.stack([draws[name] for name in ("x", "y", "yaw")], dim=1)
        noise = drawn.to(torch.float32) * 2.0 - 1.0
        robot = ROBOTS[str(self.robot_uids)]
        found = self._places_of(env_idx)
        place = torch.tensor([each.position.tolist() for each in found], device=self.device)
        place[:, :2] += START_NOISE_M * noise[:, :2]
        yaw = torch.tensor([each.yaw for each in found], device=self.device)
        yaw = yaw + START_NOISE_RAD * noise[:, 2]
        rest = torch.tensor(robot.rest, device=self.device).repeat(len(env_idx), 1)
        if robot.mobile:
            rest[:, :2] = place[:, :2]
            rest[:, 2] = yaw
            self.agent.robot.set_pose(sapien.Pose())
        else:
            zero = torch.zeros_like(yaw)
            turn = torch.stack([torch.cos(yaw / 2), zero, zero, torch.sin(yaw / 2)], dim=1)
            self.agent.robot.set_pose(Pose.create_from_pq(place, turn))
        self.agent.reset(rest)

    def _places_of(self, env_idx: torch.Tensor) -> list[Place]:
        """Return where some robots go, for each one's joint and the nearest of ``starts``."""
        slots = self.targets.slot[env_idx].tolist()
        shares = self._goal_start[1, env_idx].tolist()
        places = []
        for index, slot, share in zip(env_idx.tolist(), slots, shares, strict=True):
            start = min(self.starts, key=lambda start, share=share: abs(start - share))  # type: ignore[misc]
            places.append(self._place(self.assets[index], self.assets[index].openable[slot], start))
        return places

    def _after_control_step(self) -> None:
        if self.gpu_sim_enabled:
            self.scene.px.gpu_update_articulation_kinematics()
            self.scene._gpu_fetch_all()

    # The state, with what the episode is about.

    def get_state_dict(self) -> dict[str, Any]:
        """Return ManiSkill's state, plus target, goal and start as ``task``, [environment, 3]."""
        # Without a robot there is no controller to ask.
        ask = self.scene.get_sim_state if self.agent is None else super().get_state_dict
        state: dict[str, Any] = ask()
        goal, start = self._goal_start
        state["task"] = torch.stack([self.targets.slot.to(goal.dtype), goal, start], dim=1)
        return state

    def set_state_dict(self, state: dict[str, Any], env_idx: torch.Tensor | None = None) -> None:
        """Return to a state of :meth:`get_state_dict` or one row of it; same assets needed."""
        state = dict(state)
        task = state.pop("task", None)
        super().set_state_dict(state, env_idx)
        if task is not None:
            rows = torch.arange(self.num_envs, device=self.device) if env_idx is None else env_idx
            slot, goal, start = common.to_tensor(task, device=self.device).reshape(-1, 3).unbind(1)
            self.targets.choose(rows, slot.long())
            self._goal_start[0, rows] = goal
            self._goal_start[1, rows] = start

    def set_state(self, state: torch.Tensor, env_idx: torch.Tensor | None = None) -> None:
        """Set a flat state of ``get_state``, shape [environment, number].

        ManiSkill's own goes by the first episode's asset, and needs an actor beside the robot.
        """
        flat = common.to_tensor(state, device=self.device)
        self.set_state_dict(_unflattened(flat, self.get_state_dict()), env_idx)

    # What is seen and what it is worth.

    @property
    def asset_record(self) -> RegisteredAsset | None:
        """Return the asset of the first environment; ``None`` before the scene is built."""
        return self.assets[0] if self.assets else None

    @property
    def target(self) -> OpenableJoint:
        """Return the target of the first environment."""
        return self.assets[0].openable[int(self.targets.slot[0])]

    @property
    def place(self) -> Place | None:
        """Return where the robot of the first environment was put; ``None`` without one."""
        return None if self.agent is None else self._places_of(torch.arange(1))[0]

    def handle_position(self) -> torch.Tensor:
        """Return where to hold, world frame [m], shape [environment, 3]."""
        pose = self.targets.handle_pose()
        return pose[:, :3] + quaternion_apply(pose[:, 3:], self.targets["point"])

    def open_fraction(self) -> torch.Tensor:
        """Return how far the targets are open: 0 closed, 1 fully open, shape [environment]."""
        return self.targets.share(self.asset.get_qpos())

    def evaluate(self) -> dict[str, torch.Tensor]:
        """Tell of success: the joint is at its goal, and the moving link nearly at rest."""
        share = self.open_fraction()
        _, velocity, turning = self.targets.motion()
        still = torch.linalg.norm(turning, dim=1) <= STATIC_TURN
        still &= torch.linalg.norm(velocity, dim=1) <= STATIC_MOVE
        reached = self.at_goal(share, self._goal_start[0])
        return {
            "success": reached & still,
            "at_goal": reached,
            "link_static": still,
            "open_fraction": share,
            "handle_position": self.handle_position(),
        }

    def _get_obs_agent(self) -> dict[str, Any]:
        return {} if self.agent is None else super()._get_obs_agent()

    def _get_obs_extra(self, info: dict[str, Any]) -> dict[str, torch.Tensor]:
        handle = info["handle_position"]
        pull = quaternion_apply(self.targets.handle_pose()[:, 3:], self.targets["pull"])
        goal = self._goal_start[0].clone()
        observation = {"handle_position": handle, "pull": pull, "goal_fraction": goal}
        if self.agent is not None:
            observation["tcp_pose"] = self.agent.tcp.pose.raw_pose
        if self.obs_mode_struct.use_state:
            # Turning about its own axis leaves the axis where it is, so that the child's frame
            # serves.
            observation["axis"] = quaternion_apply(self.targets.motion()[0], self.targets["axis"])
            observation["open_fraction"] = info["open_fraction"]
            observation["slides"] = self.targets["slides"].clone()
            if self.agent is not None:
                observation["tcp_to_handle"] = handle - self.agent.tcp.pose.p
        return observation

    def compute_dense_reward(
        self, obs: Any, action: torch.Tensor, info: dict[str, Any]
    ) -> torch.Tensor:
        """Return up to 1 for reaching the handle, 2 to 4 on the way to the goal, 5 for success."""
        share = info["open_fraction"]
        (goal, start) = self._goal_start
        if self.agent is None:
            reach = torch.zeros_like(share)
        else:
            distance = torch.linalg.norm(self.agent.tcp.pose.p - info["handle_position"], dim=1)
            reach = 1.0 - torch.tanh(5.0 * distance)
        way = (goal - start).abs().clamp(min=STARTED_SHARE)
        progress = (1.0 - (goal - share).abs() / way).clamp(0.0, 1.0)
        moved = (share - start).abs() > STARTED_SHARE
        reward = torch.where(moved, torch.full_like(reach, 2.0), reach) + 2.0 * progress
        return torch.where(info["success"], torch.full_like(reward, MAX_REWARD), reward)

    def compute_normalized_dense_reward(
        self, obs: Any, action: torch.Tensor, info: dict[str, Any]
    ) -> torch.Tensor:
        """Return the dense reward divided by its largest value."""
        return self.compute_dense_reward(obs, action, info) / MAX_REWARD


def _unflattened(flat: torch.Tensor, like: dict[str, Any]) -> dict[str, Any]:
    """Split a flat state, shape [environment, number], into tensors shaped as those of ``like``."""
    state = {}
    start = 0
    for name, value in like.items():
        piece = flat[:, start : start + _width(value)]
        nested = isinstance(value, dict)
        inner = _unflattened(piece, value) if nested else piece.reshape(-1, *value.shape[1:])
        state[name] = inner
        start += piece.shape[1]
    return state


def _width(value: Any) -> int:
    """Return how many numbers per environment a part of a state holds."""
    return sum(map(_width, value.values())) if isinstance(value, dict) else int(value[0].numel())
