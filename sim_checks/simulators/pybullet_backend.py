"""PyBullet: the only module of the checks that imports it."""

from __future__ import annotations

import math
import tempfile
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray, Mimic
from ..geometry.coupling import sound_chains
from ..geometry.placing import rigid
from ..read.srdf import exempt_pairs
from ..read.urdf import read_mimics
from .pybullet_dynamics import Dynamics
from .simulator import LoadedJoint, LoadedLink, LoadedModel, PairRules, Touch, triple
from .twin import write_twin

BASE = -1
#: With Bullet's own 0.02 m, parts that do not touch jam; the setting outlives a connection, so it
#: is always made.
CONTACT_BREAKING_M = 0.001
BULLETS_OWN_BREAKING_M = 0.02
GRAVITY = -9.81
#: How much of a gear's error is made up in one step, and by how much force at most [N] or [N m].
GEAR_ERP = 0.2
GEAR_FORCE = 1e6


class PybulletSimulator:
    """PyBullet without a window."""

    name = "pybullet"
    distribution = "pybullet"
    formats = ("urdf",)
    soft_friction = ()
    blind_spots = (
        (
            "Bullet keeps a margin of 1 mm around every mesh hull: "
            "parts less than 2 mm apart already touch"
        ),
        (
            "Bullet's overlap across a joint's axis of travel exerts no force: "
            "a drawer wider than its bay still slides"
        ),
        "Bullet holds the base as a static body: its mass and inertia are not compared",
        "Bullet reads no list of exempt pairs: those of the SRDF beside a URDF are made so here",
        (
            "Bullet reads no <mimic>: joints that follow others are coupled by gears here, "
            "as whoever simulates must do"
        ),
    )

    def open(self, path: Path, config: MotionConfig) -> PybulletWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        import pybullet

        # To Bullet, a gear of ratio 0 is one whose ratio was not told.
        mimics = {
            name: mimic
            for name, mimic in sound_chains(read_mimics(path)).items()
            if mimic.multiplier != 0.0
        }
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
                body = pybullet.loadURDF(
                    twin, useFixedBase=True, flags=flags, physicsClientId=client
                )
            except pybullet.error as error:
                pybullet.disconnect(client)
                raise ValueError(str(error).replace(str(folder), "").strip()) from error
        return PybulletWorld(pybullet, client, body, config, mimics, exempt_pairs(path))


class PybulletWorld:
    """One multibody in one physics client; joints that follow others in the file are made to."""

    def __init__(
        self,
        pybullet: Any,
        client: int,
        body: int,
        config: MotionConfig,
        mimics: Mapping[str, Mimic],
        exempt: frozenset[frozenset[str]],
    ) -> None:
        self._bullet = pybullet
        self._client = {"physicsClientId": client}
        self._body = body
        self.time_step = config.time_step_s
        # One process opens many worlds, and a client keeps some 25 MB until it is told to go.
        self._end = weakref.finalize(self, _disconnect, pybullet, client)
        count = pybullet.getNumJoints(body, **self._client)
        infos = [pybullet.getJointInfo(body, i, **self._client) for i in range(count)]
        moving = [info for info in infos if info[2] != pybullet.JOINT_FIXED]
        self._ids = [info[0] for info in moving]
        self._names = {BASE: pybullet.getBodyInfo(body, **self._client)[0].decode()}
        self._names |= {info[0]: info[12].decode() for info in infos}
        self._parents = {info[0]: info[16] for info in infos}
        self.joints = tuple(self._joint(info, mimics) for info in moving)
        self._couple()
        rules = PairRules(
            config.parents_touch,
            static_parent=config.parents_touch,
            excluded=self._let_pass(exempt),
        )
        self.model = LoadedModel(tuple(self._link(i) for i in self._names), self.joints, (), rules)
        beyond = [[k for k in self._names if self._is_beyond(k, i)] for i in self._ids]
        self.carried = tuple(frozenset(self._names[k] for k in group) for group in beyond)
        slides = [info[2] == pybullet.JOINT_PRISMATIC for info in moving]
        self._dynamics = Dynamics(pybullet, body, self._ids, slides, beyond, self._client)
        self._falls = True
        self._state: FloatArray | None = None
        for i, joint in zip(self._ids, self.joints, strict=True):
            # A motor at rest with the joint's friction as its strength: Bullet's own idiom for
            # friction.
            pybullet.setJointMotorControl2(
                body,
                i,
                pybullet.VELOCITY_CONTROL,
                targetVelocity=0.0,
                force=joint.friction or 0.0,
                **self._client,
            )

    def weigh(self, on: bool) -> None:
        """Turn gravity on or off; Bullet has no springs in joints."""
        self._falls = on
        self._bullet.setGravity(0.0, 0.0, GRAVITY if on else 0.0, **self._client)

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        self._state = None
        for i, value in zip(self._ids, positions, strict=True):
            self._bullet.resetJointState(self._body, i, float(value), 0.0, **self._client)

    def positions(self) -> FloatArray:
        """Return joint values [rad] or [m], shape [joint_count]."""
        return np.array(self._states()[0], np.float64)

    def velocities(self) -> FloatArray:
        """Return joint speeds [rad/s] or [m/s], shape [joint_count]."""
        return np.array(self._states()[1], np.float64)

    def mass_matrix(self) -> FloatArray:
        """Return the joints' mass matrix [kg m2], [kg m] or [kg], [joint_count, joint_count]."""
        return self._dynamics.mass_matrix(self._states()[0]) if self._ids else np.zeros((0, 0))

    def energy(self) -> float:
        """Return the kinetic energy, and potential energy of gravity if it is on [J]."""
        if not self._ids:
            return 0.0
        position, velocity = self._states()
        kinetic = self._dynamics.kinetic(position, velocity)
        if not self._falls:
            return kinetic
        links = [i for i in self._names if i != BASE]
        states = self._bullet.getLinkStates(
            self._body, links, computeForwardKinematics=1, **self._client
        )
        masses = [
            link.mass for i, link in zip(self._names, self.model.links, strict=True) if i != BASE
        ]
        return kinetic - GRAVITY * float(
            sum(m * state[0][2] for m, state in zip(masses, states, strict=True))
        )

    def balance(self) -> FloatArray:
        """Return the forces against gravity and velocity effects, shape [joint_count]."""
        if not self._ids:
            return np.zeros(0)
        position, velocity = self._states()
        return self._dynamics.balance(position, velocity, GRAVITY if self._falls else 0.0)

    def step(self, forces: FloatArray) -> None:
        """Make one time step with these joint forces."""
        if self._ids:
            self._bullet.setJointMotorControlArray(
                self._body,
                self._ids,
                self._bullet.TORQUE_CONTROL,
                forces=forces.tolist(),
                **self._client,
            )
        self._bullet.stepSimulation(**self._client)
        self._state = None

    def contacts(self) -> dict[tuple[str, str], Touch]:
        """Return which links touched in the last step."""
        found: dict[tuple[str, str], Touch] = {}
        for point in self._bullet.getContactPoints(self._body, self._body, **self._client):
            a, b = sorted((int(point[3]), int(point[4])))
            pair = (self._names[a], self._names[b])
            touch = Touch(float(point[9]), -float(point[8]))
            found[pair] = found[pair] + touch if pair in found else touch
        return found

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world; the base was put at the origin."""
        poses = {self._names[BASE]: np.eye(4)}
        for i, name in self._names.items():
            if i != BASE:
                state = self._bullet.getLinkState(
                    self._body, i, computeForwardKinematics=1, **self._client
                )
                poses[name] = rigid(self._turn(state[5]), np.array(state[4]))
        return poses

    def warnings(self) -> tuple[str, ...]:
        """Return none: Bullet counts no warnings."""
        return ()

    def close(self) -> None:
        """Disconnect; the one setting that outlives a connection goes back to Bullet's own."""
        self._end()

    def _let_pass(self, exempt: frozenset[frozenset[str]]) -> tuple[tuple[str, str], ...]:
        """Have pairs of links pass through each other; returns those that are there."""
        ids = {name: index for index, name in self._names.items()}
        pairs = tuple((a, b) for a, b in sorted(map(sorted, exempt)) if a in ids and b in ids)
        for a, b in pairs:
            self._bullet.setCollisionFilterPair(
                self._body, self._body, ids[a], ids[b], 0, **self._client
            )
        return pairs

    def _couple(self) -> None:
        """Couple joints by Bullet's gears between joints of one body.

        Gears hold positions, too, and slides as well as hinges.
        """
        numbers = {joint.name: i for i, joint in zip(self._ids, self.joints, strict=True)}
        for joint in self.joints:
            if joint.mimic is None or joint.mimic.leader not in numbers:
                continue
            ends = (numbers[joint.name], self._body, numbers[joint.mimic.leader])
            nothing = [0.0, 0.0, 0.0]
            kind = self._bullet.JOINT_GEAR
            gear = self._bullet.createConstraint(
                self._body, *ends, kind, [0.0, 0.0, 1.0], nothing, nothing, **self._client
            )
            self._bullet.changeConstraint(
                gear,
                gearRatio=-joint.mimic.multiplier,
                relativePositionTarget=joint.mimic.offset,
                erp=GEAR_ERP,
                maxForce=GEAR_FORCE,
                **self._client,
            )

    def _is_beyond(self, link: int, joint: int) -> bool:
        while link not in (BASE, joint):
            link = self._parents[link]
        return link == joint

    def _states(self) -> FloatArray:
        """Return positions and velocities, shape [2, joint_count]; read once a step."""
        if self._state is None:
            states: Any = ()
            if self._ids:
                states = self._bullet.getJointStates(self._body, self._ids, **self._client)
            self._state = np.array([[state[k] for state in states] for k in (0, 1)], np.float64)
        return self._state

    def _link(self, i: int) -> LoadedLink:
        dynamics = self._bullet.getDynamicsInfo(self._body, i, **self._client)
        shapes = len(self._bullet.getCollisionShapeData(self._body, i, **self._client))
        friction = float(dynamics[1]) if shapes else None
        if i == BASE:
            return LoadedLink(self._names[i], 0.0, shapes, None, static=True, friction=friction)
        mass = float(dynamics[0])
        moments = triple(sorted(dynamics[2]))
        center = triple(dynamics[3])
        return LoadedLink(self._names[i], mass, shapes, moments, center, friction=friction)

    def _turn(self, quaternion: Any) -> FloatArray:
        return np.reshape(self._bullet.getMatrixFromQuaternion(quaternion), (3, 3))

    def _joint(self, info: Any, mimics: Mapping[str, Mimic]) -> LoadedJoint:
        bullet = self._bullet
        words = {bullet.JOINT_REVOLUTE: "revolute", bullet.JOINT_PRISMATIC: "prismatic"}
        name = info[1].decode()
        kind = words.get(info[2], f"type {info[2]}")
        lower, upper, damping, friction = (float(info[i]) for i in (8, 9, 6, 7))
        if lower > upper:
            lower = -math.inf
            upper = math.inf
            kind = "continuous" if kind == "revolute" else kind
        # Bullet holds the axis in the principal frame of the link, here given by its turn.
        inertial = self._turn(bullet.getDynamicsInfo(self._body, info[0], **self._client)[4])
        axis = triple(inertial @ np.array(info[13])) if info[2] in words else None
        mimic = mimics.get(name)
        forced = mimic is not None
        return LoadedJoint(name, kind, lower, upper, damping, friction, axis, mimic, forced)


def _disconnect(pybullet: Any, client: int) -> None:
    pybullet.setPhysicsEngineParameter(
        contactBreakingThreshold=BULLETS_OWN_BREAKING_M, physicsClientId=client
    )
    pybullet.disconnect(client)
