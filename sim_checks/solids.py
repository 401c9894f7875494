"""A description's collision hulls, part by part, ready to be posed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from .collision import Collider
from .depth import Overlap
from .description import Description, FloatArray, JointLine
from .hull import FlatHull, convex_hull
from .kinematics import Tree, unit_axis
from .path import Path


@dataclass(frozen=True)
class Solid:
    """One collision hull.

    Attributes:
        link: the link whose it is.
        shape: its shape's name.
        part: index of the part, see :class:`Tree`.
        in_part: the link's frame in the part's frame, shape [4, 4].
        collider: the hull, in the link's frame.
    """

    link: str
    shape: str
    part: int
    in_part: FloatArray
    collider: Collider


@dataclass(frozen=True)
class Standing:
    """How two solids stand in some pose; ``overlap`` points from the first to the second."""

    first: int
    second: int
    overlap: Overlap


class Solids:
    """All hulls of a description. Shapes without volume are left out: they are a finding of their own."""

    def __init__(self, description: Description, tree: Tree) -> None:
        self.tree = tree
        part_of = tree.part_of()
        at_zero = tree.link_poses({})
        self.items: list[Solid] = []
        for link in description.links:
            part = part_of[link.name]
            in_part = np.linalg.inv(at_zero[tree.parts[part][0]]) @ at_zero[link.name]
            for shape in link.collisions:
                try:
                    hull = convex_hull(shape.vertices)
                except FlatHull:
                    continue
                self.items.append(Solid(link.name, shape.name, part, in_part, Collider(hull)))
        self._values: Mapping[str, float] | None = None
        self._poses: dict[str, FloatArray] = {}
        self.parts = np.array([item.part for item in self.items], dtype=np.int64)

    def place(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Pose every solid for the joint values; returns the link poses."""
        if values != self._values:
            self._values, self._poses = dict(values), self.tree.link_poses(values)
        for item in self.items:
            item.collider.place(self._poses[item.link])
        return self._poses

    def bounds(self) -> FloatArray:
        """Boxes around the solids as placed [m], shape [solid_count, 2, 3]."""
        return np.array([item.collider.bounds for item in self.items]).reshape(-1, 2, 3)

    def diagonal(self) -> float:
        """Diagonal of the box around everything as placed [m]."""
        boxes = self.bounds()
        return float(np.linalg.norm(boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0))) if len(boxes) else 0.0

    def standings(self, floor: float) -> Iterator[Standing]:
        """Every pair of solids of different parts that stand closer than ``floor`` [m], in a fixed order."""
        boxes = self.bounds()
        if len(boxes) == 0:
            return
        close = np.triu(self.parts[:, None] != self.parts[None, :], 1)
        for low, high in zip(boxes[:, 0].T, boxes[:, 1].T, strict=True):
            reaches = low[:, None] - high[None, :] < floor
            close &= reaches & reaches.T
        for first, second in np.argwhere(close).tolist():
            overlap = self.items[first].collider.stand(self.items[second].collider)
            if overlap.depth > -floor:
                yield Standing(first, second, overlap)

    def path(self, joint: JointLine, poses: Mapping[str, FloatArray], length: float) -> Path:
        """The way the joint moves what hangs below it, from the posed value on."""
        frame = poses[joint.child]
        # The axis is the same line in the child's frame at every value.
        axis = frame[:3, :3] @ unit_axis(joint)
        return Path(joint.kind != "prismatic", frame[:3, 3], axis, length)
