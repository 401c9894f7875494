"""``OpenJoint-v1``: open one door, drawer or lid of an asset from a registry."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import sapien  # noqa: TID253 - this module is only imported to make an environment
import torch  # noqa: TID253
from mani_skill.envs.sapien_env import BaseEnv  # noqa: TID253
from mani_skill.sensors.camera import CameraConfig  # noqa: TID253
from mani_skill.utils import sapien_utils  # noqa: TID253
from mani_skill.utils.registration import register_env  # noqa: TID253
from mani_skill.utils.structs import Pose  # noqa: TID253

from .assets import OpenableJoint, RegisteredAsset, read_registry, select_assets
from .loading import build_ground, invisible_robots, load_asset
from .placement import CAMERA_FOV, camera_place, facing_direction, standing_place

#: A link that turns or moves faster has been thrown, not opened [rad/s], [m/s].
STATIC_TURN, STATIC_MOVE = 1.0, 0.1
MAX_REWARD = 5.0
#: Beyond this share of its range a joint counts as being opened, and reaching has been done.
STARTED_FRACTION = 0.01
START_NOISE_M, START_NOISE_RAD = 0.03, 0.1
MOBILE_ROBOTS = ("fetch",)


@register_env("OpenJoint-v1", max_episode_steps=200)
class OpenJointEnv(BaseEnv):  # type: ignore[misc]
    """A robot stands before a closed object and opens one of its joints.

    Success: at least ``min_open_frac`` of the joint's range, and the moving link nearly at rest.

    Which asset and which joint are drawn from the episode's random generator; a fixed ``asset`` or
    ``joint`` is not. ``reset(options={"asset": ID, "joint": NAME})`` decides for one episode.

    Args:
        registry: folder that ``factory build --output`` wrote.
        asset: id of the only asset to use; ``None`` draws one per episode.
        joint: name of the only joint to open; ``None`` draws one per episode.
        min_open_frac: share of the range that counts as open.
        robot_uids: ``panda`` and other arms are mounted at the handle's height, ``fetch`` stands on the
            floor, ``none`` leaves the object alone.

    Raises:
        RegistryError: no registry, nothing in it to open, or no such asset or joint; says what there is.
        ValueError: more than one environment in a process.
    """

    SUPPORTED_ROBOTS = ["panda", "fetch", "none"]  # noqa: RUF012 - ManiSkill's own convention

    def __init__(
        self,
        *args: Any,
        registry: str | Path,
        asset: str | None = None,
        joint: str | None = None,
        min_open_frac: float = 0.9,
        robot_uids: str = "panda",
        num_envs: int = 1,
        reconfiguration_freq: int | None = None,
        **kwargs: Any,
    ) -> None:
        if num_envs != 1:
            raise ValueError(
                f"OpenJoint-v1: num_envs is {num_envs}, want 1; run several with gymnasium.vector.AsyncVectorEnv"
            )
        self.min_open_frac = min_open_frac
        self._available = read_registry(registry)
        self._assets = select_assets(self._available, asset, joint)
        self._joint_name = joint
        if reconfiguration_freq is None:
            reconfiguration_freq = 0 if len(self._assets) == 1 else 1
        self.asset_record: RegisteredAsset | None = None
        super().__init__(*args, robot_uids=robot_uids, num_envs=1, reconfiguration_freq=reconfiguration_freq, **kwargs)

    def reset(
        self, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start an episode; ``options`` may name ``asset`` and ``joint``, and hold what ManiSkill takes."""
        options = dict(options or {})
        forced = options.get("asset")
        select_assets(self._available if forced else self._assets, forced, options.get("joint"))
        if self.asset_record is not None:
            # Without a forced choice, what an earlier episode was forced to may have to go again.
            acceptable = {forced} if forced else set(self._assets)
            if self.asset_record.id not in acceptable:
                options["reconfigure"] = True
        return super().reset(seed=seed, options=options)  # type: ignore[no-any-return]

    # Building the scene.

    def _load_agent(self, options: dict[str, Any]) -> None:
        with invisible_robots(self.scene):
            super()._load_agent(options, sapien.Pose(p=[0.0, -3.0, 0.0]))

    def _load_scene(self, options: dict[str, Any]) -> None:
        self.ground = build_ground(self.scene)
        if str(self.robot_uids) == "fetch":
            from mani_skill.agents.robots.fetch import FETCH_WHEELS_COLLISION_BIT

            self.ground.set_collision_group_bit(group=2, bit_idx=FETCH_WHEELS_COLLISION_BIT, bit=1)
        self.asset_record = self._choose_asset(options)
        self.asset = load_asset(self.scene, self.asset_record)

    def _choose_asset(self, options: dict[str, Any]) -> RegisteredAsset:
        assets = self._available if options.get("asset") else self._assets
        chosen = select_assets(assets, options.get("asset"), options.get("joint"))
        return chosen[str(self._batched_episode_rng.choice(sorted(chosen))[0])]

    @property
    def _default_sensor_configs(self) -> list[CameraConfig]:
        return [self._camera("base_camera", 128)]

    @property
    def _default_human_render_camera_configs(self) -> CameraConfig:
        return self._camera("render_camera", 512)

    def _camera(self, name: str, pixels: int) -> CameraConfig:
        asset = self._record
        joint = asset.openable[0]
        eye, target = camera_place(
            asset.standing_bounds, facing_direction(joint.rest_point, joint.pull, joint.normal, asset.bounds)
        )
        pose = sapien_utils.look_at(eye=eye.tolist(), target=target.tolist())
        return CameraConfig(name, pose=pose, width=pixels, height=pixels, fov=CAMERA_FOV, near=0.01, far=100.0)

    # One episode.

    def _initialize_episode(self, env_idx: torch.Tensor, options: dict[str, Any]) -> None:
        self.target = self._choose_joint(options)
        self.handle_link = self.asset.links_map[self.target.handle_link]
        self.moving_link = self.asset.links_map[self.target.child]
        self._target_index = [joint.name for joint in self.asset.active_joints].index(self.target.name)
        self.asset.set_qpos(torch.tensor([self._closed_values()], dtype=torch.float32, device=self.device))
        self.asset.set_qvel(torch.zeros(1, self.asset.max_dof, device=self.device))
        if self.agent is not None:
            self._place_robot()

    def _choose_joint(self, options: dict[str, Any]) -> OpenableJoint:
        name = options.get("joint") or (None if options.get("asset") else self._joint_name)
        if name is None:
            name = self._batched_episode_rng.choice([joint.name for joint in self._record.openable])[0]
        return self._record.joint(str(name))

    def _closed_values(self) -> list[float]:
        """Joint values of the closed object [rad] or [m]; a continuous joint is closed in its input pose."""
        movable = self._record.movable
        data = [movable[joint.name] for joint in self.asset.active_joints]
        return [0.0 if joint["kind"] == "continuous" else float(joint["lower"]) for joint in data]

    def _place_robot(self) -> None:
        target = self.target
        rest = self.agent.keyframes["rest"].qpos.copy()
        self.agent.reset(rest)
        reach = float((self.agent.robot.pose.inv() * self.agent.tcp.pose).p[0, 0])
        turned = self._handle_rotation()[0].cpu().numpy().astype(np.float64)
        point = self.handle_position()[0].cpu().numpy().astype(np.float64)
        bounds = self._record.standing_bounds
        direction = facing_direction(point, turned @ target.pull, turned @ target.normal, bounds)
        mobile = str(self.robot_uids) in MOBILE_ROBOTS
        place, yaw = standing_place(point, direction, bounds, reach, mobile=mobile)
        noise = self._batched_episode_rng.uniform(-1.0, 1.0, size=(3,))[0]
        place[:2] += START_NOISE_M * noise[:2]
        yaw += START_NOISE_RAD * noise[2]
        pose = sapien.Pose()
        if mobile:
            rest[:3] = [place[0], place[1], yaw]
        else:
            pose = sapien.Pose(p=place, q=[math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)])
        self.agent.reset(rest)
        self.agent.robot.set_pose(pose)

    # What is seen and what it is worth.

    @property
    def _record(self) -> RegisteredAsset:
        if self.asset_record is None:
            raise RuntimeError("OpenJoint-v1: no asset is loaded yet; call reset first")
        return self.asset_record

    def handle_position(self) -> torch.Tensor:
        """Where to hold, world frame [m], shape [1, 3]."""
        point = sapien.Pose(p=self.target.point)
        return (self.handle_link.pose * Pose.create(point, device=self.device)).p

    def open_fraction(self) -> torch.Tensor:
        """Share of the target joint's range that is open, shape [1]; 0 is closed, 1 fully open."""
        value = self.asset.get_qpos()[:, self._target_index]
        return (value - self.target.lower) / (self.target.upper - self.target.lower)

    def _handle_rotation(self) -> torch.Tensor:
        return self.handle_link.pose.to_transformation_matrix()[:, :3, :3]

    def _direction(self, rest: np.ndarray[Any, Any], link: Any) -> torch.Tensor:
        rotation = link.pose.to_transformation_matrix()[:, :3, :3]
        return rotation @ torch.as_tensor(rest, dtype=rotation.dtype, device=self.device)

    def evaluate(self) -> dict[str, torch.Tensor]:
        """Success and what it is made of."""
        fraction = self.open_fraction()
        open_enough = fraction >= self.min_open_frac
        turning = torch.linalg.norm(self.moving_link.angular_velocity, dim=1)
        moving = torch.linalg.norm(self.moving_link.linear_velocity, dim=1)
        link_static = (turning <= STATIC_TURN) & (moving <= STATIC_MOVE)
        return {
            "success": open_enough & link_static,
            "open_enough": open_enough,
            "link_static": link_static,
            "open_fraction": fraction,
            "handle_position": self.handle_position(),
        }

    def get_state_dict(self) -> dict[str, Any]:
        """ManiSkill's state of the scene; without a robot there is no controller to ask."""
        return self.scene.get_sim_state() if self.agent is None else super().get_state_dict()  # type: ignore[no-any-return]

    def _get_obs_agent(self) -> dict[str, Any]:
        return {} if self.agent is None else super()._get_obs_agent()

    def _get_obs_extra(self, info: dict[str, Any]) -> dict[str, torch.Tensor]:
        handle = info["handle_position"]
        obs = {"handle_position": handle, "pull": self._direction(self.target.pull, self.handle_link)}
        if self.agent is not None:
            obs["tcp_pose"] = self.agent.tcp.pose.raw_pose
        if self.obs_mode_struct.use_state:
            # Turning about its own axis leaves the axis where it is, so that the child's frame serves.
            obs["axis"] = self._direction(self.target.axis, self.moving_link)
            obs["open_fraction"] = info["open_fraction"]
            if self.agent is not None:
                obs["tcp_to_handle"] = handle - self.agent.tcp.pose.p
        return obs

    def compute_dense_reward(self, obs: Any, action: torch.Tensor, info: dict[str, Any]) -> torch.Tensor:
        """Up to 1 for reaching the handle, 2 to 4 while opening, 5 for success."""
        fraction = info["open_fraction"].clamp(0.0, 1.0)
        if self.agent is None:
            reach = torch.zeros_like(fraction)
        else:
            distance = torch.linalg.norm(self.agent.tcp.pose.p - info["handle_position"], dim=1)
            reach = 1.0 - torch.tanh(5.0 * distance)
        opened = fraction > STARTED_FRACTION
        reward = torch.where(opened, torch.full_like(reach, 2.0), reach) + 2.0 * fraction
        return torch.where(info["success"], torch.full_like(reward, MAX_REWARD), reward)

    def compute_normalized_dense_reward(
        self,
        obs: Any,
        action: torch.Tensor,
        info: dict[str, Any],
    ) -> torch.Tensor:
        """The dense reward divided by its largest value."""
        return self.compute_dense_reward(obs, action, info) / MAX_REWARD
