"""Labelled points and the joints that move them: what the published metrics compare."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.triangles import face_areas, points_within
from asset_factory.factory.mesh import FloatArray, IntArray, read_only

from ...bodies import bodies_of
from ...samples.sampled_object import carried

#: Points per object, as in the release; the paper speaks of ten times as many.
POINTS = 100_000


@dataclass(frozen=True)
class ScoredCloud:
    """Points of an object in a frame where its longest side is 1, at rest.

    Attributes:
        points: shape [point_count, 3].
        labels: part of each point, shape [point_count]; a part may have none.
        parents: parent of each part; -1 for roots.
        joints: of each part, its own, the root's side first; lower and upper need not hold 0.
    """

    points: FloatArray
    labels: IntArray
    parents: tuple[int, ...]
    joints: tuple[tuple[Joint, ...], ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", read_only(self.points))
        object.__setattr__(self, "labels", read_only(self.labels, np.int64))

    @cached_property
    def present(self) -> IntArray:
        """Return the parts that have points, ascending."""
        return np.unique(self.labels)

    def at(self, share: float) -> FloatArray:
        """Return the points with joints at a share from lower to upper, shape [point_count, 3]."""
        own = self.poses(share)[self.labels]
        return np.asarray(np.einsum("nij,nj->ni", own[:, :3, :3], self.points) + own[:, :3, 3])

    def parts(self, points: FloatArray) -> list[FloatArray]:
        """Split ``points`` by part, in the order of ``present``."""
        return [points[self.labels == part] for part in self.present]

    def poses(self, share: float, as_released: bool = False) -> FloatArray:
        """Return the motions of the parts relative to rest, shape [part_count, 4, 4].

        Joints are at this share of their range. ``as_released``, that counts from 0 instead of from
        the lower limit, and a part that turns and slides only turns.
        """
        own = np.tile(np.eye(4), (len(self.parents), 1, 1))
        for part, joints in enumerate(self.joints):
            turning = any(joint.turns for joint in joints)
            for joint in joints:
                if joint.turns or not (as_released and turning):
                    start = 0.0 if as_released else joint.lower
                    own[part] = own[part] @ joint.motion(start + share * joint.range)
        return carried(self.parents, own)


def cloud_of(articulation: Articulation, seed: int, count: int = POINTS) -> ScoredCloud:
    """Return points spread evenly over a surface; its box is centred, its longest side 1."""
    bodies = bodies_of(articulation)
    mesh = articulation.mesh
    size = float(mesh.extents.max())
    middle = mesh.bounds.mean(axis=0)
    rng = np.random.default_rng(seed)
    reach = np.cumsum(face_areas(mesh))
    faces = np.minimum(np.searchsorted(reach, rng.uniform(0.0, reach[-1], count)), len(reach) - 1)
    points = points_within(mesh.vertices[mesh.faces[faces]], *rng.uniform(size=(2, count)))
    return ScoredCloud(
        points=(points - middle) / size,
        labels=bodies.labels[faces],
        parents=bodies.parents,
        joints=tuple(tuple(_in_box(joint, size, middle) for joint in own) for own in bodies.joints),
    )


def _in_box(joint: Joint, size: float, middle: FloatArray) -> Joint:
    length = size if joint.kind is JointKind.PRISMATIC else 1.0
    moved = replace(joint, origin=(joint.origin - middle) / size)
    return replace(moved, lower=joint.lower / length, upper=joint.upper / length)
