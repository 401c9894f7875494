"""MuJoCo: the only module of the checks that imports it, but for Newton."""

from __future__ import annotations

import math
from collections.abc import Iterable
from contextlib import nullcontext
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray, Mimic
from ..geometry.placing import rigid
from ..read.mjcf_model import begin_compiling
from ..read.read import format_of
from ..read.srdf import exempt_pairs
from .simulator import LoadedJoint, LoadedLink, LoadedModel, PairRules, Touch, Touches, triple
from .twin import twin_of

WORLD = 0


class MujocoSimulator:
    """MuJoCo on the file as it is: MJCF directly, URDF by its importer, nothing fused or cut."""

    name = "mujoco"
    distribution = "mujoco"
    formats = ("urdf", "mjcf")
    soft_friction = ("urdf",)
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
                _exempt(spec, exempt_pairs(path) if is_urdf else ())
                model = spec.compile()
            except (ValueError, RuntimeError) as error:
                raise ValueError(str(error)) from error
        # A hand-written file may need the smaller step that it asks for.
        own_step = config.time_step_s if is_urdf else model.opt.timestep
        model.opt.timestep = min(config.time_step_s, own_step)
        flags = mujoco.mjtDisableBit
        model.opt.disableflags |= int(flags.mjDSBL_ACTUATION) | int(flags.mjDSBL_AUTORESET)
        # What sleeps does not show that it would still creep.
        model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        if config.parents_touch:
            model.opt.disableflags |= int(flags.mjDSBL_FILTERPARENT)
        return MujocoWorld(mujoco, model, parents_touch=config.parents_touch)


def _exempt(spec: Any, pairs: Iterable[frozenset[str]]) -> None:
    """Let links of a URDF pass through each other that its SRDF exempts, which MuJoCo reads not."""
    for one, other in sorted(map(sorted, pairs)):
        if spec.body(one) is not None and spec.body(other) is not None:
            spec.add_exclude(bodyname1=one, bodyname2=other)


def _fix_base(spec: Any, mujoco: Any) -> None:
    for joint in list(spec.joints):
        if joint.type == mujoco.mjtJoint.mjJNT_FREE:
            spec.delete(joint)
    # Keyframes hold positions of the joints just removed.
    for key in list(spec.keys):
        spec.delete(key)


class MujocoWorld:
    """A compiled model and its state."""

    def __init__(self, mujoco: Any, model: Any, *, parents_touch: bool) -> None:
        self._mujoco = mujoco
        self._model = model
        self._data = mujoco.MjData(model)
        flags = mujoco.mjtDisableBit
        self._forces = int(flags.mjDSBL_GRAVITY) | int(flags.mjDSBL_SPRING)
        # What the file itself turns off stays off.
        self._own = int(model.opt.disableflags) & self._forces
        scalar = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
        self._ids = [i for i in range(model.njnt) if int(model.jnt_type[i]) in scalar]
        self._positions = model.jnt_qposadr[self._ids]
        self._dofs = model.jnt_dofadr[self._ids]
        every = tuple(_joint(model, mujoco, i) for i in range(model.njnt))
        self.joints = tuple(every[i] for i in self._ids)
        links = tuple(_link(model, mujoco, i) for i in range(model.nbody))
        # Without the flag MuJoCo keeps a link and a moving parent apart, but not a link and the
        # unmoved base.
        rules = PairRules(parents_touch, static_parent=True, excluded=_excluded(model, links))
        self.model = LoadedModel(links, every, (), rules)
        self.time_step = float(model.opt.timestep)
        self.carried = tuple(_below(model, links, int(model.jnt_bodyid[i])) for i in self._ids)
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
            found.add(pair, Touch(float(wrench[0]), -float(self._data.contact.dist[i])))
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


def _link(model: Any, mujoco: Any, i: int) -> LoadedLink:
    geoms = np.flatnonzero(model.geom_bodyid == i)
    solid = (model.geom_contype[geoms] != 0) | (model.geom_conaffinity[geoms] != 0)
    # Floors belong to the scene, not to the link.
    floors = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)
    solid &= ~np.isin(model.geom_type[geoms], floors)
    static = int(model.body_weldid[i]) == WORLD
    moments = triple(sorted(model.body_inertia[i]))
    center = triple(model.body_ipos[i])
    friction = float(model.geom_friction[geoms[solid], 0].max()) if solid.any() else None
    name = _body_name(model, mujoco, i)
    mass = float(model.body_mass[i])
    return LoadedLink(name, mass, int(solid.sum()), moments, center, static, friction)


def _below(model: Any, links: tuple[LoadedLink, ...], body: int) -> frozenset[str]:
    found = {body}
    for i in range(body + 1, model.nbody):
        # Children are numbered after their parents.
        if int(model.body_parentid[i]) in found:
            found.add(i)
    return frozenset(links[i].name for i in found)


def _excluded(model: Any, links: tuple[LoadedLink, ...]) -> tuple[tuple[str, str], ...]:
    solid = [i for i, link in enumerate(links) if link.shapes]
    named = {frozenset(divmod(int(pair), 1 << 16)) for pair in model.exclude_signature}
    # The masks of a body are those of its geoms together: some two of them match exactly if these
    # do.
    types = model.body_contype
    affinities = model.body_conaffinity

    def pass_through(a: int, b: int) -> bool:
        matched = types[a] & affinities[b] or types[b] & affinities[a]
        apart = model.body_weldid[a] != model.body_weldid[b]
        return apart and (frozenset((a, b)) in named or not matched)

    pairs = (pair for pair in combinations(solid, 2) if pass_through(*pair))
    return tuple((links[a].name, links[b].name) for a, b in pairs)


def _mimic(model: Any, mujoco: Any, joint: int) -> Mimic | None:
    """Return what the joint is forced to follow, by the equality's constant and linear part."""
    for i in range(model.neq):
        couples = model.eq_type[i] == mujoco.mjtEq.mjEQ_JOINT and model.eq_active0[i]
        if couples and int(model.eq_obj1id[i]) == joint:
            leader = int(model.eq_obj2id[i])
            if leader < 0:
                return None
            constant, linear = (float(number) for number in model.eq_data[i, :2])
            # The polynomial speaks of how far both joints are from their reference.
            here, there = (float(model.qpos0[int(model.jnt_qposadr[k])]) for k in (joint, leader))
            offset = here + constant - linear * there
            return Mimic(_joint_name(model, mujoco, leader), linear, offset)
    return None


def _body_name(model: Any, mujoco: Any, i: int) -> str:
    return str(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, i) or f"body{i}")


def _joint_name(model: Any, mujoco: Any, i: int) -> str:
    body = int(model.jnt_bodyid[i])
    nameless = f"{_body_name(model, mujoco, body)}_joint{i - int(model.body_jntadr[body])}"
    return str(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, i) or nameless)


def _joint(model: Any, mujoco: Any, i: int) -> LoadedJoint:
    word = mujoco.mjtJoint(int(model.jnt_type[i])).name.removeprefix("mjJNT_").lower()
    limited = bool(model.jnt_limited[i])
    kind = {"slide": "prismatic", "hinge": "revolute" if limited else "continuous"}.get(word, word)
    lower, upper = (float(v) for v in model.jnt_range[i]) if limited else (-math.inf, math.inf)
    dof = int(model.jnt_dofadr[i])
    damping = float(np.ravel(model.dof_damping[dof])[0])
    friction = float(model.dof_frictionloss[dof])
    axis = triple(model.jnt_axis[i]) if word in ("slide", "hinge") else None
    name = _joint_name(model, mujoco, i)
    mimic = _mimic(model, mujoco, i)
    return LoadedJoint(name, kind, lower, upper, damping, friction, axis, mimic)
