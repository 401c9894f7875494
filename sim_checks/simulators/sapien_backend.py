"""SAPIEN (PhysX articulations): the only room that says ``sapien`` to judge."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .simulator import LoadedJoint, LoadedLink, LoadedModel
from .twin import write_twin

KINDS = {"revolute_unwrapped": "revolute", "revolute": "continuous", "prismatic": "prismatic"}


class SapienSimulator:
    """SAPIEN on the processor, without a renderer."""

    name = "sapien"
    distribution = "sapien"
    formats = ("urdf",)
    blind_spots = (
        "PhysX never lets parent and child of an articulation touch: a drawer stuck in its own carcass still slides",
        "joint friction of the file is dropped; the sweep runs without joint friction",
    )

    def open(self, path: Path, config: MotionConfig) -> SapienWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        with warnings.catch_warnings():
            # It warns of a missing Vulkan library, which physics does not need.
            warnings.simplefilter("ignore")
            import sapien
        scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
        scene.physx_system.timestep = config.time_step_s
        loader = scene.create_urdf_loader()
        loader.fix_root_link = True
        with tempfile.TemporaryDirectory(prefix="twin-") as folder:
            try:
                articulations, actors, _ = loader.parse(str(write_twin(path, Path(folder))))
                _require_one(len(articulations), len(actors))
                if actors:
                    actors[0].set_physx_body_type("kinematic")
                body = articulations[0].build() if articulations else actors[0].build()
            except Exception as error:
                raise ValueError(f"{type(error).__name__}: {error}") from error
        if not articulations:
            return SapienWorld(scene, None, _actor_model(body))
        leaders = {record.joint: record.mimic for record in articulations[0].mimic_joint_records}
        return SapienWorld(scene, body, _articulation_model(body, leaders))


def _require_one(articulations: int, actors: int) -> None:
    if articulations + actors != 1:
        raise ValueError(f"the file makes {articulations + actors} separate objects (floating joints), not one")


class SapienWorld:
    """One articulation, or one unmoved actor for a file without joints."""

    def __init__(self, scene: Any, articulation: Any | None, model: LoadedModel) -> None:
        self._scene = scene
        self._articulation = articulation
        self._dof = articulation.dof if articulation is not None else 0
        self._active = list(articulation.active_joints) if articulation is not None else []
        self.model = model
        self.joints = model.joints
        self.time_step = float(scene.physx_system.timestep)
        if articulation is not None:
            self._dynamics = articulation.create_pinocchio_model()
            for joint in self._active:
                joint.set_friction(0.0)

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        if self._articulation is not None:
            self._articulation.set_qpos(np.asarray(positions, np.float32))
            self._articulation.set_qvel(np.zeros(self._dof, np.float32))

    def positions(self) -> FloatArray:
        """[rad] or [m], shape [joint_count]."""
        return _vector(self._articulation.qpos) if self._articulation is not None else np.zeros(0)

    def velocities(self) -> FloatArray:
        """[rad/s] or [m/s], shape [joint_count]."""
        return _vector(self._articulation.qvel) if self._articulation is not None else np.zeros(0)

    def inertias(self) -> FloatArray:
        """Diagonal of the mass matrix, shape [joint_count]."""
        matrix = self._dynamics.compute_generalized_mass_matrix(self._articulation.qpos)  # type: ignore[union-attr]
        return np.diag(np.asarray(matrix, np.float64)).copy()

    def carried_masses(self) -> FloatArray:
        """Mass beyond each joint [kg], shape [joint_count]."""
        return np.array([_carried(joint.child_link) for joint in self._active], np.float64)

    def balance(self) -> FloatArray:
        """Forces against gravity and velocity effects, shape [joint_count]."""
        if self._articulation is None:
            return np.zeros(0)
        return _vector(self._articulation.compute_passive_force(True, True))

    def step(self, forces: FloatArray) -> None:
        """One time step with these joint forces."""
        if self._articulation is not None:
            self._articulation.set_qf(np.asarray(forces, np.float32))
        self._scene.step()

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world."""
        if self._articulation is None:
            return {link.name: np.eye(4) for link in self.model.links}
        return {link.name: _matrix(link.entity_pose) for link in self._articulation.links}

    def warnings(self) -> tuple[str, ...]:
        """PhysX has none that can be asked for."""
        return ()


def _actor_model(actor: Any) -> LoadedModel:
    import sapien

    body = next(c for c in actor.components if isinstance(c, sapien.physx.PhysxRigidBaseComponent))
    link = LoadedLink(actor.name, 0.0, len(body.collision_shapes), None, static=True)
    return LoadedModel((link,), (), ())


def _articulation_model(articulation: Any, leaders: Mapping[str, str]) -> LoadedModel:
    links = tuple(
        LoadedLink(
            link.name,
            float(link.mass),
            len(link.collision_shapes),
            _sorted(link.inertia),
            _triple(link.cmass_local_pose.p),
        )
        for link in articulation.links
    )
    joints = tuple(
        LoadedJoint(
            joint.name,
            KINDS.get(joint.type, joint.type),
            float(joint.limit[0][0]),
            float(joint.limit[0][1]),
            float(joint.damping),
            None,
            leaders.get(joint.name),
        )
        for joint in articulation.active_joints
    )
    return LoadedModel(links, joints, ())


def _carried(link: Any) -> float:
    return float(link.mass) + sum(_carried(child) for child in link.children)


def _sorted(moments: Any) -> tuple[float, float, float]:
    return _triple(sorted(moments))


def _triple(values: Any) -> tuple[float, float, float]:
    a, b, c = (float(v) for v in values)
    return a, b, c


def _vector(values: Any) -> FloatArray:
    return np.asarray(values, np.float64).ravel()


def _matrix(pose: Any) -> FloatArray:
    return np.asarray(pose.to_transformation_matrix(), np.float64)
