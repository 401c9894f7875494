"""What MuJoCo's own compiler makes of a file, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..description import FloatArray, IntArray, LinkInertia, Mimic
from ..geometry.placing import rigid

if TYPE_CHECKING:
    from mujoco import MjModel

MESH = "mesh"


@dataclass(frozen=True)
class CompiledBody:
    """A body in the pose that the file gives it.

    Attributes:
        name: empty where unnamed.
        parent: index of the body that holds it; the world holds itself.
        weld: index of the topmost body that it is rigidly part of.
        pose: its frame in its parent's, shape [4, 4].
        inertia: ``None`` for a body without mass.
        joints, geoms: indices of its own.
    """

    name: str
    parent: int
    weld: int
    pose: FloatArray
    inertia: LinkInertia | None
    joints: range
    geoms: range


@dataclass(frozen=True)
class CompiledJoint:
    """A joint of a body.

    Attributes:
        name: empty where unnamed.
        kind: ``free``, ``ball``, ``slide`` or ``hinge``.
        body: index of the body that it moves.
        axis, anchor: direction, and a point on it [m], body frame, shape [3].
        reference: its value in the file's pose [rad] or [m].
        lower, upper: [rad] or [m]; ``None`` where it has no limits.
        damping, friction: [N m s/rad, N m] or [N s/m, N].
    """

    name: str
    kind: str
    body: int
    axis: FloatArray
    anchor: FloatArray
    reference: float
    lower: float | None
    upper: float | None
    damping: float
    friction: float


@dataclass(frozen=True)
class CompiledGeom:
    """A geom of a body.

    Attributes:
        name: empty where unnamed.
        body: index of its body.
        shape: ``mesh``, ``box``, ``sphere``, ``capsule``, ``cylinder``, ``ellipsoid``, or another
            MuJoCo name.
        size: MuJoCo's half sizes [m], shape [3].
        pose: its frame in its body's, shape [4, 4].
        mesh: index into the model's meshes, or -1.
        rgba: colour, each in [0, 1].
        texture: index into the model's textures, or -1.
        uv_scale: factors on the texture coordinates.
        material: name, or empty.
        contact_type, contact_affinity: bits that must meet another geom's to collide with it.
        group: visibility group.
    """

    name: str
    body: int
    shape: str
    size: FloatArray
    pose: FloatArray
    mesh: int = -1
    rgba: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    texture: int = -1
    uv_scale: tuple[float, float] = (1.0, 1.0)
    material: str = ""
    contact_type: int = 0
    contact_affinity: int = 0
    group: int = 0

    @property
    def collides(self) -> bool:
        """Return whether it can touch anything."""
        return bool(self.contact_type | self.contact_affinity)


@dataclass(frozen=True)
class CompiledMesh:
    """Triangles in the geom's frame [m].

    Attributes:
        file: as the compiler names it; empty for one that is written in the document.
        uv: by face corner, origin bottom left, shape [face_count, 3, 2]; ``None`` without.
    """

    name: str
    file: str
    vertices: FloatArray
    faces: IntArray
    uv: FloatArray | None


@dataclass(frozen=True)
class CompiledTexture:
    """An image by name of file (empty for a built-in one) and its mean colour, RGB in [0, 1]."""

    file: str
    flat: bool
    mean: tuple[float, float, float]


@dataclass(frozen=True)
class CompiledEquality:
    """A constraint.

    Attributes:
        kind: MuJoCo's name, such as ``joint`` or ``weld``.
        joints: of kind ``joint``: indices of the follower and of its leader, -1 for none.
        constant, linear: of its polynomial, about both joints' references.
        curved: whether the polynomial has more.
        active: whether it holds from the start.
    """

    kind: str
    joints: tuple[int, int]
    constant: float
    linear: float
    active: bool
    curved: bool = False


@dataclass(frozen=True)
class CompiledModel:
    """A whole model in MuJoCo's order, the world first.

    Attributes:
        excluded: pairs of bodies that the file forbids to collide by their names.
        others: how many things there are that no other field tells, by MuJoCo's name.
        meant: joints whose range the file states and switches off; a lenient reader takes it.
    """

    bodies: tuple[CompiledBody, ...]
    joints: tuple[CompiledJoint, ...]
    geoms: tuple[CompiledGeom, ...]
    equalities: tuple[CompiledEquality, ...]
    excluded: tuple[tuple[int, int], ...]
    meshes: tuple[CompiledMesh, ...]
    textures: tuple[CompiledTexture, ...]
    others: tuple[tuple[str, int], ...]
    meant: tuple[str, ...] = ()

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Return what the bodies are called; one without a name goes by its number."""
        return tuple(body.name or f"body{index}" for index, body in enumerate(self.bodies))

    def joint_name(self, index: int) -> str:
        """Return what a joint is called; one without a name goes by its body and its place."""
        joint = self.joints[index]
        place = self.bodies[joint.body].joints.index(index)
        return joint.name or f"{self.names[joint.body]}_joint{place}"

    def mimics(self) -> dict[str, Mimic]:
        """Return follower -> leader of joint equalities; only constant and linear part.

        An equality that names no second joint locks the first one; there is no leader to tell.
        """
        found: dict[str, Mimic] = {}
        for equality in self.equalities:
            follower, leader = equality.joints
            if equality.kind != "joint" or not equality.active or leader < 0:
                continue
            # The polynomial speaks of how far both joints are from their reference.
            here, there = (self.joints[index].reference for index in equality.joints)
            offset = here + equality.constant - equality.linear * there
            mimic = Mimic(self.joint_name(leader), equality.linear, offset)
            found.setdefault(self.joint_name(follower), mimic)
        return found

    def apart(self) -> list[tuple[int, int]]:
        """Return pairs of bodies, in order, excluded by name, or whose contact bits never meet."""
        types, affinities = np.zeros((2, len(self.bodies)), dtype=np.int64)
        for geom in self.geoms:
            types[geom.body] |= geom.contact_type
            affinities[geom.body] |= geom.contact_affinity
        meet = (types[:, None] & affinities[None, :]) | (affinities[:, None] & types[None, :])
        solid = (types | affinities) != 0
        strangers = np.argwhere((meet == 0) & solid[:, None] & solid[None, :]).tolist()
        return sorted({(min(a, b), max(a, b)) for a, b in (*self.excluded, *strangers) if a != b})


def read_model(model: MjModel, meant: tuple[str, ...] = ()) -> CompiledModel:
    """Return all of a compiled model, with the joints that were given a range."""
    return CompiledModel(
        bodies=tuple(_body(model, i) for i in range(model.nbody)),
        joints=tuple(_joint(model, i) for i in range(model.njnt)),
        geoms=tuple(_geom(model, i) for i in range(model.ngeom)),
        equalities=tuple(_equality(model, i) for i in range(model.neq)),
        excluded=tuple(divmod(int(pair), 1 << 16) for pair in model.exclude_signature),
        meshes=tuple(_mesh(model, i) for i in range(model.nmesh)),
        textures=tuple(_texture(model, i) for i in range(model.ntex)),
        others=(("tendon", model.ntendon), ("flex", model.nflex), ("skin", model.nskin)),
        meant=meant,
    )


def _body(model: MjModel, index: int) -> CompiledBody:
    mass = float(model.body_mass[index])
    inertia = None
    if mass > 0.0:
        frame = _pose(model.body_ipos[index], model.body_iquat[index])
        tensor = frame[:3, :3] @ np.diag(model.body_inertia[index]) @ frame[:3, :3].T
        inertia = LinkInertia(mass, frame[:3, 3], tensor)
    joint = int(model.body_jntadr[index])
    geom = int(model.body_geomadr[index])
    return CompiledBody(
        name=str(model.body(index).name),
        parent=int(model.body_parentid[index]),
        weld=int(model.body_weldid[index]),
        pose=_pose(model.body_pos[index], model.body_quat[index]),
        inertia=inertia,
        joints=range(joint, joint + int(model.body_jntnum[index])),
        geoms=range(geom, geom + int(model.body_geomnum[index])),
    )


def _joint(model: MjModel, index: int) -> CompiledJoint:
    import mujoco

    limited = bool(model.jnt_limited[index])
    lower, upper = (float(value) for value in model.jnt_range[index])
    dof = int(model.jnt_dofadr[index])
    return CompiledJoint(
        name=str(model.joint(index).name),
        kind=mujoco.mjtJoint(model.jnt_type[index]).name.removeprefix("mjJNT_").lower(),
        body=int(model.jnt_bodyid[index]),
        axis=np.array(model.jnt_axis[index]),
        anchor=np.array(model.jnt_pos[index]),
        reference=float(model.qpos0[int(model.jnt_qposadr[index])]),
        lower=lower if limited else None,
        upper=upper if limited else None,
        damping=float(np.ravel(model.dof_damping[dof])[0]),
        friction=float(np.ravel(model.dof_frictionloss[dof])[0]),
    )


def _geom(model: MjModel, index: int) -> CompiledGeom:
    import mujoco

    material = int(model.geom_matid[index])
    shape = mujoco.mjtGeom(model.geom_type[index]).name.removeprefix("mjGEOM_").lower()
    color = model.geom_rgba[index] if material < 0 else model.mat_rgba[material]
    red, green, blue, alpha = color.tolist()
    return CompiledGeom(
        name=str(model.geom(index).name),
        body=int(model.geom_bodyid[index]),
        shape=shape,
        size=np.array(model.geom_size[index]),
        pose=_pose(model.geom_pos[index], model.geom_quat[index]),
        # A signed-distance geom carries an ordinary mesh as well.
        mesh=int(model.geom_dataid[index]) if shape in (MESH, "sdf") else -1,
        rgba=(red, green, blue, alpha),
        texture=-1 if material < 0 else _texture_of(model, material),
        uv_scale=(1.0, 1.0) if material < 0 else tuple(model.mat_texrepeat[material].tolist()),
        material="" if material < 0 else str(model.mat(material).name),
        contact_type=int(model.geom_contype[index]),
        contact_affinity=int(model.geom_conaffinity[index]),
        group=int(model.geom_group[index]),
    )


def _texture_of(model: MjModel, material: int) -> int:
    import mujoco

    roles = (mujoco.mjtTextureRole.mjTEXROLE_RGB, mujoco.mjtTextureRole.mjTEXROLE_RGBA)
    textures = (int(model.mat_texid[material][int(role)]) for role in roles)
    return next((texture for texture in textures if texture >= 0), -1)


def _mesh(model: MjModel, index: int) -> CompiledMesh:
    mesh = model.mesh(index)
    first = int(mesh.vertadr[0])
    count = int(mesh.vertnum[0])
    face = int(mesh.faceadr[0])
    face_count = int(mesh.facenum[0])
    uv = None
    if model.mesh_texcoordnum[index] > 0:
        start = model.mesh_texcoordadr[index]
        end = start + model.mesh_texcoordnum[index]
        # MuJoCo counts rows from the top of the image.
        uv = model.mesh_texcoord[start:end].astype(np.float64) * [1.0, -1.0] + [0.0, 1.0]
        uv = uv[model.mesh_facetexcoord[face : face + face_count]]
    return CompiledMesh(
        name=str(mesh.name),
        file=_file(model, int(model.mesh_pathadr[index])),
        vertices=model.mesh_vert[first : first + count].astype(np.float64),
        faces=model.mesh_face[face : face + face_count].astype(np.int64),
        uv=uv,
    )


def _texture(model: MjModel, index: int) -> CompiledTexture:
    import mujoco

    channels = int(model.tex_nchannel[index])
    start = int(model.tex_adr[index])
    size = int(model.tex_width[index]) * int(model.tex_height[index]) * channels
    pixels = model.tex_data[start : start + size].reshape(-1, channels)
    mean = pixels.mean(axis=0) / 255.0 if len(pixels) else np.ones(channels)
    red, green, blue = (mean[:3] if channels > 2 else np.repeat(mean[:1], 3)).tolist()
    return CompiledTexture(
        file=_file(model, int(model.tex_pathadr[index])),
        flat=int(model.tex_type[index]) == int(mujoco.mjtTexture.mjTEXTURE_2D),
        mean=(red, green, blue),
    )


def _equality(model: MjModel, index: int) -> CompiledEquality:
    import mujoco

    constant, linear = (float(number) for number in model.eq_data[index, :2])
    return CompiledEquality(
        kind=mujoco.mjtEq(model.eq_type[index]).name.removeprefix("mjEQ_").lower(),
        joints=(int(model.eq_obj1id[index]), int(model.eq_obj2id[index])),
        constant=constant,
        linear=linear,
        active=bool(model.eq_active0[index]),
        curved=bool(model.eq_data[index, 2:5].any()),
    )


def _file(model: MjModel, start: int) -> str:
    """Return a name in the model's list of files; empty for none."""
    if start < 0:
        return ""
    return bytes(model.paths[start:]).split(b"\0", 1)[0].decode("utf-8", "replace")


def _pose(position: FloatArray, quaternion: FloatArray) -> FloatArray:
    """Return the pose of a position [m] and a (w, x, y, z) unit quaternion; shape [4, 4]."""
    from scipy.spatial.transform import Rotation

    return rigid(Rotation.from_quat(np.roll(quaternion, -1)).as_matrix(), position)
