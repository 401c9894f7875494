"""The scene of every task: the assets of a registry, a robot before each, and its builders."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import sapien  # noqa: TID253 - this module is only imported to make an environment
import torch  # noqa: TID253
from mani_skill.envs.sapien_env import BaseEnv  # noqa: TID253
from mani_skill.sensors.camera import CameraConfig  # noqa: TID253
from mani_skill.utils import sapien_utils  # noqa: TID253
from mani_skill.utils.structs import Articulation  # noqa: TID253
from mani_skill.utils.structs.types import GPUMemoryConfig, SimConfig  # noqa: TID253

from asset_factory.factory.registry.entry import Split

from ..assets import OpenableJoint, RegisteredAsset, read_registry
from ..loading import build_ground, invisible_robots, load_asset, resist, warn_of_hulls
from ..placement import CAMERA_FOV, Place, camera_place, facing_of, find_place
from ..robots import ROBOTS
from ..selection import Wanted, select
from ..targets import Targets
from . import arguments

#: What is drawn for an episode, in this order, each uniform in [0, 1).
DRAWS = ("asset", "joint", "start", "goal", "x", "y", "yaw", "friction", "damping")


class JointScene(BaseEnv):  # type: ignore[misc]
    """A robot before an object, one of whose joints it is to move.

    Which asset and which joint, where it starts and what the goal is are drawn from the episode's
    random generator: the same seed gives the same episode, alone or among others.
    ``reset(options={"asset": ID, "joint": NAME})`` decides for one episode. On a GPU every
    environment keeps its asset until ``options={"reconfigure": True}``.

    Args:
        registry: folder that ``factory build --output`` wrote.
        asset, joint: id of the only asset, name of the only joint; ``None`` draws one per episode.
        category: of the objects, one or several.
        joint_type: ``revolute``, ``prismatic``, ``continuous``, or several of them.
        split: ``train`` or ``test``; which an asset belongs to follows from its id alone.
        verdict: ``passed``, or ``clean`` for assets validated without a single finding.
        friction_range, damping_range: random factors on what the asset's manifest states.
        robot_uids: ``panda`` is mounted at a height that suits the handle, ``fetch`` stands on the
            floor, ``none`` leaves the object alone.
        render_backend: ``auto`` renders only if ``obs_mode`` or ``render_mode`` need it.

    Raises:
        RegistryError: no registry, nothing in it that passes the filters; an asset deleted or
            altered since.
        ConfigError: a robot, filter or backend that does not exist, or pictures where nothing can
            render.
    """

    SUPPORTED_ROBOTS: ClassVar[list[str]] = [*ROBOTS, "none"]
    #: What the task is about; a user's ``joint_type`` narrows it further.
    joint_types: ClassVar[tuple[str, ...]] = ()
    min_lever: ClassVar[float] = 0.0
    #: How far open the joint may be when the episode begins, shares of its range: a robot's place
    #: is sought for each.
    starts: ClassVar[tuple[float, ...]] = (0.0,)

    def __init__(
        self,
        *args: Any,
        registry: str | Path,
        asset: str | None = None,
        joint: str | None = None,
        category: str | tuple[str, ...] | None = None,
        joint_type: str | tuple[str, ...] | None = None,
        split: Split | None = None,
        verdict: str = "passed",
        friction_range: tuple[float, float] = (1.0, 1.0),
        damping_range: tuple[float, float] = (1.0, 1.0),
        robot_uids: str = "panda",
        num_envs: int = 1,
        obs_mode: str = "state",
        render_mode: str | None = None,
        reconfiguration_freq: int | None = None,
        sim_backend: str = "auto",
        render_backend: str | None = "auto",
        **kwargs: Any,
    ) -> None:
        task = type(self).__name__
        arguments.check_robot(task, robot_uids, self.SUPPORTED_ROBOTS)
        on_gpu = arguments.check_number(task, num_envs, sim_backend)
        ranges = {"friction": friction_range, "damping": damping_range}
        self._factors = {
            name: arguments.check_range(task, f"{name}_range", each)
            for name, each in ranges.items()
        }
        backend = arguments.choose_renderer(task, obs_mode, render_mode, render_backend)
        everything = read_registry(registry)
        # Options may ask for an asset that the filters leave out, but not for one that the task is
        # not about.
        self._about = Wanted(joint_types=self.joint_types, min_lever=self.min_lever)
        self._available = everything
        kinds = arguments.common_types(task, arguments.words(joint_type), self.joint_types)
        categories = arguments.words(category)
        wanted = Wanted(asset, joint, categories, kinds, split, verdict, self.min_lever)
        self._assets = select(everything, wanted)
        self._admitted = select(everything, self._about)
        if on_gpu:
            warn_of_hulls(self._assets.values())
        self._places: dict[tuple[str, str, float], Place] = {}
        self.assets: tuple[RegisteredAsset, ...] = ()
        if reconfiguration_freq is None:
            reconfiguration_freq = 0 if len(self._assets) == 1 or num_envs > 1 else 1
        with arguments.needing_renderer(task, obs_mode, render_mode, backend):
            super().__init__(
                *args,
                robot_uids=robot_uids,
                num_envs=num_envs,
                obs_mode=obs_mode,
                render_mode=render_mode,
                reconfiguration_freq=reconfiguration_freq,
                sim_backend=sim_backend,
                render_backend=backend,
                **kwargs,
            )

    # Which asset, which joint.

    def reset(
        self, seed: int | list[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start an episode; ``options`` takes ``asset``, ``joint`` and ManiSkill's own keys."""
        options = dict(options or {})
        acceptable = self._acceptable(options)
        if any(asset.id not in acceptable for asset in self.assets):
            options["reconfigure"] = True
        return super().reset(seed=seed, options=options)  # type: ignore[no-any-return]

    def _acceptable(self, options: dict[str, Any]) -> dict[str, RegisteredAsset]:
        """Return what the episode may be about."""
        asset = options.get("asset")
        joint = options.get("joint")
        if asset is None and joint is None:
            return self._assets
        if joint is None and asset in self._assets:
            return {asset: self._assets[asset]}
        among = self._available
        if asset is None:
            among = {key: among[key] for key in self._assets}
        return select(among, replace(self._about, asset=asset, joint=joint))

    def _draw(self, env_idx: torch.Tensor) -> dict[str, torch.Tensor]:
        """Draw an episode's random numbers by name, shape [chosen]; rebuilt scenes keep them."""
        numbers = self._batched_episode_rng[env_idx].uniform(size=len(DRAWS))
        columns = torch.tensor(numbers, dtype=torch.float64, device=self.device)
        return dict(zip(DRAWS, columns.unbind(1), strict=True))

    # Building the scene.

    @property
    def _default_sim_config(self) -> SimConfig:
        memory = GPUMemoryConfig(max_rigid_contact_count=2**21, max_rigid_patch_count=2**19)
        return SimConfig(spacing=5, gpu_memory_config=memory)

    def _load_agent(self, options: dict[str, Any]) -> None:
        with invisible_robots(self.scene):
            super()._load_agent(options, sapien.Pose(p=[0.0, -3.0, 0.0]))

    def _load_scene(self, options: dict[str, Any]) -> None:
        self.ground = build_ground(self.scene)
        if self.robot_uids == "fetch":
            from mani_skill.agents.robots.fetch import FETCH_WHEELS_COLLISION_BIT

            self.ground.set_collision_group_bit(group=2, bit_idx=FETCH_WHEELS_COLLISION_BIT, bit=1)
        draws = self._draw(torch.arange(self.num_envs))
        ids = sorted(self._acceptable(options))
        drawn = (ids[int(draw * len(ids))] for draw in draws["asset"].tolist())
        self.assets = tuple(self._admitted[id] for id in drawn)
        names = ["asset"] if self.num_envs == 1 else [f"asset-{i}" for i in range(self.num_envs)]
        named = enumerate(zip(self.assets, names, strict=True))
        self._parts = [load_asset(self.scene, asset, name, i) for i, (asset, name) in named]
        self._resist(torch.arange(self.num_envs), draws)
        if self.num_envs == 1:
            self.asset = self._parts[0]
        else:
            for part in self._parts:
                self.remove_from_state_dict_registry(part)
            self.asset = Articulation.merge(self._parts, name="asset")
            self.add_to_state_dict_registry(self.asset)
        self._prepare_targets()

    def _prepare_targets(self) -> None:
        narrowed = (self._assets.get(asset.id, asset) for asset in self.assets)
        allowed = [[joint.name for joint in asset.openable] for asset in narrowed]
        self.targets = Targets(self.assets, self._parts, allowed, self.scene.px)
        self._closed = torch.zeros(self.num_envs, self.asset.max_dof, device=self.device)
        for row, (asset, part) in enumerate(zip(self.assets, self._parts, strict=True)):
            for column, joint in enumerate(part.active_joints):
                self._closed[row, column] = asset.closed_value(joint.name)

    def _after_reconfigure(self, options: dict[str, Any]) -> None:
        self.targets.find_bodies()

    def _place(self, asset: RegisteredAsset, joint: OpenableJoint, start: float) -> Place:
        key = (asset.id, joint.name, start)
        if key not in self._places:
            spread = 0.5 / (len(self.starts) - 1) if len(self.starts) > 1 else 0.0
            robot = ROBOTS[str(self.robot_uids)]
            self._places[key] = find_place(asset, joint, robot, start=start, spread=spread)
        return self._places[key]

    def _resist(self, env_idx: torch.Tensor, draws: dict[str, torch.Tensor]) -> None:
        factors = {}
        for name, (lower, upper) in self._factors.items():
            factors[name] = (lower + draws[name] * (upper - lower)).tolist()
        pairs = zip(factors["friction"], factors["damping"], strict=True)
        for index, (friction, damping) in zip(env_idx.tolist(), pairs, strict=True):
            resist(self._parts[index], self.assets[index], friction, damping)

    # Cameras.

    @property
    def _default_sensor_configs(self) -> list[CameraConfig]:
        return [self._camera("base_camera", 128)]

    @property
    def _default_human_render_camera_configs(self) -> CameraConfig:
        return self._camera("render_camera", 512)

    def _camera(self, name: str, pixels: int) -> CameraConfig:
        places = []
        for asset in self.assets:
            direction = facing_of(asset, asset.openable[0])
            places.append([end.tolist() for end in camera_place(asset.standing_bounds, direction)])
        eyes, middles = torch.tensor(places, device=self.device).unbind(1)
        pose = sapien_utils.look_at(eyes, middles, device=self.device)
        lens = {"fov": CAMERA_FOV, "near": 0.01, "far": 100.0}
        return CameraConfig(name, pose=pose, width=pixels, height=pixels, **lens)
