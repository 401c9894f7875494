"""A USD stage written as the URDF that says the same, so that every engine can be asked."""

from __future__ import annotations

import re
import warnings
from operator import attrgetter
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from ...description import DescriptionError, FloatArray, LinkInertia
from ...geometry.placing import placed
from ..native import READER_BYTES, memory_bounded
from ..urdf_elements import TENSOR
from .bodies import WORLD, PhysicsBody
from .joints import PhysicsJoint
from .layers import require_inside
from .refusing import refusing
from .shapes import PhysicsSurface
from .stage import PhysicsStage, read_stage, require_library

NAME = "asset.urdf"


def write_as_urdf(path: Path, folder: Path) -> Path:
    """Write what a USD asset says as a URDF with meshes beside it.

    A body becomes a link, with its frame where its joint is; all that no joint fastens is one
    more link, ``world``. All that the root layer at ``path`` is composed of lies in or
    below its folder. Call it in a killable child, with :func:`..native.ask_of`.

    Raises:
        DescriptionError: with a stable code, whatever is wrong with the file.
    """
    require_library(path.name)
    with refusing(path.name, path.resolve().parent), memory_bounded(READER_BYTES):
        require_inside(path, path.parent)
    stage = read_stage(path)
    if not stage.surfaces:
        raise DescriptionError("no_links", f"{path.name}: holds no surface")
    file = folder / NAME
    file.write_bytes(_Urdf(stage, folder).document(path.stem))
    return file


class _Urdf:
    def __init__(self, stage: PhysicsStage, folder: Path) -> None:
        self._stage = stage
        self._folder = folder
        self._hung = _hung(stage)
        # The world is a link where something of it is seen or moves.
        moves = any(j.kind != "fixed" and WORLD in j.bodies for j in stage.joints)
        shown = moves or any(surface.body == WORLD for surface in stage.surfaces)
        self._names = _names([path for path in stage.bodies if path != WORLD or shown])

    def document(self, name: str) -> bytes:
        """Return the whole file."""
        root = ElementTree.Element("robot", name=re.sub(r"\W", "_", name))
        for path in self._names:
            self._link(root, self._stage.bodies[path])
        for joint, child in self._hung:
            self._joint(root, joint, child)
        written: bytes = ElementTree.tostring(root, encoding="utf-8")
        return written

    def _frame(self, path: str) -> FloatArray:
        """Return a link's frame in its body's: where its joint is; of a root, the world's own."""
        for joint, child in self._hung:
            if joint.bodies[child] == path:
                return joint.frames[child]
        return np.asarray(np.linalg.inv(self._stage.bodies[path].pose))

    def _link(self, root: ElementTree.Element, body: PhysicsBody) -> None:
        link = ElementTree.SubElement(root, "link", name=self._names[body.path])
        back = np.asarray(np.linalg.inv(self._frame(body.path)), dtype=np.float64)
        if body.inertia is not None:
            _write_inertia(link, body.inertia, back)
        own = [surface for surface in self._stage.surfaces if surface.body == body.path]
        for what, counts in (("visual", attrgetter("seen")), ("collision", attrgetter("touched"))):
            for number, surface in enumerate(filter(counts, own)):
                file = f"{self._names[body.path]}_{what}_{number}.obj"
                _write_obj(self._folder / file, surface, back)
                shape = ElementTree.SubElement(link, what, name=surface.name)
                geometry = ElementTree.SubElement(shape, "geometry")
                ElementTree.SubElement(geometry, "mesh", filename=file)

    def _joint(self, root: ElementTree.Element, joint: PhysicsJoint, child: int) -> None:
        parent = joint.bodies[1 - child]
        if parent not in self._names:
            return
        endless = joint.kind == "revolute" and None in (joint.lower, joint.upper)
        kind = "continuous" if endless else joint.kind
        element = ElementTree.SubElement(root, "joint", name=joint.name, type=kind)
        ElementTree.SubElement(element, "parent", link=self._names[parent])
        ElementTree.SubElement(element, "child", link=self._names[joint.bodies[child]])
        origin = np.linalg.inv(self._frame(parent)) @ joint.frames[1 - child]
        ElementTree.SubElement(element, "origin", _place(origin))
        if kind == "fixed":
            return
        # Values count how body1 moves as body0 sees it.
        axis = joint.axis if child == 1 else -joint.axis
        ElementTree.SubElement(element, "axis", xyz=_text(axis))
        resists = {"damping": f"{joint.damping:.9g}", "friction": f"{joint.friction:.9g}"}
        ElementTree.SubElement(element, "dynamics", resists)
        if joint.mimic is not None:
            rate, offset = (f"{n:.9g}" for n in (joint.mimic.multiplier, joint.mimic.offset))
            words = {"joint": joint.mimic.leader, "multiplier": rate, "offset": offset}
            ElementTree.SubElement(element, "mimic", words)
        if joint.lower is not None and joint.upper is not None:
            limits = {"lower": f"{joint.lower:.9g}", "upper": f"{joint.upper:.9g}"}
            ElementTree.SubElement(element, "limit", limits, effort="1000", velocity="10")


def _hung(stage: PhysicsStage) -> list[tuple[PhysicsJoint, int]]:
    """Return every joint, with which of its bodies hangs on the other, from the roots down.

    A joint that would hang a body twice keeps ``body1`` below: the lint says that it is no tree.
    """
    waiting = list(stage.joints)
    held = {joint.bodies[1] for joint in waiting}
    known = {WORLD} | {path for path in stage.bodies if path not in held}
    found = []
    while waiting:
        ready = next((j for j in waiting if known & set(j.bodies)), waiting[0])
        waiting.remove(ready)
        child = 0 if ready.bodies[1] in known and ready.bodies[0] not in known else 1
        known |= set(ready.bodies)
        found.append((ready, child))
    return found


def _names(paths: list[str]) -> dict[str, str]:
    """Return a link name for each body: the prim's own, made different where two are alike."""
    names: dict[str, str] = {}
    for path in paths:
        name = re.sub(r"\W", "_", path.rpartition("/")[2]) or "world"
        while name in names.values():
            name += "_"
        names[path] = name
    return names


def _write_inertia(link: ElementTree.Element, inertia: LinkInertia, back: FloatArray) -> None:
    element = ElementTree.SubElement(link, "inertial")
    center = back[:3, :3] @ inertia.center + back[:3, 3]
    tensor = back[:3, :3] @ inertia.tensor @ back[:3, :3].T
    ElementTree.SubElement(element, "origin", xyz=_text(center))
    ElementTree.SubElement(element, "mass", value=f"{inertia.mass:.9g}")
    entries = zip(TENSOR, tensor[np.triu_indices(3)], strict=True)
    written = {name: f"{value:.9g}" for name, value in entries}
    ElementTree.SubElement(element, "inertia", written)


def _write_obj(file: Path, surface: PhysicsSurface, back: FloatArray) -> None:
    lines = [f"v {_text(vertex)}" for vertex in placed(surface.vertices, back)]
    lines += [f"f {a} {b} {c}" for a, b, c in (surface.faces + 1).tolist()]
    file.write_text("\n".join(lines) + "\n")


def _place(pose: FloatArray) -> dict[str, str]:
    """Write a pose as URDF does: a place, and angles about the fixed x, y and z axis."""
    from scipy.spatial.transform import Rotation

    with warnings.catch_warnings():
        # Where roll and yaw turn about one and the same axis, it says that it takes one for 0.
        warnings.simplefilter("ignore")
        angles = Rotation.from_matrix(pose[:3, :3]).as_euler("xyz")
    return {"xyz": _text(pose[:3, 3]), "rpy": _text(angles)}


def _text(values: FloatArray) -> str:
    return " ".join(f"{value:.9g}" for value in values)
