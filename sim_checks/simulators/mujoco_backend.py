"""MuJoCo: the only room that says ``mujoco`` to judge."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from ..reading.read import format_of
from .simulator import LoadedJoint, LoadedLink, LoadedModel
from .twin import write_twin

WORLD = 0


class MujocoSimulator:
    """MuJoCo, on the file as it is: MJCF directly, URDF through its importer without fusing or stripping."""

    name = "mujoco"
    distribution = "mujoco"
    formats = ("urdf", "mjcf")
    blind_spots = ("contacts and limits are soft: a part may sink by fractions of a millimetre before it is stopped",)

    def open(self, path: Path, config: MotionConfig) -> MujocoWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        import mujoco

        is_urdf = format_of(path) == "urdf"
        with tempfile.TemporaryDirectory(prefix="twin-") as folder:
            source = write_twin(path, Path(folder), for_mujoco=True) if is_urdf else path
            try:
                spec = mujoco.MjSpec.from_file(str(source))
                _fix_base(spec, mujoco)
                model = spec.compile()
            except (ValueError, RuntimeError) as error:
                raise ValueError(str(error)) from error
        # A hand-written file may need the smaller step that it asks for.
        model.opt.timestep = config.time_step_s if is_urdf else min(config.time_step_s, model.opt.timestep)
        flags = mujoco.mjtDisableBit
        model.opt.disableflags |= int(flags.mjDSBL_ACTUATION) | int(flags.mjDSBL_AUTORESET)
        if config.parents_touch:
            model.opt.disableflags |= int(flags.mjDSBL_FILTERPARENT)
        return MujocoWorld(mujoco, model)


def _fix_base(spec: Any, mujoco: Any) -> None:
    for joint in list(spec.joints):
        if joint.type == mujoco.mjtJoint.mjJNT_FREE:
            spec.delete(joint)
    # Keyframes hold positions of the joints just removed.
    for key in list(spec.keys):
        spec.delete(key)


class MujocoWorld:
    """A compiled model and its state."""

    def __init__(self, mujoco: Any, model: Any) -> None:
        self._mujoco, self._model, self._data = mujoco, model, mujoco.MjData(model)
        scalar = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
        self._ids = [i for i in range(model.njnt) if int(model.jnt_type[i]) in scalar]
        self._positions = model.jnt_qposadr[self._ids]
        self._dofs = model.jnt_dofadr[self._ids]
        every = tuple(_joint(model, mujoco, i) for i in range(model.njnt))
        self.joints = tuple(every[i] for i in self._ids)
        links = tuple(_link(model, mujoco, i) for i in range(model.nbody))
        self.model = LoadedModel(links, every, ())
        self.time_step = float(model.opt.timestep)

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qpos[self._positions] = positions
        self._mujoco.mj_step1(self._model, self._data)

    def positions(self) -> FloatArray:
        """[rad] or [m], shape [joint_count]."""
        return np.array(self._data.qpos[self._positions], np.float64)

    def velocities(self) -> FloatArray:
        """[rad/s] or [m/s], shape [joint_count]."""
        return np.array(self._data.qvel[self._dofs], np.float64)

    def inertias(self) -> FloatArray:
        """Diagonal of the mass matrix, shape [joint_count]."""
        full = np.zeros((self._model.nv, self._model.nv))
        self._mujoco.mj_fullM(self._model, self._data, full)
        return np.array(np.diag(full)[self._dofs], np.float64)

    def carried_masses(self) -> FloatArray:
        """Mass beyond each joint [kg], shape [joint_count]."""
        bodies = self._model.jnt_bodyid[self._ids]
        return np.array(self._model.body_subtreemass[bodies], np.float64)

    def balance(self) -> FloatArray:
        """Forces against gravity, velocity effects and springs, shape [joint_count]."""
        data = self._data
        return np.array((data.qfrc_bias - data.qfrc_spring - data.qfrc_gravcomp)[self._dofs], np.float64)

    def step(self, forces: FloatArray) -> None:
        """One time step with these joint forces; contacts and biases of the new state are then known."""
        self._data.qfrc_applied[self._dofs] = forces
        self._mujoco.mj_step2(self._model, self._data)
        self._mujoco.mj_step1(self._model, self._data)

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world."""
        poses = {}
        for i, link in enumerate(self.model.links):
            pose = np.eye(4)
            pose[:3, :3] = self._data.xmat[i].reshape(3, 3)
            pose[:3, 3] = self._data.xpos[i]
            poses[link.name] = pose
        return poses

    def warnings(self) -> tuple[str, ...]:
        """MuJoCo's own warning counters since the last :meth:`place`."""
        kinds = self._mujoco.mjtWarning
        names = {int(value): name for name, value in kinds.__members__.items() if name != "mjNWARNING"}
        counts = [(names[i], int(self._data.warning[i].number)) for i in sorted(names)]
        return tuple(f"{name.removeprefix('mjWARN_').lower()} x{count}" for name, count in counts if count)


def _link(model: Any, mujoco: Any, i: int) -> LoadedLink:
    geoms = np.flatnonzero(model.geom_bodyid == i)
    solid = (model.geom_contype[geoms] != 0) | (model.geom_conaffinity[geoms] != 0)
    # Floors belong to the scene, not to the link.
    solid &= ~np.isin(model.geom_type[geoms], (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD))
    static = int(model.body_weldid[i]) == WORLD
    moments, center = _triple(sorted(model.body_inertia[i])), _triple(model.body_ipos[i])
    return LoadedLink(
        _body_name(model, mujoco, i), float(model.body_mass[i]), int(solid.sum()), moments, center, static
    )


def _leader(model: Any, mujoco: Any, joint: int) -> str | None:
    for i in range(model.neq):
        if model.eq_type[i] == mujoco.mjtEq.mjEQ_JOINT and model.eq_active0[i] and int(model.eq_obj1id[i]) == joint:
            leader = int(model.eq_obj2id[i])
            return _joint_name(model, mujoco, leader) if leader >= 0 else None
    return None


def _triple(values: Any) -> tuple[float, float, float]:
    a, b, c = (float(v) for v in values)
    return a, b, c


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
    damping, friction = float(np.ravel(model.dof_damping[dof])[0]), float(model.dof_frictionloss[dof])
    leader = _leader(model, mujoco, i)
    return LoadedJoint(_joint_name(model, mujoco, i), kind, lower, upper, damping, friction, leader)
