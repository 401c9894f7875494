"""MuJoCo: the only module of the checks that imports it, but for Newton."""

from __future__ import annotations

import math
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from ..geometry.placing import rigid
from ..read.mjcf_compiler import begin_compiling
from ..read.mjcf_model import CompiledModel, read_model
from ..read.read import format_of
from ..read.urdf import exempt_pairs
from .simulator import Simulator
from .twin import twin_of
from .world import LoadedJoint, LoadedLink, LoadedModel, PairRules, Touches, World, triple

WORLD = 0
#: Shapes that belong to the scene, not to the link.
FLOORS = ("plane", "hfield")
#: Kinds of joints that are pushed, by MuJoCo's words.
SCALAR = ("hinge", "slide")


class MujocoSimulator(Simulator):
    """MuJoCo on the file as it is: MJCF directly, URDF by its importer, nothing fused or cut."""

    name = "mujoco"
    distribution = "mujoco"
    formats = ("urdf", "mjcf")
    soft_friction = ("urdf",)
    friction_advice = "; solimpfriction near 1 makes MuJoCo's stiff"
    blind_spots = (
        (
            "contacts and limits are soft: a part may sink by fractions of a "
            "millimetre before it is stopped"
        ),
        "joint friction is soft: what it holds creeps, and a URDF cannot say how little it should",
        "pairs that an MJCF file exempts by <exclude>, "
        "contype or conaffinity, or the SRDF beside a URDF, pass through each other, "
        "and so do links fixed to one another",
    )

    def open(self, path: Path, config: MotionConfig) -> MujocoWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        import mujoco

        begin_compiling()
        is_urdf = format_of(path) == "urdf"
        with twin_of(path, for_mujoco=True) if is_urdf else nullcontext(str(path)) as source:
            try:
                spec = mujoco.MjSpec.from_file(source)
                _fix_base(spec, mujoco)
                # Links that an SRDF exempts, which MuJoCo reads not.
                for one, other in sorted(map(sorted, exempt_pairs(path) if is_urdf else ())):
                    if spec.body(one) is not None and spec.body(other) is not None:
                        spec.add_exclude(bodyname1=one, bodyname2=other)
                model = spec.compile()
            except (ValueError, RuntimeError) as error:
                raise ValueError(str(error)) from error
        # A hand-written file may need the smaller step that it asks for.
        own_step = config.time_step_s if is_urdf else model.opt.timestep
        model.opt.timestep = min(config.time_step_s, own_step)
        # What sleeps does not show that it would still creep.
        model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        return MujocoWorld(mujoco, model, read_model(model), config)


def _fix_base(spec: Any, mujoco: Any) -> None:
    for joint in list(spec.joints):
        if joint.type == mujoco.mjtJoint.mjJNT_FREE:
            spec.delete(joint)
    # Keyframes hold positions of the joints just removed.
    for key in list(spec.keys):
        spec.delete(key)


class MujocoWorld(World):
    """A compiled model, by the names that are read of it, and its state."""

    def __init__(self, mujoco: Any, model: Any, held: CompiledModel, config: MotionConfig) -> None:
        flags = mujoco.mjtDisableBit
        model.opt.disableflags |= int(flags.mjDSBL_ACTUATION) | int(flags.mjDSBL_AUTORESET)
        if config.parents_touch:
            # Else a link, and what is fixed to it, would pass through all that is jointed to it.
            model.opt.disableflags |= int(flags.mjDSBL_FILTERPARENT)
        self._mujoco = mujoco
        self._model = model
        self._data = mujoco.MjData(model)
        self._forces = int(flags.mjDSBL_GRAVITY) | int(flags.mjDSBL_SPRING)
        # What the file itself turns off stays off.
        self._own = int(model.opt.disableflags) & self._forces
        pushed = [i for i, joint in enumerate(held.joints) if joint.kind in SCALAR]
        self._positions = model.jnt_qposadr[pushed]
        self._dofs = model.jnt_dofadr[pushed]
        every = _joints(held)
        self.joints = tuple(every[i] for i in pushed)
        links = tuple(_link(model, held, i) for i in range(model.nbody))
        # Without the flag MuJoCo keeps a link and a moving parent apart, but not a link and the
        # unmoved base.
        touch = config.parents_touch
        rules = PairRules(touch, static_parent=True, excluded=_excluded(held, links))
        self.model = LoadedModel(links, every, rules)
        self.time_step = float(model.opt.timestep)
        self.carried = tuple(_below(held, held.joints[i].body) for i in pushed)
        self._complaints = np.zeros(int(mujoco.mjtWarning.mjNWARNING), np.int64)

    def weigh(self, on: bool) -> None:
        """Turn gravity and springs on or off."""
        others = self._model.opt.disableflags & ~self._forces
        self._model.opt.disableflags = others | (self._own if on else self._forces)
        self._mujoco.mj_step1(self._model, self._data)

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        self._complaints += self._counted()
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[self._positions] = positions
        self._mujoco.mj_step1(self._model, self._data)

    def positions(self) -> FloatArray:
        """Return joint values [rad] or [m], shape [joint_count]."""
        return np.array(self._data.qpos[self._positions], np.float64)

    def velocities(self) -> FloatArray:
        """Return joint speeds [rad/s] or [m/s], shape [joint_count]."""
        return np.array(self._data.qvel[self._dofs], np.float64)

    def mass_matrix(self) -> FloatArray:
        """Return the joints' mass matrix [kg m2], [kg m] or [kg], [joint_count, joint_count]."""
        full = np.zeros((self._model.nv, self._model.nv))
        self._mujoco.mj_fullM(self._model, self._data, full)
        return full[np.ix_(self._dofs, self._dofs)]

    def energy(self) -> float:
        """Return kinetic energy and potential energy of the gravity and springs that are on [J]."""
        self._mujoco.mj_energyPos(self._model, self._data)
        self._mujoco.mj_energyVel(self._model, self._data)
        return float(self._data.energy.sum())

    def balance(self) -> FloatArray:
        """Return the forces against gravity, velocity effects and springs, shape [joint_count]."""
        data = self._data
        forces = data.qfrc_bias - data.qfrc_spring - data.qfrc_gravcomp
        return np.array(forces[self._dofs], np.float64)

    def step(self, forces: FloatArray) -> None:
        """Make one time step with these joint forces; also updates contacts and biases."""
        self._data.qfrc_applied[self._dofs] = forces
        self._mujoco.mj_step2(self._model, self._data)
        self._mujoco.mj_step1(self._model, self._data)

    def contacts(self) -> Touches:
        """Return which links touch here, under the forces of the last step."""
        # After a step only the places of the new contacts are known, not yet their forces.
        self._mujoco.mj_forward(self._model, self._data)
        found = Touches()
        wrench = np.zeros(6)
        for i in range(self._data.ncon):
            self._mujoco.mj_contactForce(self._model, self._data, i, wrench)
            a, b = sorted(int(body) for body in self._model.geom_bodyid[self._data.contact.geom[i]])
            pair = (self.model.links[a].name, self.model.links[b].name)
            found.add(pair, float(wrench[0]), -float(self._data.contact.dist[i]))
        return found

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world."""
        frames = zip(self._data.xmat.reshape(-1, 3, 3), self._data.xpos, strict=True)
        named = zip(self.model.links, frames, strict=True)
        return {link.name: rigid(turn, place) for link, (turn, place) in named}

    def warnings(self) -> tuple[str, ...]:
        """Return MuJoCo's own warning counters."""
        counts = (self._complaints + self._counted()).tolist()
        told = [(self._mujoco.mjtWarning(i).name, count) for i, count in enumerate(counts) if count]
        return tuple(f"{name.removeprefix('mjWARN_').lower()} x{count}" for name, count in told)

    def close(self) -> None:
        """Drop the model and its state; MuJoCo keeps nothing else."""
        del self._model, self._data

    def _counted(self) -> Any:
        return np.array([warning.number for warning in self._data.warning], np.int64)


def _link(model: Any, held: CompiledModel, i: int) -> LoadedLink:
    body = held.bodies[i]
    geoms = ((k, held.geoms[k]) for k in body.geoms)
    solid = [k for k, geom in geoms if geom.collides and geom.shape not in FLOORS]
    static = body.weld == WORLD
    moments = triple(sorted(model.body_inertia[i]))
    center = triple(model.body_ipos[i])
    friction = max((float(model.geom_friction[k, 0]) for k in solid), default=None)
    mass = float(model.body_mass[i])
    return LoadedLink(held.names[i], mass, len(solid), moments, center, static, friction)


def _below(held: CompiledModel, body: int) -> frozenset[str]:
    found = {body}
    for i, each in enumerate(held.bodies):
        # Children are numbered after their parents.
        if each.parent in found:
            found.add(i)
    return frozenset(held.names[i] for i in found)


def _excluded(held: CompiledModel, links: tuple[LoadedLink, ...]) -> tuple[tuple[str, str], ...]:
    solid = ((a, b) for a, b in held.apart() if links[a].shapes and links[b].shapes)
    moved = ((a, b) for a, b in solid if held.bodies[a].weld != held.bodies[b].weld)
    return tuple((links[a].name, links[b].name) for a, b in moved)


def _joints(held: CompiledModel) -> tuple[LoadedJoint, ...]:
    mimics = held.mimics()
    found = []
    for i, joint in enumerate(held.joints):
        turning = "continuous" if joint.lower is None else "revolute"
        kind = {"slide": "prismatic", "hinge": turning}.get(joint.kind, joint.kind)
        lower = -math.inf if joint.lower is None else joint.lower
        upper = math.inf if joint.upper is None else joint.upper
        axis = triple(joint.axis) if joint.kind in SCALAR else None
        told = (kind, lower, upper, joint.damping, joint.friction, axis)
        name = held.joint_name(i)
        found.append(LoadedJoint(name, *told, mimics.get(name)))
    return tuple(found)
