"""MJCF: bodies, joints and visual geoms as MuJoCo compiles them, posed at ``qpos0``.

The format: https://mujoco.readthedocs.io/en/stable/XMLreference.html.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.description import DescriptionError, Mimic
from asset_factory.sim_checks.read.mjcf import PRIMITIVES
from asset_factory.sim_checks.read.mjcf_compiler import compile_model
from asset_factory.sim_checks.read.mjcf_model import (
    CompiledEquality,
    CompiledGeom,
    CompiledJoint,
    CompiledModel,
)
from asset_factory.sim_checks.read.multiplied import refuse_multiplied
from asset_factory.sim_checks.read.native import read_apart
from asset_factory.sim_checks.read.references import MujocoModel, follow_models

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import FloatArray, Material, Mesh, Texture
from ..annotation import AnnotatedJoint
from ..files import InputFiles
from ..images import load_texture
from ..limits import require_at_most
from ..reads import ReadLog
from .imported import Imported, fixed
from .xml_source import read_xml

KINDS = {"hinge": "revolute", "slide": "prismatic"}
#: Geoms of these groups are shown by MuJoCo's viewer unless asked otherwise.
SHOWN_GROUPS = range(3)


def import_mjcf(root: ET.Element, path: Path, config: IntakeConfig, log: ReadLog) -> Imported:
    """Return every body's visual geoms and every joint of an MJCF, in the world frame.

    Several joints of one body become a chain through empty parts, in their order. A free joint is
    dropped.

    What ``path`` refers to lies in or below its folder.

    Raises:
        InputRejected: ``unsupported_joint``, ``too_large``.
        DescriptionError: what its reader refuses.
        TimeoutError, ChildProcessError: the compiler hung or was killed, which is no verdict.
    """
    models = follow_models(path, root, partial(read_xml, max_bytes=config.max_bytes, log=log))
    files = _referenced_files(models, path.name)
    size = sum(file.stat().st_size for file in files)
    require_at_most("all files together", size, config.max_bytes, "bytes")
    refuse_multiplied(path.name, models)
    # Before they are compiled: whoever changes them after this is found out by the digest.
    digests = tuple(log.digest(file) for file in (path, *files))
    model = read_apart(partial(compile_model, lenient=True), path)
    visuals = _visuals(model)
    notes = list(_notes(model))
    images = _images(model, InputFiles(path.parent, config, log), path.parent)
    poses = _world_poses(model)
    pieces = []
    faces = 0
    for geom in visuals:
        mesh = _mesh_of(geom, model, images)
        if mesh is None:
            notes.append(f"body {_body_name(model, geom.body)!r}: a {geom.shape} geom is left out")
            continue
        faces += len(mesh.faces)
        require_at_most(path.name, faces, config.max_faces, "faces")
        pieces.append((geom.body, mesh.transformed(poses[geom.body] @ geom.pose)))
    names, joints = _jointed(model, poses, notes)
    return Imported(tuple(pieces), names, joints, digests, tuple(notes), "mjcf")


def _referenced_files(models: list[MujocoModel], name: str) -> list[Path]:
    """Return every file that an MJCF and its inner documents refer to, each once."""
    found: dict[Path, None] = {}
    for named in (each for model in models for each in model.named):
        if not named.files:
            message = f"{name}: {named.said} is not there; want it below its folder"
            raise DescriptionError("missing_file", message, named.places)
        found |= dict.fromkeys(named.files)
    return list(found)


def _world_poses(model: CompiledModel) -> list[FloatArray]:
    """Return the pose of each body in the world, shape [4, 4] each; parents come first."""
    poses: list[FloatArray] = []
    for index, body in enumerate(model.bodies):
        poses.append(poses[body.parent] @ body.pose if index else body.pose)
    return poses


def _notes(model: CompiledModel) -> Iterator[str]:
    """Yield what the file says and the import ignores."""
    for equality in model.equalities:
        if not _is_mimic(equality):
            yield f"a {equality.kind} equality in the file is ignored"
    for name in model.meant:
        yield f"joint {name!r} has a range that the file switches off; it is taken as its limits"
    for what, count in model.others:
        if count:
            yield f"the file has {count} {what}(s), which are ignored"


def _body_name(model: CompiledModel, body: int) -> str:
    return model.bodies[body].name or f"body_{body}"


def _visuals(model: CompiledModel) -> list[CompiledGeom]:
    """Return the geoms to show, chosen for each group of bodies welded together."""
    by_weld: dict[int, list[CompiledGeom]] = {}
    for geom in model.geoms:
        if geom.shape != "plane":
            by_weld.setdefault(model.bodies[geom.body].weld, []).append(geom)
    chosen = {id(geom) for geoms in by_weld.values() for geom in shown(geoms)}
    return [geom for geom in model.geoms if id(geom) in chosen]


def shown(geoms: list[CompiledGeom]) -> list[CompiledGeom]:
    """Return the geoms of one rigid body that are there to be seen.

    Where some collide and some do not, those that do not are visuals, and so is whatever shares
    their visibility group. Else: those in the groups a viewer shows, if there are any. Never fully
    transparent ones.
    """
    opaque = [g for g in geoms if g.rgba[3] > 0.0] or geoms
    visible = [g for g in opaque if g.group in SHOWN_GROUPS] or opaque
    quiet = {g.group for g in visible if not g.collides}
    return [g for g in visible if g.group in quiet] if quiet else visible


def _mesh_of(geom: CompiledGeom, model: CompiledModel, images: dict[int, Texture]) -> Mesh | None:
    texture = model.textures[geom.texture] if geom.texture >= 0 else None
    red, green, blue, alpha = np.clip(geom.rgba, 0.0, 1.0).tolist()
    uv = model.meshes[geom.mesh].uv if geom.mesh >= 0 else None
    image = images.get(geom.texture) if uv is not None else None
    if texture is not None and image is None:
        # Projected textures have no coordinates to keep: their mean colour is closest.
        red, green, blue = (c * m for c, m in zip((red, green, blue), texture.mean, strict=True))
    material = Material(geom.material or f"body_{geom.body}", (red, green, blue, alpha), image)
    mesh = _shape(geom, model, material)
    if mesh is not None and image is not None and uv is not None:
        mesh = replace(mesh, corner_uv=uv * geom.uv_scale)
    return mesh


def _shape(geom: CompiledGeom, model: CompiledModel, material: Material) -> Mesh | None:
    if geom.mesh >= 0:
        mesh = model.meshes[geom.mesh]
        return Mesh.from_triangles(mesh.vertices, mesh.faces, material)
    make = PRIMITIVES.get(geom.shape)
    return None if make is None else Mesh.from_triangles(*make(geom.size), material)


def _images(model: CompiledModel, files: InputFiles, folder: Path) -> dict[int, Texture]:
    """Return the model's flat textures that come from files, by index."""
    images = {}
    for index, texture in enumerate(model.textures):
        path = folder / texture.file
        there = texture.flat and texture.file and path.is_file()
        if there and path.resolve().is_relative_to(folder.resolve()):
            image = load_texture(files.read(path), path.name, files)
            if image is not None:
                images[index] = image
    return images


def _jointed(
    model: CompiledModel, poses: list[FloatArray], notes: list[str]
) -> tuple[tuple[str, ...], tuple[AnnotatedJoint, ...]]:
    """Return part names, bodies first and then carriers, and joints."""
    names = [_body_name(model, body) for body in range(len(model.bodies))]
    joints: list[AnnotatedJoint] = []
    labels: dict[int, str] = {}
    for body in range(1, len(model.bodies)):
        parent = model.bodies[body].parent
        own = model.bodies[body].joints
        moving = [index for index in own if model.joints[index].kind in KINDS]
        for joint in (model.joints[index] for index in own):
            if joint.kind == "ball":
                where = f"joint {joint.name!r} of body {names[body]!r}"
                why = "is a ball joint; want hinge or slide joints"
                raise InputRejected("unsupported_joint", f"{where}: {why}")
            if joint.kind == "free":
                notes.append(f"body {names[body]!r} floats freely in the file; it is held fixed")
        if not moving:
            joints.append(fixed(f"{names[body]}_fixed", parent, body))
        for place, index in enumerate(moving):
            joint = model.joints[index]
            child = body if index == moving[-1] else len(names)
            if child != body:
                names.append(f"{names[body]}_carrier")
            label = joint.name or f"{names[body]}_joint" + (f"_{place}" if len(moving) > 1 else "")
            labels[index] = label
            joints.append(_annotated(joint, label, parent, child, poses[body]))
            parent = child
    mimics = _mimics(model, labels)
    return tuple(names), tuple(replace(j, mimic=mimics.get(j.name)) for j in joints)


def _is_mimic(equality: CompiledEquality) -> bool:
    """Return whether a joint goes by another's value at one ratio."""
    coupled = equality.kind == "joint" and equality.joints[1] >= 0
    return coupled and equality.active and not equality.curved


def _mimics(model: CompiledModel, labels: Mapping[int, str]) -> dict[str, Mimic]:
    """Return follower -> what it follows, constant and linear part; values count from references.

    ``labels`` are names of moving joints by index.
    """
    found: dict[str, Mimic] = {}
    for equality in model.equalities:
        if _is_mimic(equality) and set(equality.joints) <= set(labels):
            follower, leader = (labels[index] for index in equality.joints)
            found.setdefault(follower, Mimic(leader, equality.linear, equality.constant))
    return found


def _annotated(
    joint: CompiledJoint, name: str, parent: int, child: int, pose: FloatArray
) -> AnnotatedJoint:
    """Return a joint of a body that the file poses so; limits count from there."""
    limits = (joint.lower, joint.upper)
    lower, upper = (None if each is None else each - joint.reference for each in limits)
    return AnnotatedJoint(
        name=name,
        kind=KINDS[joint.kind],
        parent=parent,
        child=child,
        axis=pose[:3, :3] @ joint.axis,
        origin=pose[:3, :3] @ joint.anchor + pose[:3, 3],
        lower=lower,
        upper=upper,
        # 0 is MJCF's default: nobody said anything.
        damping=joint.damping or None,
        friction=joint.friction or None,
    )
