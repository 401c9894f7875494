"""What of an articulation can be seen: the parts that have faces, and how each of them moves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray, Mesh, read_only
from asset_factory.factory.models.particulate.prediction import MotionClass


@dataclass(frozen=True)
class Bodies:
    """The parts with faces; carriers without faces are merged into the part that they carry.

    Attributes:
        articulation: whose parts they are.
        parts: index of each body's part, ascending, shape [body_count].
        labels: body of each face, shape [face_count].
        parents: the next body towards the root of each, -1 where there is none.
        joints: movable joints between each body and that one, the root's side first.
    """

    articulation: Articulation
    parts: IntArray
    labels: IntArray
    parents: tuple[int, ...]
    joints: tuple[tuple[Joint, ...], ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", read_only(self.parts, np.int64))
        object.__setattr__(self, "labels", read_only(self.labels, np.int64))

    def __len__(self) -> int:
        return len(self.parts)

    @property
    def moving(self) -> BoolArray:
        """Return which bodies have a movable joint of their own, shape [body_count]."""
        return np.array([bool(own) for own in self.joints])

    @cached_property
    def mobile(self) -> BoolArray:
        """Return which bodies move, be it because what carries them moves, shape [body_count]."""
        carried = np.zeros(len(self.articulation.parts), dtype=bool)
        for joint in self.articulation.joints:
            carried[joint.child] = carried[joint.parent] or joint.movable
        return np.asarray(carried[self.parts])

    def kind(self, body: int) -> MotionClass:
        """Return how a body moves relative to the one that holds it."""
        return MotionClass(sum({1 if joint.turns else 2 for joint in self.joints[body]}))

    def joint(self, body: int, turns: bool) -> Joint | None:
        """Return the joint that turns, or slides, nearest to a body; ``None`` if it has none."""
        return next((each for each in reversed(self.joints[body]) if each.turns is turns), None)

    def own_motion(self, body: int, share: float) -> FloatArray:
        """Return a body's motion by its own joints, opened by a share of range, [4, 4]."""
        matrix = np.eye(4)
        for joint in self.joints[body]:
            matrix = matrix @ joint.motion(value_at(joint, share))
        return matrix

    def centres_at(self, share: float) -> FloatArray:
        """Return face centroids, joints opened by a share of their range [m], [face_count, 3]."""
        values = {joint.name: value_at(joint, share) for joint in self.articulation.movable_joints}
        poses = self.articulation.poses(values)[self.parts][self.labels]
        centres = face_centres(self.articulation.mesh)
        return np.asarray(np.einsum("nij,nj->ni", poses[:, :3, :3], centres) + poses[:, :3, 3])


def bodies_of(articulation: Articulation) -> Bodies:
    """Return the bodies of an articulation, root first, parents before children."""
    parts = [index for index, part in enumerate(articulation.parts) if len(part.faces)]
    chains = [_way_down(articulation, part) for part in parts]
    number = {part: body for body, part in enumerate(parts)}
    labels = np.searchsorted(parts, face_parts(articulation))
    parents = (
        -1 if above == part else number.get(above, -1)
        for part, (above, _) in zip(parts, chains, strict=True)
    )
    joints = tuple(own for _, own in chains)
    return Bodies(articulation, np.array(parts, np.int64), labels, tuple(parents), joints)


def face_centres(mesh: Mesh) -> FloatArray:
    """Return the centroid of every face [m], shape [face_count, 3]."""
    return np.asarray(mesh.vertices[mesh.faces].mean(axis=1))


def value_at(joint: Joint, share: float) -> float:
    """Return the joint value with a share of the range opened [rad] or [m].

    A joint without ends has no closed one: it starts where it is, and all its range is half a turn.
    """
    if joint.kind is JointKind.CONTINUOUS:
        return share * np.pi
    return joint.lower + share * joint.range


def _way_down(articulation: Articulation, part: int) -> tuple[int, tuple[Joint, ...]]:
    """Return the next part with faces towards the root, or the root, and movable joints to it."""
    found: list[Joint] = []
    while (joint := articulation.parent_joint(part)) is not None:
        if joint.movable:
            found.insert(0, joint)
        part = joint.parent
        if len(articulation.parts[part].faces):
            break
    return part, tuple(found)
