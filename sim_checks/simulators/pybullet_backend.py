"""PyBullet: the only module of the checks that imports it."""

from __future__ import annotations

import math
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray, Mimic
from ..geometry.coupling import sound_chains
from ..geometry.placing import rigid
from ..geometry.statics import GRAVITY
from ..read.urdf import exempt_pairs, read_mimics
from .pybullet_dynamics import BulletClient, Dynamics
from .simulator import Simulator
from .twin import twin_of
from .world import LoadedJoint, LoadedLink, LoadedModel, PairRules, Touches, World, triple

BASE = -1
#: With Bullet's own 0.02 m, parts that do not touch jam; the setting outlives a connection, so it
#: is always made.
CONTACT_BREAKING_M = 0.001
BULLETS_OWN_BREAKING_M = 0.02
#: How much of a gear's error is made up in one step, and by how much force at most [N] or [N m].
GEAR_ERP = 0.2
GEAR_FORCE = 1e6


class PybulletSimulator(Simulator):
    """PyBullet without a window."""

    name = "pybullet"
    distribution = "pybullet"
    formats = ("urdf",)
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
        sound = sound_chains(read_mimics(path))
        mimics = {name: mimic for name, mimic in sound.items() if mimic.multiplier != 0.0}
        client = BulletClient(pybullet)
        client.setPhysicsEngineParameter(
            contactBreakingThreshold=CONTACT_BREAKING_M,
            deterministicOverlappingPairs=1,
            enableFileCaching=0,
        )
        client.setTimeStep(config.time_step_s)
        client.setGravity(0.0, 0.0, -GRAVITY)
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_SELF_COLLISION
        if config.parents_touch:
            flags |= pybullet.URDF_USE_SELF_COLLISION_INCLUDE_PARENT
        with twin_of(path) as twin:
            try:
                body = client.loadURDF(twin, useFixedBase=True, flags=flags)
            except pybullet.error as error:
                client.disconnect()
                raise ValueError(str(error).replace(str(Path(twin).parent), "").strip()) from error
        return PybulletWorld(client, body, config, mimics, exempt_pairs(path))


class PybulletWorld(World):
    """One multibody in one physics client; joints that follow others in the file are made to."""

    def __init__(
        self,
        bullet: BulletClient,
        body: int,
        config: MotionConfig,
        mimics: Mapping[str, Mimic],
        exempt: frozenset[frozenset[str]],
    ) -> None:
        self._bullet = bullet
        self._body = body
        self.time_step = config.time_step_s
        # One process opens many worlds, and a client keeps some 25 MB until it is told to go.
        self._end = weakref.finalize(self, _disconnect, bullet)
        infos = [bullet.getJointInfo(body, i) for i in range(bullet.getNumJoints(body))]
        moving = [info for info in infos if info[2] != bullet.JOINT_FIXED]
        self._ids = [info[0] for info in moving]
        self._names = {BASE: bullet.getBodyInfo(body)[0].decode()}
        self._names |= {info[0]: info[12].decode() for info in infos}
        self._parents = {info[0]: info[16] for info in infos}
        self.joints = tuple(self._joint(info, mimics) for info in moving)
        self._couple()
        touch = config.parents_touch
        rules = PairRules(touch, static_parent=touch, excluded=self._let_pass(exempt))
        self.model = LoadedModel(tuple(self._link(i) for i in self._names), self.joints, rules)
        beyond = {i: [k for k in self._names if self._is_beyond(k, i)] for i in self._ids}
        self.carried = tuple(frozenset(self._names[k] for k in beyond[i]) for i in self._ids)
        self._dynamics = Dynamics(bullet, body, beyond)
        self._falls = True
        self._state: FloatArray | None = None
        for i, joint in zip(self._ids, self.joints, strict=True):
            # A motor at rest with the joint's friction as its strength: Bullet's own idiom for
            # friction.
            motor = {"targetVelocity": 0.0, "force": joint.friction or 0.0}
            bullet.setJointMotorControl2(body, i, bullet.VELOCITY_CONTROL, **motor)

    def weigh(self, on: bool) -> None:
        """Turn gravity on or off; Bullet has no springs in joints."""
        self._falls = on
        self._bullet.setGravity(0.0, 0.0, -GRAVITY if on else 0.0)

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        self._state = None
        for i, value in zip(self._ids, positions, strict=True):
            self._bullet.resetJointState(self._body, i, float(value), 0.0)

    def positions(self) -> FloatArray:
        """Return joint values [rad] or [m], shape [joint_count]."""
        return np.array(self._states()[0], np.float64)

    def velocities(self) -> FloatArray:
        """Return joint speeds [rad/s] or [m/s], shape [joint_count]."""
        return np.array(self._states()[1], np.float64)

    def mass_matrix(self) -> FloatArray:
        """Return the joints' mass matrix [kg m2], [kg m] or [kg], [joint_count, joint_count]."""
        return self._dynamics.mass_matrix(self._states()[0])

    def energy(self) -> float:
        """Return the kinetic energy, and potential energy of gravity if it is on [J]."""
        velocity = self.velocities()
        kinetic = 0.5 * float(velocity @ self.mass_matrix() @ velocity)
        if not self._falls:
            return kinetic
        # The base, which is the first, stands.
        links = list(self._names)[1:]
        states = self._bullet.getLinkStates(self._body, links, computeForwardKinematics=1)
        moved = zip(self.model.links[1:], states, strict=True)
        return kinetic + GRAVITY * float(sum(link.mass * state[0][2] for link, state in moved))

    def balance(self) -> FloatArray:
        """Return the forces against gravity and velocity effects, shape [joint_count]."""
        position, velocity = self._states()
        return self._dynamics.balance(position, velocity, -GRAVITY if self._falls else 0.0)

    def step(self, forces: FloatArray) -> None:
        """Make one time step with these joint forces."""
        torques = (self._ids, self._bullet.TORQUE_CONTROL)
        self._bullet.setJointMotorControlArray(self._body, *torques, forces=forces.tolist())
        self._bullet.stepSimulation()
        self._state = None

    def contacts(self) -> Touches:
        """Return which links touched in the last step."""
        found = Touches()
        for point in self._bullet.getContactPoints(self._body, self._body):
            a, b = sorted((int(point[3]), int(point[4])))
            found.add((self._names[a], self._names[b]), float(point[9]), -float(point[8]))
        return found

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world; the base was put at the origin."""
        poses = {self._names[BASE]: np.eye(4)}
        for i, name in self._names.items():
            if i != BASE:
                state = self._bullet.getLinkState(self._body, i, computeForwardKinematics=1)
                poses[name] = rigid(self._turn(state[5]), np.array(state[4]))
        return poses

    def close(self) -> None:
        """Disconnect; the one setting that outlives a connection goes back to Bullet's own."""
        self._end()

    def _let_pass(self, exempt: frozenset[frozenset[str]]) -> tuple[tuple[str, str], ...]:
        """Have pairs of links pass through each other; returns those that are there."""
        ids = {name: index for index, name in self._names.items()}
        pairs = tuple((a, b) for a, b in sorted(map(sorted, exempt)) if a in ids and b in ids)
        for a, b in pairs:
            self._bullet.setCollisionFilterPair(self._body, self._body, ids[a], ids[b], 0)
        return pairs

    def _couple(self) -> None:
        """Couple joints by Bullet's gears between joints of one body.

        Gears hold positions, too, and slides as well as hinges.
        """
        numbers = {joint.name: i for i, joint in zip(self._ids, self.joints, strict=True)}
        for joint in self.joints:
            if joint.mimic is None or joint.mimic.leader not in numbers:
                continue
            ends = (self._body, numbers[joint.name], self._body, numbers[joint.mimic.leader])
            frames = ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
            gear = self._bullet.createConstraint(*ends, self._bullet.JOINT_GEAR, *frames)
            self._bullet.changeConstraint(
                gear,
                gearRatio=-joint.mimic.multiplier,
                relativePositionTarget=joint.mimic.offset,
                erp=GEAR_ERP,
                maxForce=GEAR_FORCE,
            )

    def _is_beyond(self, link: int, joint: int) -> bool:
        while link not in (BASE, joint):
            link = self._parents[link]
        return link == joint

    def _states(self) -> FloatArray:
        """Return positions and velocities, shape [2, joint_count]; read once a step."""
        if self._state is None:
            states = self._bullet.getJointStates(self._body, self._ids)
            self._state = np.array([[state[k] for state in states] for k in (0, 1)], np.float64)
        return self._state

    def _link(self, i: int) -> LoadedLink:
        dynamics = self._bullet.getDynamicsInfo(self._body, i)
        shapes = len(self._bullet.getCollisionShapeData(self._body, i))
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
        inertial = self._turn(bullet.getDynamicsInfo(self._body, info[0])[4])
        axis = triple(inertial @ np.array(info[13])) if info[2] in words else None
        told = (kind, lower, upper, damping, friction, axis)
        return LoadedJoint(name, *told, mimics.get(name), forced_by_judge=name in mimics)


def _disconnect(bullet: BulletClient) -> None:
    bullet.setPhysicsEngineParameter(contactBreakingThreshold=BULLETS_OWN_BREAKING_M)
    bullet.disconnect()
