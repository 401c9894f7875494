"""SAPIEN (PhysX articulations): the only module of the checks that imports it."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray, Mimic
from ..geometry.statics import GRAVITY
from .simulator import Simulator
from .twin import twin_of
from .world import LoadedJoint, LoadedLink, LoadedModel, PairRules, Touches, World, triple

KINDS = {"revolute_unwrapped": "revolute", "revolute": "continuous", "prismatic": "prismatic"}

#: PhysX keeps angles between minus and plus one turn: beyond one end they go on at the other [rad].
WINDING = 4.0 * math.pi
#: No joint turns as far in one step [rad].
JUMP = 2.0 * math.pi


class SapienSimulator(Simulator):
    """SAPIEN on the processor, without a renderer."""

    name = "sapien"
    distribution = "sapien"
    formats = ("urdf",)
    blind_spots = (
        (
            "PhysX never lets parent and child of an articulation touch: "
            "a drawer stuck in its own carcass still slides"
        ),
        "pairs that an SRDF file beside the URDF exempts pass through each other",
        "joint friction of the file is dropped: joints rest, fall and are driven without any",
        (
            "joints that follow another are coupled only to the joint that carries them, "
            "or to one of the same link, at which SAPIEN's loader takes the leader for the "
            "follower: here they are coupled as written, elsewhere swap the two names in the "
            "builder's mimic_joint_records before it builds"
        ),
    )

    def open(self, path: Path, config: MotionConfig) -> SapienWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        with warnings.catch_warnings():
            # It warns of a missing Vulkan library, which physics does not need.
            warnings.simplefilter("ignore")
            import sapien
        # It remembers meshes by their file's name, whatever the file holds by now.
        sapien.physx.clear_cache()
        scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
        scene.physx_system.timestep = config.time_step_s
        loader = scene.create_urdf_loader()
        loader.fix_root_link = True
        try:
            with twin_of(path) as twin:
                articulations, actors, _ = loader.parse(twin)
                if (count := len(articulations) + len(actors)) != 1:
                    made = f"{count} separate objects (floating joints)"
                    raise ValueError(f"the file makes {made}, not one")
                if actors:
                    actors[0].set_physx_body_type("kinematic")
                records = articulations[0].mimic_joint_records if articulations else []
                said = [replace(record) for record in records]
                forced = couple_as_written(articulations[0]) if articulations else frozenset()
                body = articulations[0].build() if articulations else actors[0].build()
        except Exception as error:
            raise ValueError(f"{type(error).__name__}: {error}") from error
        if not articulations:
            return SapienWorld(scene, None, _actor_model(body))
        return SapienWorld(scene, body, _articulation_model(body, _mimics(body, said), forced))


class SapienWorld(World):
    """One articulation; or, of a file without joints, one actor, which only stands there."""

    def __init__(self, scene: Any, articulation: Any | None, model: LoadedModel) -> None:
        self._scene = scene
        self._articulation: Any = articulation
        self._active = list(articulation.active_joints) if articulation is not None else []
        self.model = model
        self.joints = model.joints
        self.time_step = float(scene.physx_system.timestep)
        self.carried = tuple(frozenset(_names(joint.child_link)) for joint in self._active)
        self._falls = True
        self._endless = np.array([joint.kind == "continuous" for joint in model.joints])
        self._wound = np.zeros(len(model.joints))
        if articulation is not None:
            self._dynamics = articulation.create_pinocchio_model()
            # What sleeps does not show that it would still creep.
            articulation.set_sleep_threshold(0.0)
            for joint in self._active:
                joint.set_friction(0.0)

    def weigh(self, on: bool) -> None:
        """Turn gravity on or off; a URDF has no springs."""
        self._falls = on
        for link in self._articulation.links:
            link.disable_gravity = not on

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        if self._articulation is not None:
            self._articulation.set_qpos(np.asarray(positions, np.float32))
            self._articulation.set_qvel(np.zeros(len(positions), np.float32))
            self._wound[:] = 0.0

    def positions(self) -> FloatArray:
        """Return joint values [rad] or [m], [joint_count]; endless ones go on after a turn."""
        return self._read() + self._wound

    def _read(self) -> FloatArray:
        return _vector(self._articulation.qpos)

    def velocities(self) -> FloatArray:
        """Return joint speeds [rad/s] or [m/s], shape [joint_count]."""
        return _vector(self._articulation.qvel)

    def mass_matrix(self) -> FloatArray:
        """Return the joints' mass matrix [kg m2], [kg m] or [kg], [joint_count, joint_count]."""
        matrix = self._dynamics.compute_generalized_mass_matrix(self._articulation.qpos)
        return np.asarray(matrix, np.float64)

    def energy(self) -> float:
        """Return the kinetic energy, and potential energy of gravity if it is on [J]."""
        velocity = self.velocities()
        kinetic = 0.5 * float(velocity @ self.mass_matrix() @ velocity)
        if not self._falls:
            return kinetic
        links = self._articulation.links
        heights = ((link.entity_pose * link.cmass_local_pose).p[2] for link in links)
        weights = (float(link.mass) * float(z) for link, z in zip(links, heights, strict=True))
        return kinetic + GRAVITY * sum(weights)

    def balance(self) -> FloatArray:
        """Return the forces against gravity and velocity effects, shape [joint_count]."""
        return _vector(self._articulation.compute_passive_force(True, True))

    def step(self, forces: FloatArray) -> None:
        """Make one time step with these joint forces."""
        before = self._read() if self._endless.any() else None
        self._articulation.set_qf(np.asarray(forces, np.float32))
        self._scene.step()
        if before is not None:
            jump = self._read() - before
            wrapped = self._endless & (np.abs(jump) > JUMP)
            self._wound -= np.where(wrapped, np.sign(jump) * WINDING, 0.0)

    def contacts(self) -> Touches:
        """Return which links touched in the last step."""
        order = {link.name: i for i, link in enumerate(self.model.links)}
        found = Touches()
        for contact in self._scene.get_contacts():
            a, b = sorted((body.entity.name for body in contact.bodies), key=order.__getitem__)
            impulse = sum(np.asarray(point.impulse, np.float64) for point in contact.points)
            depth = max(-float(point.separation) for point in contact.points)
            found.add((a, b), float(np.linalg.norm(impulse)) / self.time_step, depth)
        return found

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world."""
        if self._articulation is None:
            return {link.name: np.eye(4) for link in self.model.links}
        return {link.name: _matrix(link.entity_pose) for link in self._articulation.links}

    def close(self) -> None:
        """Let go of the scene and all that is in it."""
        self._active = []
        self._articulation = None
        self._dynamics = None
        self._scene.clear()
        self._scene = None


def _actor_model(actor: Any) -> LoadedModel:
    import sapien

    body = next(c for c in actor.components if isinstance(c, sapien.physx.PhysxRigidBaseComponent))
    held = (actor.name, 0.0, len(body.collision_shapes), None)
    return LoadedModel((LoadedLink(*held, static=True, friction=_friction(body)),), ())


def couple_as_written(builder: Any) -> frozenset[str]:
    """Make a builder couple joints of one link as its file does; return the followers' names.

    It would hold the leader at the follower's value, which is the same at ratios of 1 and -1.
    """
    links = {link.joint_record.name: link.parent for link in builder.link_builders}
    turned = [
        record
        for record in builder.mimic_joint_records
        if links[record.joint] is links[record.mimic]
        and (record.multiplier, record.offset) != (1.0, 0.0)
        and record.multiplier != -1.0
    ]
    for record in turned:
        record.joint, record.mimic = record.mimic, record.joint
    return frozenset(record.mimic for record in turned)


def _mimics(articulation: Any, records: Any) -> dict[str, Mimic]:
    """Return which joints SAPIEN forces to follow which others, by what the file records.

    It cannot be asked. A joint follows the one that carries it, or one of the same link. All others
    it leaves free.
    """
    found: dict[str, Mimic] = {}
    for record in records:
        follower = articulation.find_joint_by_name(record.joint)
        leader = articulation.find_joint_by_name(record.mimic)
        if follower.parent_link in (leader.child_link, leader.parent_link):
            numbers = float(record.multiplier), float(record.offset)
            found[record.joint] = Mimic(record.mimic, *numbers)
    return found


def _articulation_model(
    articulation: Any, mimics: Mapping[str, Mimic], forced: frozenset[str]
) -> LoadedModel:
    links = tuple(
        LoadedLink(
            link.name,
            float(link.mass),
            len(link.collision_shapes),
            triple(sorted(link.inertia)),
            triple(link.cmass_local_pose.p),
            friction=_friction(link),
        )
        for link in articulation.links
    )
    joints = tuple(_joint(joint, mimics, forced) for joint in articulation.active_joints)
    rules = PairRules(moving_parent=False, static_parent=False, excluded=_excluded(articulation))
    return LoadedModel(links, joints, rules)


def _joint(joint: Any, mimics: Mapping[str, Mimic], forced: frozenset[str]) -> LoadedJoint:
    lower, upper = (float(limit) for limit in joint.limit[0])
    # The joint's frame has its x along the axis.
    axis = triple(_matrix(joint.pose_in_child)[:3, 0]) if joint.type in KINDS else None
    kind = KINDS.get(joint.type, joint.type)
    damping = float(joint.damping)
    mimic = mimics.get(joint.name)
    by_judge = mimic is not None and joint.name in forced
    return LoadedJoint(joint.name, kind, lower, upper, damping, None, axis, mimic, by_judge)


def _names(link: Any) -> Iterator[str]:
    yield link.name
    for child in link.children:
        yield from _names(child)


def _friction(body: Any) -> float | None:
    materials = (shape.physical_material for shape in body.collision_shapes)
    return max((float(each.static_friction) for each in materials), default=None)


def _excluded(articulation: Any) -> tuple[tuple[str, str], ...]:
    solid = (link for link in articulation.links if link.collision_shapes)
    pairs = combinations([(link, link.collision_shapes[0].collision_groups) for link in solid], 2)
    return tuple((a.name, b.name) for (a, one), (b, two) in pairs if not _groups_touch(one, two))


def _groups_touch(one: Any, two: Any) -> bool:
    """Apply SAPIEN's rule for the four words that a shape carries."""
    if (one[3] & 0xFFFF) == (two[3] & 0xFFFF) and one[2] & two[2]:
        return False
    return bool(one[0] & two[1] or one[1] & two[0])


def _vector(values: Any) -> FloatArray:
    return np.asarray(values, np.float64).ravel()


def _matrix(pose: Any) -> FloatArray:
    return np.asarray(pose.to_transformation_matrix(), np.float64)
