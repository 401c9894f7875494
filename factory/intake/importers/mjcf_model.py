"""MuJoCo's own compiler, in a child process, read back as plain arrays.

MJCF has defaults, classes, includes, frames and half a dozen ways to write a rotation; the only
faithful reader is the compiler itself. It is native code on somebody else's file, so it runs where
it can die.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from asset_factory.sim_checks.read.native import COMPILER_BYTES, memory_bounded

from ...mesh import FloatArray, IntArray

if TYPE_CHECKING:
    import mujoco

MESH = "mesh"


@dataclass(frozen=True)
class CompiledGeom:
    """One geom at ``qpos0``.

    Attributes:
        body: index of its body.
        shape: ``mesh``, ``box``, ``sphere``, ``capsule``, ``cylinder``, ``ellipsoid``, or another
            MuJoCo name.
        size: MuJoCo's half sizes [m], shape [3].
        pose: geom frame to world frame, shape [4, 4].
        mesh: index into the model's meshes, or -1.
        rgba: colour, each in [0, 1].
        texture: index into the model's textures, or -1.
        uv_scale: factors on the texture coordinates.
        material: name, or empty.
        collides: whether it can touch anything.
        group: visibility group.
    """

    body: int
    shape: str
    size: FloatArray
    pose: FloatArray
    mesh: int
    rgba: tuple[float, float, float, float]
    texture: int
    uv_scale: tuple[float, float]
    material: str
    collides: bool
    group: int


@dataclass(frozen=True)
class CompiledJoint:
    """A joint at ``qpos0``, world frame; ``kind``: ``free``, ``ball``, ``slide`` or ``hinge``."""

    name: str
    kind: str
    body: int
    axis: FloatArray
    anchor: FloatArray
    lower: float | None
    upper: float | None
    damping: float
    friction: float


@dataclass(frozen=True)
class CompiledMesh:
    """Triangles in the geom's frame [m]; ``uv`` by face corner, origin bottom left, or ``None``."""

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
class CompiledModel:
    """What the lift needs of a compiled model; bodies in MuJoCo's order, the world first.

    Attributes:
        body_names: empty where unnamed.
        body_parent: shape [body_count]; the world is its own parent.
        body_weld: index of the topmost body each is rigidly part of, shape [body_count].
    """

    body_names: tuple[str, ...]
    body_parent: tuple[int, ...]
    body_weld: tuple[int, ...]
    joints: tuple[CompiledJoint, ...]
    geoms: tuple[CompiledGeom, ...]
    meshes: tuple[CompiledMesh, ...]
    textures: tuple[CompiledTexture, ...]
    notes: tuple[str, ...]


def compile_model(path: str) -> CompiledModel:
    """Compile the MJCF file at ``path``; call it in a child process.

    Raises:
        ValueError: what MuJoCo's compiler says is wrong.
        MemoryError: it takes too much.
    """
    import mujoco

    # Its own way is a log file in whatever folder the program was started from.
    mujoco.set_mju_user_warning(_say)
    with memory_bounded(COMPILER_BYTES):
        model = _compiled(path)
        data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return CompiledModel(
        body_names=tuple(model.body(i).name for i in range(model.nbody)),
        body_parent=tuple(model.body_parentid.tolist()),
        body_weld=tuple(model.body_weldid.tolist()),
        joints=tuple(_joint(model, data, i) for i in range(model.njnt)),
        geoms=tuple(_geom(model, data, i) for i in range(model.ngeom)),
        meshes=tuple(_mesh(model, i) for i in range(model.nmesh)),
        textures=tuple(_texture(model, i) for i in range(model.ntex)),
        notes=_notes(model),
    )


def _say(words: str) -> None:
    os.write(2, f"MuJoCo: {words}\n".encode())


def _compiled(path: str) -> mujoco.MjModel:
    import mujoco

    def prepared() -> mujoco.MjSpec:
        spec = mujoco.MjSpec.from_file(path)
        # Looks and names are what the lift is after; both options would drop them.
        spec.compiler.discardvisual = False
        spec.compiler.fusestatic = False
        return spec

    try:
        return prepared().compile()
    except ValueError:
        # Masses are made anew downstream: a body too thin for MuJoCo's own is no reason to refuse.
        lenient = prepared()
        lenient.compiler.boundmass = 1e-3
        lenient.compiler.boundinertia = 1e-6
        lenient.compiler.balanceinertia = True
        for mesh in lenient.meshes:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        return lenient.compile()


def _joint(model: mujoco.MjModel, data: mujoco.MjData, index: int) -> CompiledJoint:
    import mujoco

    kind = mujoco.mjtJoint(model.jnt_type[index]).name.removeprefix("mjJNT_").lower()
    rest = float(model.qpos0[model.jnt_qposadr[index]])
    limited = bool(model.jnt_limited[index])
    lower, upper = (model.jnt_range[index] - rest).tolist()
    dof = model.jnt_dofadr[index]
    return CompiledJoint(
        name=model.joint(index).name,
        kind=kind,
        body=int(model.jnt_bodyid[index]),
        axis=np.array(data.xaxis[index]),
        anchor=np.array(data.xanchor[index]),
        lower=lower if limited else None,
        upper=upper if limited else None,
        damping=float(np.ravel(model.dof_damping[dof])[0]),
        friction=float(np.ravel(model.dof_frictionloss[dof])[0]),
    )


def _geom(model: mujoco.MjModel, data: mujoco.MjData, index: int) -> CompiledGeom:
    import mujoco

    pose = np.eye(4)
    pose[:3, :3] = data.geom_xmat[index].reshape(3, 3)
    pose[:3, 3] = data.geom_xpos[index]
    material = int(model.geom_matid[index])
    shape = mujoco.mjtGeom(model.geom_type[index]).name.removeprefix("mjGEOM_").lower()
    # A signed-distance geom carries an ordinary mesh as well.
    has_mesh = shape in (MESH, "sdf") and model.geom_dataid[index] >= 0
    red, green, blue, alpha = (
        model.geom_rgba[index] if material < 0 else model.mat_rgba[material]
    ).tolist()
    return CompiledGeom(
        body=int(model.geom_bodyid[index]),
        shape=MESH if has_mesh else shape,
        size=np.array(model.geom_size[index]),
        pose=pose,
        mesh=int(model.geom_dataid[index]) if has_mesh else -1,
        rgba=(red, green, blue, alpha),
        texture=-1 if material < 0 else _texture_of(model, material),
        uv_scale=(1.0, 1.0) if material < 0 else tuple(model.mat_texrepeat[material].tolist()),
        material="" if material < 0 else model.mat(material).name,
        collides=bool(model.geom_contype[index] or model.geom_conaffinity[index]),
        group=int(model.geom_group[index]),
    )


def _texture_of(model: mujoco.MjModel, material: int) -> int:
    import mujoco

    roles = model.mat_texid[material]
    for role in (mujoco.mjtTextureRole.mjTEXROLE_RGB, mujoco.mjtTextureRole.mjTEXROLE_RGBA):
        if roles[int(role)] >= 0:
            return int(roles[int(role)])
    return -1


def _mesh(model: mujoco.MjModel, index: int) -> CompiledMesh:
    first = model.mesh_vertadr[index]
    count = model.mesh_vertnum[index]
    face = model.mesh_faceadr[index]
    face_count = model.mesh_facenum[index]
    uv = None
    if model.mesh_texcoordnum[index] > 0:
        start = model.mesh_texcoordadr[index]
        coordinates = model.mesh_texcoord[start : start + model.mesh_texcoordnum[index]].astype(
            np.float64
        )
        # MuJoCo counts rows from the top of the image.
        uv = (coordinates * [1.0, -1.0] + [0.0, 1.0])[
            model.mesh_facetexcoord[face : face + face_count]
        ]
    return CompiledMesh(
        vertices=model.mesh_vert[first : first + count].astype(np.float64),
        faces=model.mesh_face[face : face + face_count].astype(np.int64),
        uv=uv,
    )


def _texture(model: mujoco.MjModel, index: int) -> CompiledTexture:
    import mujoco

    channels = int(model.tex_nchannel[index])
    start = int(model.tex_adr[index])
    pixels = model.tex_data[
        start : start + int(model.tex_width[index]) * int(model.tex_height[index]) * channels
    ]
    mean = pixels.reshape(-1, channels).mean(axis=0) / 255.0 if len(pixels) else np.ones(channels)
    red, green, blue = (mean[:3] if channels > 2 else np.repeat(mean[:1], 3)).tolist()
    return CompiledTexture(
        file=_texture_file(model, index),
        flat=int(model.tex_type[index]) == int(mujoco.mjtTexture.mjTEXTURE_2D),
        mean=(red, green, blue),
    )


def _texture_file(model: mujoco.MjModel, index: int) -> str:
    start = int(model.tex_pathadr[index])
    if start < 0:
        return ""
    return bytes(model.paths[start:]).split(b"\0", 1)[0].decode("utf-8", "replace")


def _notes(model: mujoco.MjModel) -> tuple[str, ...]:
    import mujoco

    notes = []
    for index in range(model.neq):
        kind = mujoco.mjtEq(model.eq_type[index]).name.removeprefix("mjEQ_").lower()
        if kind == "joint":
            first = model.joint(int(model.eq_obj1id[index])).name
            notes.append(
                f"joint {first!r} is coupled by an equality in the file; "
                "that is ignored, it moves freely"
            )
        else:
            notes.append(f"a {kind} equality in the file is ignored")
    for what, count in (("tendon", model.ntendon), ("flex", model.nflex), ("skin", model.nskin)):
        if count:
            notes.append(f"the file has {count} {what}(s), which are ignored")
    return tuple(notes)
