"""PyBullet: the only room that says ``pybullet`` to judge."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .simulator import LoadedJoint, LoadedLink, LoadedModel
from .twin import write_twin

BASE = -1
#: With Bullet's own 0.02 m, parts that do not touch jam; the setting outlives a connection, so it is always made.
CONTACT_BREAKING_M = 0.001
GRAVITY = -9.81


class PybulletSimulator:
    """PyBullet without a window."""

    name = "pybullet"
    distribution = "pybullet"
    formats = ("urdf",)
    blind_spots = (
        "Bullet keeps a margin of 1 mm around every mesh hull: parts less than 2 mm apart already touch",
        "Bullet's overlap across a joint's axis of travel exerts no force: a drawer wider than its bay still slides",
        "Bullet holds the base as a static body: its mass and inertia are not compared",
    )

    def open(self, path: Path, config: MotionConfig) -> PybulletWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        import pybullet

        client = pybullet.connect(pybullet.DIRECT)
        pybullet.setPhysicsEngineParameter(
            contactBreakingThreshold=CONTACT_BREAKING_M,
            deterministicOverlappingPairs=1,
            enableFileCaching=0,
            physicsClientId=client,
        )
        pybullet.setTimeStep(config.time_step_s, physicsClientId=client)
        pybullet.setGravity(0.0, 0.0, GRAVITY, physicsClientId=client)
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_SELF_COLLISION
        if config.parents_touch:
            flags |= pybullet.URDF_USE_SELF_COLLISION_INCLUDE_PARENT
        with tempfile.TemporaryDirectory(prefix="twin-") as folder:
            twin = str(write_twin(path, Path(folder)))
            try:
                body = pybullet.loadURDF(twin, useFixedBase=True, flags=flags, physicsClientId=client)
            except pybullet.error as error:
                raise ValueError(str(error).replace(str(folder), "").strip()) from error
        return PybulletWorld(pybullet, client, body, config.time_step_s)


class PybulletWorld:
    """One multibody in one physics client."""

    def __init__(self, pybullet: Any, client: int, body: int, time_step: float) -> None:
        self._bullet, self._client, self._body = pybullet, {"physicsClientId": client}, body
        self.time_step = time_step
        infos = [self._info(i) for i in range(pybullet.getNumJoints(body, **self._client))]
        moving = [info for info in infos if info[2] != pybullet.JOINT_FIXED]
        self._ids = [info[0] for info in moving]
        self._names = {BASE: pybullet.getBodyInfo(body, **self._client)[0].decode()}
        self._names |= {info[0]: info[12].decode() for info in infos}
        self._parents = {info[0]: info[16] for info in infos}
        self.joints = tuple(_joint(info, pybullet) for info in moving)
        self.model = LoadedModel(tuple(self._link(i) for i in self._names), self.joints, ())
        for i, joint in zip(self._ids, self.joints, strict=True):
            # A motor at rest with the joint's friction as its strength: Bullet's own idiom for friction.
            pybullet.setJointMotorControl2(
                body, i, pybullet.VELOCITY_CONTROL, targetVelocity=0.0, force=joint.friction or 0.0, **self._client
            )

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        for i, value in zip(self._ids, positions, strict=True):
            self._bullet.resetJointState(self._body, i, float(value), 0.0, **self._client)

    def positions(self) -> FloatArray:
        """[rad] or [m], shape [joint_count]."""
        return self._states(0)

    def velocities(self) -> FloatArray:
        """[rad/s] or [m/s], shape [joint_count]."""
        return self._states(1)

    def inertias(self) -> FloatArray:
        """Diagonal of the mass matrix, shape [joint_count]."""
        if not self._ids:
            return np.zeros(0)
        matrix = self._bullet.calculateMassMatrix(self._body, list(self.positions()), **self._client)
        return np.diag(np.array(matrix, np.float64)).copy()

    def carried_masses(self) -> FloatArray:
        """Mass beyond each joint [kg], shape [joint_count]."""
        carried = dict.fromkeys(self._names, 0.0)
        for i, link in zip(self._names, self.model.links, strict=True):
            at = i
            while at != BASE:
                carried[at] += link.mass
                at = self._parents[at]
        return np.array([carried[i] for i in self._ids], np.float64)

    def balance(self) -> FloatArray:
        """Forces against gravity and velocity effects, shape [joint_count]."""
        if not self._ids:
            return np.zeros(0)
        position, velocity = list(self.positions()), list(self.velocities())
        still = [0.0] * len(self._ids)
        return np.array(
            self._bullet.calculateInverseDynamics(self._body, position, velocity, still, **self._client), np.float64
        )

    def step(self, forces: FloatArray) -> None:
        """One time step with these joint forces."""
        if self._ids:
            self._bullet.setJointMotorControlArray(
                self._body, self._ids, self._bullet.TORQUE_CONTROL, forces=list(forces), **self._client
            )
        self._bullet.stepSimulation(**self._client)

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world; the base was put at the origin."""
        poses = {self._names[BASE]: np.eye(4)}
        for i, name in self._names.items():
            if i != BASE:
                state = self._bullet.getLinkState(self._body, i, computeForwardKinematics=1, **self._client)
                pose = np.eye(4)
                pose[:3, :3] = np.reshape(self._bullet.getMatrixFromQuaternion(state[5]), (3, 3))
                pose[:3, 3] = state[4]
                poses[name] = pose
        return poses

    def warnings(self) -> tuple[str, ...]:
        """Bullet counts none."""
        return ()

    def _info(self, i: int) -> Any:
        return self._bullet.getJointInfo(self._body, i, **self._client)

    def _states(self, field: int) -> FloatArray:
        if not self._ids:
            return np.zeros(0)
        states = self._bullet.getJointStates(self._body, self._ids, **self._client)
        return np.array([state[field] for state in states], np.float64)

    def _link(self, i: int) -> LoadedLink:
        dynamics = self._bullet.getDynamicsInfo(self._body, i, **self._client)
        shapes = len(self._bullet.getCollisionShapeData(self._body, i, **self._client))
        if i == BASE:
            return LoadedLink(self._names[i], 0.0, shapes, None, static=True)
        a, b, c = sorted(float(m) for m in dynamics[2])
        x, y, z = (float(v) for v in dynamics[3])
        return LoadedLink(self._names[i], float(dynamics[0]), shapes, (a, b, c), (x, y, z))


def _joint(info: Any, pybullet: Any) -> LoadedJoint:
    words = {pybullet.JOINT_REVOLUTE: "revolute", pybullet.JOINT_PRISMATIC: "prismatic"}
    kind = words.get(info[2], f"type {info[2]}")
    lower, upper = float(info[8]), float(info[9])
    if lower > upper:
        lower, upper = -math.inf, math.inf
        kind = "continuous" if kind == "revolute" else kind
    return LoadedJoint(info[1].decode(), kind, lower, upper, float(info[6]), float(info[7]))
