"""MJCF as MuJoCo compiles it: defaults, classes and inferred inertias are the compiler's."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..description import (
    DescribedShape,
    Description,
    DescriptionError,
    FloatArray,
    IntArray,
    JointLine,
    Link,
    LinkInertia,
    Mimic,
)
from .document import parse_document
from .multiplied import MOST, refuse_multiplied
from .native import COMPILER_BYTES, memory_bounded
from .primitives import box, capsule, cylinder, ellipsoid
from .references import refuse_outside_mjcf

if TYPE_CHECKING:
    from mujoco import MjModel

#: mjtGeom and mjtJoint, https://mujoco.readthedocs.io/en/stable/APIreference/APItypes.html
SPHERE = 2
CAPSULE = 3
ELLIPSOID = 4
CYLINDER = 5
BOX = 6
MESH = 7
FREE = 0
BALL = 1
SLIDE = 2
#: mjtEq
EQUALITY_JOINT = 2


def read_mjcf(path: Path) -> Description:
    """Compile an MJCF file with MuJoCo and read back bodies, joints and geoms.

    A geom collides when ``contype`` or ``conaffinity`` is set, else it is visual; planes and height
    fields are left out. A joint that does not pass through its body's origin, and all but the last
    of a body's joints, get a virtual link of their own, so that every joint is an axis through its
    child's origin. Call in a killable child: the compiler is native code.

    Raises:
        DescriptionError: with MuJoCo's own words.
    """
    import mujoco  # the engine's own compiler is the only true reader of its format

    document = parse_document(path)
    refuse_outside_mjcf(path, document)
    refuse_multiplied(path, document)
    # Its own way is a log file in whatever folder the program was started from.
    mujoco.set_mju_user_warning(_say)
    # It remembers meshes by their file's name and the second they were written in.
    mujoco.mj_clearCache(mujoco.mj_getCache())
    try:
        with memory_bounded(COMPILER_BYTES):
            model = mujoco.MjModel.from_xml_path(str(path.resolve()))
    except MemoryError as error:
        raise DescriptionError("too_large", f"{path.name}: {error}") from error
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        raise DescriptionError("unreadable", f"{path.name}: {error}") from error
    _refuse_many(path.name, model)
    links: list[Link] = []
    joints: list[JointLine] = []
    for body in range(model.nbody):
        if body > 0:
            _place(model, body, links, joints)
        collisions, visuals = _shapes(model, body, path.resolve().parent)
        links.append(Link(_body_name(model, body), _inertia(model, body), collisions, visuals))
    mimics = _mimics(model)
    followed = tuple(replace(joint, mimic=mimics.get(joint.name)) for joint in joints)
    return Description(path, "mjcf", tuple(links), followed, _excluded(model))


def _refuse_many(name: str, model: MjModel) -> None:
    for what, count, most in (
        ("bodies", model.nbody, MOST["bodies"]),
        ("geoms", model.ngeom, MOST["geoms"]),
    ):
        if count > most:
            raise DescriptionError(
                "too_large", f"{name}: {count} {what} once compiled, at most {most} are read"
            )


def _say(words: str) -> None:
    os.write(2, f"MuJoCo: {words}\n".encode())


def _mimics(model: MjModel) -> dict[str, Mimic]:
    """Follower -> leader of joint equalities; of the polynomial, only constant and linear part.

    An equality that names no second joint locks the first one; there is no leader to tell.
    """
    found: dict[str, Mimic] = {}
    for index in np.flatnonzero((model.eq_type == EQUALITY_JOINT) & (model.eq_active0 != 0)):
        follower = int(model.eq_obj1id[index])
        leader = int(model.eq_obj2id[index])
        if leader < 0:
            continue
        constant, linear = (float(number) for number in model.eq_data[index, :2])
        # The polynomial speaks of how far both joints are from their reference.
        here, there = (
            float(model.qpos0[int(model.jnt_qposadr[joint])]) for joint in (follower, leader)
        )
        mimic = Mimic(_joint_name(model, leader), linear, here + constant - linear * there)
        found.setdefault(_joint_name(model, follower), mimic)
    return found


def _excluded(model: MjModel) -> frozenset[frozenset[str]]:
    """Return the pairs of bodies excluded by name, or whose contact bits never meet."""
    pairs = {divmod(int(signature), 1 << 16) for signature in model.exclude_signature}
    types = np.zeros(model.nbody, dtype=np.int64)
    affinities = np.zeros(model.nbody, dtype=np.int64)
    np.bitwise_or.at(types, model.geom_bodyid, model.geom_contype)
    np.bitwise_or.at(affinities, model.geom_bodyid, model.geom_conaffinity)
    meet = (types[:, None] & affinities[None, :]) | (affinities[:, None] & types[None, :])
    solid = (types | affinities) != 0
    pairs |= {
        (int(a), int(b)) for a, b in np.argwhere((meet == 0) & solid[:, None] & solid[None, :])
    }
    return frozenset(
        frozenset((_body_name(model, a), _body_name(model, b))) for a, b in pairs if a != b
    )


def _place(model: MjModel, body: int, links: list[Link], joints: list[JointLine]) -> None:
    """Append the joints that hold a body, and the virtual links between them."""
    name = _body_name(model, body)
    parent = _body_name(model, int(model.body_parentid[body]))
    pending = _pose(model.body_pos[body], model.body_quat[body])
    first = int(model.body_jntadr[body])
    count = int(model.body_jntnum[body])
    for index in range(first, first + count):
        kind = int(model.jnt_type[index])
        joint_name = _joint_name(model, index)
        if kind in (FREE, BALL):
            word = "floating" if kind == FREE else "ball"
            joints.append(
                _line(joint_name, word, parent, _virtual(name, joint_name, links), pending)
            )
            parent = joints[-1].child
            pending = np.eye(4)
            continue
        axis = np.array(model.jnt_axis[index])
        anchor = np.array(model.jnt_pos[index])
        before = pending @ _translation(anchor) @ _undo_reference(model, index, axis)
        last = index == first + count - 1 and not anchor.any()
        child = name if last else _virtual(name, joint_name, links)
        joints.append(_moving(model, index, joint_name, (parent, child), before))
        parent = child
        pending = _translation(-anchor)
    if parent != name:
        joints.append(_line(f"{name}_fixed", "fixed", parent, name, pending))


def _virtual(body: str, joint: str, links: list[Link]) -> str:
    name = f"{body}@{joint}"
    links.append(Link(name, None, (), (), virtual=True))
    return name


def _line(name: str, kind: str, parent: str, child: str, origin: FloatArray) -> JointLine:
    return JointLine(name, kind, parent, child, origin, np.array([0.0, 0.0, 1.0]), None, None)


def _moving(
    model: MjModel, index: int, name: str, ends: tuple[str, str], origin: FloatArray
) -> JointLine:
    slide = int(model.jnt_type[index]) == SLIDE
    limited = bool(model.jnt_limited[index])
    lower, upper = (float(value) for value in model.jnt_range[index])
    dof = int(model.jnt_dofadr[index])
    return JointLine(
        name=name,
        kind="prismatic" if slide else "revolute" if limited else "continuous",
        parent=ends[0],
        child=ends[1],
        origin=origin,
        axis=np.array(model.jnt_axis[index]),
        lower=lower if limited else None,
        upper=upper if limited else None,
        damping=float(np.atleast_1d(model.dof_damping[dof])[0]),
        friction=float(model.dof_frictionloss[dof]),
    )


def _undo_reference(model: MjModel, index: int, axis: FloatArray) -> FloatArray:
    """From the compiled pose, where the joint's value is its reference, to the pose at value 0."""
    from scipy.spatial.transform import Rotation

    reference = float(model.qpos0[int(model.jnt_qposadr[index])])
    if int(model.jnt_type[index]) == SLIDE:
        return _translation(-reference * axis)
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec(-reference * axis).as_matrix()
    return pose


def _inertia(model: MjModel, body: int) -> LinkInertia | None:
    mass = float(model.body_mass[body])
    if mass <= 0.0:
        return None
    frame = _pose(model.body_ipos[body], model.body_iquat[body])
    tensor = frame[:3, :3] @ np.diag(model.body_inertia[body]) @ frame[:3, :3].T
    return LinkInertia(mass, frame[:3, 3], tensor)


def _shapes(
    model: MjModel, body: int, folder: Path
) -> tuple[tuple[DescribedShape, ...], tuple[DescribedShape, ...]]:
    collisions: list[DescribedShape] = []
    visuals: list[DescribedShape] = []
    first = int(model.body_geomadr[body])
    for index in range(first, first + int(model.body_geomnum[body])):
        built = _geometry(model, index, folder)
        if built is None:
            continue
        kind, vertices, faces, file = built
        pose = _pose(model.geom_pos[index], model.geom_quat[index])
        placed = vertices @ pose[:3, :3].T + pose[:3, 3]
        name = model.geom(index).name or (
            model.mesh(int(model.geom_dataid[index])).name if kind == "mesh" else kind
        )
        collides = bool(model.geom_contype[index] | model.geom_conaffinity[index])
        (collisions if collides else visuals).append(
            DescribedShape(name, kind, placed, faces, file)
        )
    return tuple(collisions), tuple(visuals)


def _geometry(
    model: MjModel, index: int, folder: Path
) -> tuple[str, FloatArray, IntArray, str | None] | None:
    kind = int(model.geom_type[index])
    size = np.array(model.geom_size[index])
    if kind in _PRIMITIVES:
        word, build = _PRIMITIVES[kind]
        return (word, *build(size), None)
    if kind != MESH:
        return None
    mesh = model.mesh(int(model.geom_dataid[index]))
    first = int(mesh.vertadr[0])
    count = int(mesh.vertnum[0])
    vertices = np.array(model.mesh_vert[first : first + count], dtype=np.float64)
    first = int(mesh.faceadr[0])
    count = int(mesh.facenum[0])
    faces = np.array(model.mesh_face[first : first + count], dtype=np.int64)
    return "mesh", vertices, faces, _mesh_file(model, int(model.geom_dataid[index]), folder)


#: Word and builder by geom type; MuJoCo's sizes are half extents.
_PRIMITIVES: dict[int, tuple[str, Callable[[FloatArray], tuple[FloatArray, IntArray]]]] = {
    BOX: ("box", lambda size: box(2.0 * size)),
    SPHERE: ("sphere", lambda size: ellipsoid(np.full(3, size[0]))),
    ELLIPSOID: ("ellipsoid", ellipsoid),
    CYLINDER: ("cylinder", lambda size: cylinder(float(size[0]), 2.0 * float(size[1]))),
    CAPSULE: ("capsule", lambda size: capsule(float(size[0]), 2.0 * float(size[1]))),
}


def _mesh_file(model: MjModel, mesh: int, folder: Path) -> str | None:
    """A mesh's file relative to the description's folder, so that reports hide where that is."""
    start = int(model.mesh_pathadr[mesh])
    if start < 0:
        return None
    text = bytes(model.paths)[start:].split(b"\0", 1)[0].decode("utf-8", "replace")
    return Path(os.path.relpath(folder / text, folder)).as_posix()


def _body_name(model: MjModel, body: int) -> str:
    return str(model.body(body).name) or f"body{body}"


def _joint_name(model: MjModel, joint: int) -> str:
    body = int(model.jnt_bodyid[joint])
    nameless = f"{_body_name(model, body)}_joint{joint - int(model.body_jntadr[body])}"
    return str(model.joint(joint).name) or nameless


def _translation(offset: FloatArray) -> FloatArray:
    pose = np.eye(4)
    pose[:3, 3] = offset
    return pose


def _pose(position: FloatArray, quaternion: FloatArray) -> FloatArray:
    """From a position [m] and a (w, x, y, z) unit quaternion; shape [4, 4]."""
    from scipy.spatial.transform import Rotation

    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()
    pose[:3, 3] = position
    return pose
