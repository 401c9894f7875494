"""Every format read by somebody else's code: frames, limits, masses of an exported bundle.

A reader is a function from a bundle's folder to a :class:`Read`; what is not installed is skipped.
"""

import json
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from asset_factory.sim_checks.geometry.placing import rigid

Frames = dict[str, np.ndarray]


@dataclass
class Read:
    """What somebody made of a bundle.

    Attributes:
        frames: poses of the links in the world by name, shape [4, 4] each, of values by joint.
        limits: lower and upper by joint [rad] or [m], without endless ones.
        masses: by link [kg].
    """

    frames: Callable[[dict[str, float]], Frames]
    limits: dict[str, tuple[float, float]]
    masses: dict[str, float]


def mujoco_mjcf(folder: Path) -> Read:
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(folder / "asset.xml"))
    data = mujoco.MjData(model)
    bodies = [model.body(index) for index in range(1, model.nbody)]
    joints = [model.joint(index) for index in range(model.njnt)]

    def frames(values: dict[str, float]) -> Frames:
        for joint in joints:
            data.joint(joint.name).qpos = values[joint.name]
        mujoco.mj_kinematics(model, data)
        return {
            body.name: rigid(data.body(body.name).xmat.reshape(3, 3), data.body(body.name).xpos)
            for body in bodies
        }

    limits = {joint.name: tuple(joint.range) for joint in joints if joint.limited[0]}
    return Read(frames, limits, {body.name: float(body.mass[0]) for body in bodies})


def pinocchio_urdf(folder: Path) -> Read:
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio.buildModelFromUrdf(str(folder / "asset.urdf"))
    data = model.createData()
    names = list(model.names)[1:]
    starts = [model.joints[model.getJointId(name)].idx_q for name in names]
    sizes = [model.joints[model.getJointId(name)].nq for name in names]

    def frames(values: dict[str, float]) -> Frames:
        q = pinocchio.neutral(model)
        for name, start, size in zip(names, starts, sizes, strict=True):
            value = values[name]
            q[start : start + size] = value if size == 1 else (np.cos(value), np.sin(value))
        pinocchio.framesForwardKinematics(model, data, q)
        return {
            frame.name: data.oMf[model.getFrameId(frame.name)].homogeneous
            for frame in model.frames
            if frame.type == pinocchio.FrameType.BODY
        }

    limits = {
        name: (float(model.lowerPositionLimit[start]), float(model.upperPositionLimit[start]))
        for name, start, size in zip(names, starts, sizes, strict=True)
        if size == 1
    }
    masses: dict[str, float] = {}
    return Read(frames, limits, masses)


def yourdfpy_urdf(folder: Path) -> Read:
    yourdfpy = pytest.importorskip("yourdfpy")
    urdf = yourdfpy.URDF.load(str(folder / "asset.urdf"), load_meshes=False)

    def frames(values: dict[str, float]) -> Frames:
        urdf.update_cfg({name: values[name] for name in urdf.actuated_joint_names})
        return {name: urdf.get_transform(name) for name in urdf.link_map}

    limits = {
        name: (joint.limit.lower, joint.limit.upper)
        for name, joint in urdf.joint_map.items()
        if joint.type in ("revolute", "prismatic")
    }
    masses = {name: link.inertial.mass for name, link in urdf.link_map.items()}
    return Read(frames, limits, masses)


def drake_urdf(folder: Path) -> Read:
    return _drake(folder / "asset.urdf", weld=True)


def drake_sdf(folder: Path) -> Read:
    return _drake(folder / "asset.sdf", weld=False)


def _drake(file: Path, *, weld: bool) -> Read:
    plants = pytest.importorskip("pydrake.multibody.plant")
    parsing = pytest.importorskip("pydrake.multibody.parsing")
    plant = plants.MultibodyPlant(0.0)
    (index,) = parsing.Parser(plant).AddModels(str(file))
    bodies = [plant.get_body(each) for each in plant.GetBodyIndices(index)]
    if weld:
        plant.WeldFrames(plant.world_frame(), bodies[0].body_frame())
    plant.Finalize()
    context = plant.CreateDefaultContext()
    joints = [plant.get_joint(each) for each in plant.GetJointIndices(index)]
    joints = [joint for joint in joints if joint.num_positions() == 1]

    def frames(values: dict[str, float]) -> Frames:
        positions = plant.GetPositions(context)
        for joint in joints:
            positions[joint.position_start()] = values[joint.name()]
        plant.SetPositions(context, positions)
        return {
            body.name(): plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4() for body in bodies
        }

    limits = {
        joint.name(): (joint.position_lower_limit(), joint.position_upper_limit())
        for joint in joints
        if np.isfinite(joint.position_upper_limit())
    }
    return Read(frames, limits, {body.name(): body.default_mass() for body in bodies})


def newton_usd(folder: Path) -> Read:
    return _newton(lambda builder: builder.add_usd(str(folder / "asset.usd")))


def newton_mjcf(folder: Path) -> Read:
    return _newton(lambda builder: builder.add_mjcf(str(folder / "asset.xml")))


def _newton(read: Callable[[Any], object]) -> Read:
    newton = pytest.importorskip("newton")
    builder = newton.ModelBuilder()
    read(builder)
    model = builder.finalize(device="cpu")
    names = [label.rpartition("/")[2] for label in builder.joint_label]
    bodies = [label.rpartition("/")[2] for label in builder.body_label]
    starts = builder.joint_q_start
    dofs = builder.joint_qd_start
    types = (newton.JointType.REVOLUTE, newton.JointType.PRISMATIC)
    moving = [index for index, kind in enumerate(builder.joint_type) if kind in types]

    def frames(values: dict[str, float]) -> Frames:
        state = model.state()
        q = model.joint_q.numpy()
        for index in moving:
            q[starts[index]] = values[names[index]]
        model.joint_q.assign(q)
        newton.eval_fk(model, model.joint_q, model.joint_qd, state)
        poses = state.body_q.numpy()
        return {name: _from_quaternion(*pose) for name, pose in zip(bodies, poses, strict=True)}

    lower = model.joint_limit_lower.numpy()
    upper = model.joint_limit_upper.numpy()
    limits = {
        names[index]: (float(lower[dofs[index]]), float(upper[dofs[index]]))
        for index in moving
        if abs(upper[dofs[index]]) < 1e6
    }
    return Read(frames, limits, dict(zip(bodies, model.body_mass.numpy().tolist(), strict=True)))


def pxr_usd(folder: Path) -> Read:
    """By the specification of UsdPhysics, over what pxr reads."""
    pytest.importorskip("pxr")
    from pxr import Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.Open(str(folder / "asset.usd"))
    prims = list(stage.Traverse())
    bodies = [prim for prim in prims if prim.HasAPI(UsdPhysics.RigidBodyAPI)]
    rest = {
        body.GetPath(): np.array(UsdGeom.Xformable(body).ComputeLocalToWorldTransform(0)).T
        for body in bodies
    }
    joints = [UsdPhysics.Joint(prim) for prim in prims if prim.IsA(UsdPhysics.Joint)]

    # Prims die with their stage, which nothing but this default would keep.
    def frames(values: dict[str, float], _stage: Any = stage) -> Frames:
        found = dict(rest)
        for joint in joints:
            before = joint.GetBody0Rel().GetTargets()
            parent = found[before[0]] if before else np.eye(4)
            (child,) = joint.GetBody1Rel().GetTargets()
            value = values.get(joint.GetPrim().GetName(), 0.0)
            found[child] = (
                parent
                @ _local(joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr())
                @ _along_x(joint.GetPrim(), value)
                @ np.linalg.inv(_local(joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()))
            )
        return {path.name: pose for path, pose in found.items()}

    limits = {}
    for joint in joints:
        prim = joint.GetPrim()
        unit = np.radians(1.0) if prim.IsA(UsdPhysics.RevoluteJoint) else 1.0
        ends = [prim.GetAttribute(f"physics:{end}Limit") for end in ("lower", "upper")]
        if all(end and end.HasAuthoredValue() for end in ends):
            limits[prim.GetName()] = tuple(float(end.Get()) * unit for end in ends)
    masses = {body.GetName(): UsdPhysics.MassAPI(body).GetMassAttr().Get() for body in bodies}
    return Read(frames, limits, masses)


def animated_glb(folder: Path) -> Read:
    """By the specification of glTF: the last key of each joint's own animation that is reached."""
    data = (folder / "asset.glb").read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    document = json.loads(data[20 : 20 + length])
    binary = data[28 + length :]
    parts = {node["name"]: node["extras"] for node in document["nodes"][1:]}
    joints = [extras["joint"] for extras in parts.values() if "joint" in extras]
    # By the node that it moves; the one that opens everything moves several.
    moves = {
        each["channels"][0]["target"]["node"]: each
        for each in document.get("animations", [])
        if len(each["channels"]) == 1
    }

    def frames(values: dict[str, float]) -> Frames:
        found: Frames = {}
        nodes = document["nodes"]

        def visit(index: int, above: np.ndarray) -> None:
            node = nodes[index]
            local = _from_quaternion(
                *node.get("translation", (0, 0, 0)), *node.get("rotation", (0, 0, 0, 1))
            )
            joint = node.get("extras", {}).get("joint")
            if joint is not None and index in moves:
                local = _animated(document, binary, moves[index], joint, values, local)
            found[node["name"]] = above @ local
            for child in node.get("children", []):
                visit(child, above @ local)

        for child in nodes[0]["children"]:
            visit(child, np.eye(4))
        return found

    limits = {
        joint["name"]: (joint["lower"], joint["upper"])
        for joint in joints
        if joint["type"] in ("revolute", "prismatic")
    }
    masses = {name: extras["mass_kg"] for name, extras in parts.items()}
    return Read(frames, limits, masses)


def _animated(
    document: dict[str, Any],
    binary: bytes,
    animation: dict[str, Any],
    joint: dict[str, Any],
    values: dict[str, float],
    local: np.ndarray,
) -> np.ndarray:
    """Where a node is when its animation has come as far as a joint's value."""
    from scipy.spatial.transform import Rotation, Slerp

    (sampler,) = animation["samplers"]
    (channel,) = animation["channels"]
    times = _array(document, binary, sampler["input"])
    # The second half goes back.
    half = len(times) // 2
    times = times[:half]
    rows = _array(document, binary, sampler["output"])[:half]
    time = np.interp(values[joint["name"]], (joint["lower"], joint["upper"]), times[[0, -1]])
    if channel["target"]["path"] == "translation":
        return rigid(np.eye(3), np.array([np.interp(time, times, along) for along in rows.T]))
    return rigid(Slerp(times, Rotation.from_quat(rows))(time).as_matrix(), local[:3, 3])


def _array(document: dict[str, Any], binary: bytes, number: int) -> np.ndarray:
    accessor = document["accessors"][number]
    view = document["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    begin = view["byteOffset"]
    numbers = np.frombuffer(binary, np.float32, accessor["count"] * width, begin)
    rows = numbers.astype(np.float64).reshape(accessor["count"], width)
    return rows[:, 0] if width == 1 else rows


def _local(position: Any, rotation: Any) -> np.ndarray:
    quaternion = rotation.Get()
    return _from_quaternion(*position.Get(), *quaternion.GetImaginary(), quaternion.GetReal())


def _along_x(prim: Any, value: float) -> np.ndarray:
    from pxr import UsdPhysics

    if prim.IsA(UsdPhysics.PrismaticJoint):
        return _from_quaternion(value, 0, 0, 0, 0, 0, 1)
    return _from_quaternion(0, 0, 0, np.sin(value / 2.0), 0, 0, np.cos(value / 2.0))


def _from_quaternion(*numbers: float) -> np.ndarray:
    """Pose of position and quaternion x, y, z, w."""
    from scipy.spatial.transform import Rotation

    return rigid(Rotation.from_quat(numbers[3:]).as_matrix(), np.array(numbers[:3]))


READERS = (
    mujoco_mjcf,
    pinocchio_urdf,
    yourdfpy_urdf,
    drake_urdf,
    drake_sdf,
    newton_usd,
    newton_mjcf,
    pxr_usd,
    animated_glb,
)
