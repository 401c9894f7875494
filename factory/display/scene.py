"""A scene: coloured surfaces on links, convex hulls, and the joints that move them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..articulation import rotation_about
from ..mesh import FloatArray, freeze

FloatRows = npt.NDArray[np.float32]
IndexRows = npt.NDArray[np.int32]
Color = tuple[float, float, float, float]

#: Shown of a joint without limits: turns so far [rad], slides so far [m].
UNLIMITED = {"continuous": 1.5, "revolute": 1.5, "prismatic": 0.2}
#: By how much of the whole movement the last joint starts later than the first.
STAGGER = 0.6


@dataclass(frozen=True)
class SceneSurface:
    """Triangles of one look on one link.

    Attributes:
        link: index into the scene's links.
        vertices: [m], link frame, shape [vertex_count, 3], float32.
        faces: shape [face_count, 3], int32.
        normals: unit, per vertex, shape [vertex_count, 3]; ``None``: every triangle is flat.
        uv: texture coordinates, origin bottom left, shape [vertex_count, 2]; ``None`` without.
        color: linear RGBA in [0, 1], multiplied with the image.
        image: a PNG or JPEG file's bytes; ``None`` for a plain color.
    """

    link: int
    vertices: FloatRows
    faces: IndexRows
    normals: FloatRows | None = None
    uv: FloatRows | None = None
    color: Color = (0.7, 0.7, 0.7, 1.0)
    image: bytes | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        freeze(self, "vertices", "normals", "uv", dtype=np.float32)
        freeze(self, "faces", dtype=np.int32)
        if self.faces.size and not 0 <= self.faces.min() <= self.faces.max() < len(self.vertices):
            raise ValueError(f"surface: a face index is outside 0..{len(self.vertices) - 1}")
        if not np.isfinite(self.vertices).all():
            raise ValueError("surface: a vertex is not finite")


@dataclass(frozen=True)
class SceneJoint:
    """A joint, as URDF has it.

    Attributes:
        name: unique in the scene.
        kind: ``revolute``, ``continuous``, ``prismatic`` or ``fixed``.
        parent, child: indices of links, parents first.
        origin: child frame in the parent frame at value 0, shape [4, 4].
        axis: unit, child frame, shape [3].
        lower, upper: [rad] or [m]; lower is closed.
        leader: name of the joint that this one follows; empty for a free one.
        multiplier, offset: ``value = multiplier * leader + offset``.
    """

    name: str
    kind: str
    parent: int
    child: int
    origin: FloatArray
    axis: FloatArray
    lower: float = 0.0
    upper: float = 0.0
    leader: str = ""
    multiplier: float = 1.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        freeze(self, "origin", "axis")

    @property
    def moves(self) -> bool:
        """Return whether it has a degree of freedom."""
        return self.kind != "fixed"

    @property
    def slides(self) -> bool:
        """Return whether its values are lengths."""
        return self.kind == "prismatic"

    def motion(self, value: float) -> FloatArray:
        """Return what it adds to its origin at ``value`` [rad] or [m], shape [4, 4]."""
        pose = np.eye(4)
        if self.slides:
            pose[:3, 3] = value * self.axis
        elif self.moves:
            pose[:3, :3] = rotation_about(self.axis, value)
        return pose


@dataclass(frozen=True)
class SceneGraph:
    """An articulated object, ready to be shown.

    Attributes:
        name: of the object.
        links: names, root first, parents before children.
        joints: parents first; each link but the root is the child of one.
        visuals: visible surfaces.
        hulls: convex pieces, what engines collide with.
        replaced: those that repairs took away or made otherwise.
    """

    name: str
    links: tuple[str, ...]
    joints: tuple[SceneJoint, ...]
    visuals: tuple[SceneSurface, ...]
    hulls: tuple[SceneSurface, ...] = ()
    replaced: tuple[SceneSurface, ...] = ()

    def __post_init__(self) -> None:
        seen = {0}
        for joint in self.joints:
            if joint.parent not in seen or joint.child in seen or joint.child >= len(self.links):
                raise ValueError(f"joint {joint.name!r}: links are no tree, parents first")
            seen.add(joint.child)
        if len(seen) != len(self.links):
            raise ValueError(f"{len(self.links) - len(seen)} links hang on no joint")
        if any(each.link not in seen for each in (*self.visuals, *self.hulls, *self.replaced)):
            raise ValueError("a surface is on no link")

    @cached_property
    def movable(self) -> tuple[SceneJoint, ...]:
        """Return the joints with a degree of freedom, those that follow others included."""
        return tuple(joint for joint in self.joints if joint.moves)

    def completed(self, values: Mapping[str, float]) -> dict[str, float]:
        """Return a value for every movable joint: as given, else by its leader, else 0."""
        by_name = {joint.name: joint for joint in self.movable}

        def value(joint: SceneJoint, depth: int = 0) -> float:
            if joint.name in values or joint.leader not in by_name or depth > len(by_name):
                return float(values.get(joint.name, 0.0))
            leader = value(by_name[joint.leader], depth + 1)
            return joint.multiplier * leader + joint.offset

        return {joint.name: value(joint) for joint in self.movable}

    def poses(self, values: Mapping[str, float]) -> FloatArray:
        """Link frames in the root's frame at joint values [rad] or [m], shape [links, 4, 4]."""
        all_values = self.completed(values)
        poses = np.tile(np.eye(4), (len(self.links), 1, 1))
        for joint in self.joints:
            motion = joint.motion(all_values.get(joint.name, 0.0))
            poses[joint.child] = poses[joint.parent] @ joint.origin @ motion
        return poses

    def opened(self, amount: float) -> dict[str, float]:
        """Return free joints' values, closed at 0 and open at 1; the first ones start earlier."""
        free = [joint for joint in self.movable if not joint.leader]
        found = {}
        for number, joint in enumerate(free):
            late = STAGGER * number / max(1, len(free) - 1)
            own = float(np.clip(amount * (1.0 + STAGGER) - late, 0.0, 1.0))
            eased = own * own * (3.0 - 2.0 * own)
            found[joint.name] = joint.lower + eased * (joint.upper - joint.lower)
        return found


def put_together(name: str, scenes: Mapping[str, tuple[SceneGraph, FloatArray]]) -> SceneGraph:
    """Return several objects as one, on a root link ``ground``; hulls are left out.

    Args:
        name: of the whole.
        scenes: each with the pose of its root, shape [4, 4], by a name that becomes the beginning
            of its links' and joints' names: ``robot/elbow``.
    """
    links = ["ground"]
    joints = []
    visuals: list[SceneSurface] = []
    for whose, (scene, pose) in scenes.items():
        first = len(links)
        axis = np.array([1.0, 0.0, 0.0])
        joints.append(SceneJoint(f"{whose}/", "fixed", 0, first, pose, axis))
        joints += [
            replace(
                joint,
                name=f"{whose}/{joint.name}",
                parent=joint.parent + first,
                child=joint.child + first,
                leader=joint.leader and f"{whose}/{joint.leader}",
            )
            for joint in scene.joints
        ]
        visuals += [replace(each, link=each.link + first) for each in scene.visuals or scene.hulls]
        links += [f"{whose}/{link}" for link in scene.links]
    return SceneGraph(name, tuple(links), tuple(joints), tuple(visuals))
