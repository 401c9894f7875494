"""MJCF as MuJoCo compiles it: defaults, classes and inferred inertias are the compiler's."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..description import DescribedShape, Description, FloatArray, IntArray, JointLine, Link
from ..geometry.kinematics import rotation_about
from ..geometry.placing import placed, rigid
from .mjcf_compiler import compile_model
from .mjcf_model import MESH, CompiledGeom, CompiledJoint, CompiledModel
from .multiplied import refuse_multiplied
from .primitives import box, capsule, cylinder, ellipsoid
from .references import follow_models


def read_mjcf(path: Path, document: ET.Element) -> Description:
    """Compile an MJCF file with MuJoCo and describe its bodies, joints and geoms.

    Its own root element is given, what it includes is read.

    A geom collides when ``contype`` or ``conaffinity`` is set, else it is visual; planes and height
    fields are left out. A joint that does not pass through its body's origin, and all but the last
    of a body's joints, get a virtual link of their own, so that every joint is an axis through its
    child's origin. Call in a killable child: the compiler is native code.

    Raises:
        DescriptionError: with MuJoCo's own words.
    """
    refuse_multiplied(path.name, follow_models(path, document))
    return _Describer(compile_model(path), path.parent.resolve()).describe(path)


class _Describer:
    """Says of a compiled model what a description says."""

    def __init__(self, model: CompiledModel, folder: Path) -> None:
        self._model = model
        self._folder = folder
        self._links: list[Link] = []
        self._lines: list[JointLine] = []

    def describe(self, path: Path) -> Description:
        for index, body in enumerate(self._model.bodies):
            if index > 0:
                self._place(index)
            shapes: dict[bool, list[DescribedShape]] = {True: [], False: []}
            for geom in self._model.geoms[body.geoms.start : body.geoms.stop]:
                if (shape := self._shape(geom)) is not None:
                    shapes[geom.collides].append(shape)
            both = (tuple(shapes[True]), tuple(shapes[False]))
            self._links.append(Link(self._model.names[index], body.inertia, *both))
        mimics = self._model.mimics()
        joints = tuple(replace(line, mimic=mimics.get(line.name)) for line in self._lines)
        names = self._model.names
        excluded = frozenset(frozenset((names[a], names[b])) for a, b in self._model.apart())
        return Description(path, "mjcf", tuple(self._links), joints, excluded)

    def _place(self, body: int) -> None:
        """Append the joints that hold a body, and the virtual links between them."""
        name = self._model.names[body]
        parent = self._model.names[self._model.bodies[body].parent]
        pending = self._model.bodies[body].pose
        joints = self._model.bodies[body].joints
        for index in joints:
            joint = self._model.joints[index]
            label = self._model.joint_name(index)
            if joint.kind in ("free", "ball"):
                word = "floating" if joint.kind == "free" else "ball"
                child = self._virtual(name, label)
                self._lines.append(_line(label, word, parent, child, pending))
                pending = np.eye(4)
            else:
                last = index == joints[-1] and not joint.anchor.any()
                child = name if last else self._virtual(name, label)
                before = pending @ _translation(joint.anchor) @ _undo_reference(joint)
                self._lines.append(_moving(joint, label, (parent, child), before))
                pending = _translation(-joint.anchor)
            parent = child
        if parent != name:
            self._lines.append(_line(f"{name}_fixed", "fixed", parent, name, pending))

    def _virtual(self, body: str, joint: str) -> str:
        name = f"{body}@{joint}"
        self._links.append(Link(name, None, (), (), virtual=True))
        return name

    def _shape(self, geom: CompiledGeom) -> DescribedShape | None:
        file = None
        if geom.shape in PRIMITIVES:
            vertices, faces = PRIMITIVES[geom.shape](geom.size)
            name = geom.shape
        elif geom.shape == MESH:
            mesh = self._model.meshes[geom.mesh]
            vertices = mesh.vertices
            faces = mesh.faces
            name = mesh.name
            # Reports do not tell where the folder is.
            place = os.path.relpath(self._folder / mesh.file, self._folder)
            file = Path(place).as_posix() if mesh.file else None
        else:
            return None
        vertices = placed(vertices, geom.pose)
        return DescribedShape(geom.name or name, geom.shape, vertices, faces, file)


def _line(name: str, kind: str, parent: str, child: str, origin: FloatArray) -> JointLine:
    return JointLine(name, kind, parent, child, origin, np.array([0.0, 0.0, 1.0]), None, None)


def _moving(
    joint: CompiledJoint, name: str, ends: tuple[str, str], origin: FloatArray
) -> JointLine:
    turning = "continuous" if joint.lower is None else "revolute"
    kind = "prismatic" if joint.kind == "slide" else turning
    limits = (joint.lower, joint.upper)
    resists = (joint.damping, joint.friction)
    return JointLine(name, kind, *ends, origin, joint.axis, *limits, *resists)


def _undo_reference(joint: CompiledJoint) -> FloatArray:
    """Return the way from the compiled pose, at the joint's reference, to the pose at value 0."""
    if joint.kind == "slide":
        return _translation(-joint.reference * joint.axis)
    return rigid(rotation_about(joint.axis, -joint.reference), np.zeros(3))


#: Builders by MuJoCo's name of a shape; its sizes are half extents.
PRIMITIVES: dict[str, Callable[[FloatArray], tuple[FloatArray, IntArray]]] = {
    "box": lambda size: box(2.0 * size),
    "sphere": lambda size: ellipsoid(np.full(3, size[0])),
    "ellipsoid": ellipsoid,
    "cylinder": lambda size: cylinder(float(size[0]), 2.0 * float(size[1])),
    "capsule": lambda size: capsule(float(size[0]), 2.0 * float(size[1])),
}


def _translation(offset: FloatArray) -> FloatArray:
    return rigid(np.eye(3), offset)
