"""MJCF: bodies, joints and visual geoms as MuJoCo compiles them, posed at ``qpos0``.

The format: https://mujoco.readthedocs.io/en/stable/XMLreference.html.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.processes.isolation import Limits, run_isolated
from asset_factory.sim_checks.read.multiplied import refuse_multiplied
from asset_factory.sim_checks.read.native import require_word

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import Material, Mesh, Texture
from ..annotation import AnnotatedJoint
from ..files import InputFiles
from ..images import load_texture
from ..limits import require_at_most
from ..reads import digest_read
from . import primitives
from .imported import Imported
from .mjcf_files import referenced_files
from .mjcf_model import MESH, CompiledGeom, CompiledJoint, CompiledModel, compile_model

#: Time only ends what hangs, and is no verdict; the compiler has a limit of memory of its own.
COMPILER_LIMITS = Limits(wall_s=120.0, memory_bytes=8 * 1024**3)
KINDS = {"hinge": "revolute", "slide": "prismatic"}
#: Geoms of these groups are shown by MuJoCo's viewer unless asked otherwise.
SHOWN_GROUPS = range(3)


def import_mjcf(root: ET.Element, path: Path, config: IntakeConfig) -> Imported:
    """Return every body's visual geoms and every joint of an MJCF, in the world frame.

    Several joints of one body become a chain through empty parts, in their order. A free joint is
    dropped.

    Args:
        root: the ``<mujoco>`` element.
        path: the file it came from; what it refers to lies in or below that file's folder.
        config: limits on the files it refers to.

    Raises:
        InputRejected: ``unsupported_joint``, ``missing_file``, ``external_reference``,
            ``unreadable``, ``too_large``.
        TimeoutError, ChildProcessError: the compiler hung or was killed, which is no verdict.
    """
    files = referenced_files(root, path, config.max_bytes)
    size = sum(file.stat().st_size for file in files)
    require_at_most("all files together", size, config.max_bytes, "bytes")
    try:
        refuse_multiplied(path, root)
    except DescriptionError as error:
        code = error.code if error.code == "too_large" else "unreadable"
        raise InputRejected(code, error.message) from error
    # Before they are compiled: whoever changes them after this is found out by the digest.
    digests = tuple(digest_read(file) for file in (path, *files))
    model = _compiled(path)
    visuals = _visuals(model)
    faces = sum(len(model.meshes[geom.mesh].faces) for geom in visuals if geom.mesh >= 0)
    require_at_most(path.name, faces, config.max_faces, "faces")
    notes = list(model.notes)
    images = _images(model, path.parent, config)
    pieces = []
    for geom in visuals:
        mesh = _mesh_of(geom, model, images)
        if mesh is None:
            notes.append(f"body {_body_name(model, geom.body)!r}: a {geom.shape} geom is left out")
        else:
            pieces.append((geom.body, mesh))
    names, joints = _jointed(model, notes)
    return Imported(tuple(pieces), names, joints, digests, tuple(notes), "mjcf")


def _compiled(path: Path) -> CompiledModel:
    outcome = run_isolated(compile_model, str(path), limits=COMPILER_LIMITS)
    require_word(outcome, path.name)
    if isinstance(outcome.error, MemoryError):
        raise InputRejected("too_large", f"{path.name}: {outcome.error}")
    if outcome.failure is not None or outcome.value is None:
        said = " ".join(outcome.detail.replace(str(path.parent), "").split())
        raise InputRejected("unreadable", f"{path.name}: MuJoCo cannot compile it: {said}")
    return outcome.value


def _body_name(model: CompiledModel, body: int) -> str:
    return model.body_names[body] or f"body_{body}"


def _visuals(model: CompiledModel) -> list[CompiledGeom]:
    """Return the geoms to show, judged for each group of bodies welded together."""
    by_weld: dict[int, list[CompiledGeom]] = {}
    for geom in model.geoms:
        if geom.shape != "plane":
            by_weld.setdefault(model.body_weld[geom.body], []).append(geom)
    chosen = {id(geom) for geoms in by_weld.values() for geom in shown(geoms)}
    return [geom for geom in model.geoms if id(geom) in chosen]


def shown(geoms: list[CompiledGeom]) -> list[CompiledGeom]:
    """Return the geoms of one rigid body that are there to be seen.

    Where some collide and some do not, those that do not are visuals, and so is whatever shares
    their
    visibility group. Else: those in the groups a viewer shows, if there are any. Never fully
        transparent ones.
    """
    opaque = [g for g in geoms if g.rgba[3] > 0.0] or geoms
    visible = [g for g in opaque if g.group in SHOWN_GROUPS] or opaque
    quiet = {g.group for g in visible if not g.collides}
    return [g for g in visible if g.group in quiet] if quiet else visible


def _mesh_of(geom: CompiledGeom, model: CompiledModel, images: dict[int, Texture]) -> Mesh | None:
    texture = model.textures[geom.texture] if geom.texture >= 0 else None
    red, green, blue, alpha = np.clip(geom.rgba, 0.0, 1.0).tolist()
    uv = model.meshes[geom.mesh].uv if geom.shape == MESH else None
    image = images.get(geom.texture) if uv is not None else None
    if texture is not None and image is None:
        # Projected textures have no coordinates to keep: their mean colour is closest.
        red, green, blue = (c * m for c, m in zip((red, green, blue), texture.mean, strict=True))
    material = Material(geom.material or f"body_{geom.body}", (red, green, blue, alpha), image)
    mesh = _shape(geom, model, material)
    if mesh is not None and image is not None and uv is not None:
        mesh = replace(mesh, corner_uv=uv * geom.uv_scale)
    return None if mesh is None else mesh.transformed(geom.pose)


def _shape(geom: CompiledGeom, model: CompiledModel, material: Material) -> Mesh | None:
    radius, half, _ = geom.size.tolist()
    match geom.shape:
        case "mesh":
            mesh = model.meshes[geom.mesh]
            shape = Mesh.from_triangles(mesh.vertices, mesh.faces, material)
        case "box":
            shape = primitives.box(2.0 * geom.size, material)
        case "sphere":
            shape = primitives.ellipsoid((radius, radius, radius), material)
        case "ellipsoid":
            shape = primitives.ellipsoid(geom.size, material)
        case "cylinder":
            shape = primitives.cylinder(radius, 2.0 * half, material)
        case "capsule":
            shape = primitives.capsule(radius, 2.0 * half, material)
        case _:
            return None
    return shape


def _images(model: CompiledModel, folder: Path, config: IntakeConfig) -> dict[int, Texture]:
    """Return the model's flat textures that come from files, by index."""
    files = InputFiles(folder, config)
    images = {}
    for index, texture in enumerate(model.textures):
        path = folder / texture.file
        if (
            texture.flat
            and texture.file
            and path.is_file()
            and path.resolve().is_relative_to(folder.resolve())
        ):
            image = load_texture(files.read(path), path.name, files)
            if image is not None:
                images[index] = image
    return images


def _jointed(
    model: CompiledModel, notes: list[str]
) -> tuple[tuple[str, ...], tuple[AnnotatedJoint, ...]]:
    """Part names, bodies first and then carriers, and joints."""
    names = [_body_name(model, body) for body in range(len(model.body_names))]
    joints: list[AnnotatedJoint] = []
    for body in range(1, len(model.body_names)):
        parent = model.body_parent[body]
        own = [joint for joint in model.joints if joint.body == body]
        moving = [joint for joint in own if joint.kind in KINDS]
        for joint in own:
            if joint.kind == "ball":
                raise InputRejected(
                    "unsupported_joint",
                    f"joint {joint.name!r} of body {names[body]!r}: is a ball joint; "
                    "want hinge or slide joints",
                )
            if joint.kind == "free":
                notes.append(f"body {names[body]!r} floats freely in the file; it is held fixed")
        if not moving:
            joints.append(_fixed(names[body], parent, body))
        for index, joint in enumerate(moving):
            child = body if index == len(moving) - 1 else len(names)
            if child != body:
                names.append(f"{names[body]}_carrier")
            label = joint.name or f"{names[body]}_joint" + (f"_{index}" if len(moving) > 1 else "")
            joints.append(_annotated(joint, label, parent, child))
            parent = child
    return tuple(names), tuple(joints)


def _fixed(name: str, parent: int, child: int) -> AnnotatedJoint:
    return AnnotatedJoint(
        f"{name}_fixed", "fixed", parent, child, np.array([0.0, 0.0, 1.0]), np.zeros(3), None, None
    )


def _annotated(joint: CompiledJoint, name: str, parent: int, child: int) -> AnnotatedJoint:
    return AnnotatedJoint(
        name=name,
        kind=KINDS[joint.kind],
        parent=parent,
        child=child,
        axis=joint.axis,
        origin=joint.anchor,
        lower=joint.lower,
        upper=joint.upper,
        # 0 is MJCF's default: nobody said anything.
        damping=joint.damping or None,
        friction=joint.friction or None,
    )
