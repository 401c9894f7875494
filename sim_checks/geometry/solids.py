"""A description's collision hulls, part by part, ready to be posed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from ..description import Description, FloatArray, JointLine
from .collision import Collider, LookBudget
from .coupling import leaders
from .depth import HullOverlap
from .hull import find_hull
from .kinematics import MOVING_KINDS, Poser, Tree
from .path import Path, joint_axis
from .placing import boxes_near, diagonal

#: Indices of two solids.
HullPair = tuple[int, int]


@dataclass(frozen=True)
class LinkSolid:
    """One collision hull.

    Attributes:
        link: the link whose it is.
        shape: its shape's name.
        part: index of the part, see :class:`Tree`.
        collider: the hull, in the link's frame.
    """

    link: str
    shape: str
    part: int
    collider: Collider


@dataclass(frozen=True)
class SolidGroup:
    """Solids that move as one when a joint moves.

    Attributes:
        solids: their indices, ascending.
        parts: the parts that they are of.
        ways: the joints above them that move, from the root on, and how far each goes when the one
            that leads goes by one; none for fixed links.
    """

    solids: tuple[int, ...]
    parts: tuple[int, ...]
    ways: tuple[tuple[JointLine, float], ...]


class Solids:
    """All hulls of a description, without shapes of no volume: they are a finding of their own.

    Attributes:
        description: whose they are.
        tree: the joints.
        looks: exact looks at two hulls, that those who ask count, too.
    """

    def __init__(self, description: Description, tree: Tree, looks: LookBudget) -> None:
        self.description = description
        self.tree = tree
        self.looks = looks
        part_of = tree.part_of()
        self.items: list[LinkSolid] = []
        for link in description.links:
            part = part_of[link.name]
            for shape in link.collisions:
                hull = find_hull(shape.vertices)
                if hull is not None:
                    self.items.append(LinkSolid(link.name, shape.name, part, Collider(hull)))
        self._poser = Poser(tree)
        self._steps = _steps(tree, part_of)
        self._groups: dict[str, tuple[SolidGroup, ...]] = {}
        self.parts = np.array([item.part for item in self.items], dtype=np.int64)

    def place(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Pose every solid for the joint values; returns the link poses."""
        poses = self._poser.link_poses(values)
        for item in self.items:
            item.collider.place(poses[item.link])
        return poses

    def counting(self, looks: LookBudget) -> Solids:
        """Return the same solids, of which other looks are counted."""
        same = copy(self)
        same.looks = looks
        return same

    def bounds(self) -> FloatArray:
        """Return the boxes around the solids as placed [m], shape [solid_count, 2, 3]."""
        return np.array([item.collider.bounds for item in self.items]).reshape(-1, 2, 3)

    def diagonal(self) -> float:
        """Return the diagonal of the box around everything as placed [m]."""
        return diagonal(item.collider.bounds for item in self.items)

    def points(self, indices: Iterable[int]) -> FloatArray:
        """Return the corners of some solids as placed [m], shape [corner_count, 3]."""
        corners = (self.items[index].collider.hull.vertices for index in indices)
        return np.vstack([np.zeros((0, 3)), *corners])

    def standings(self, floor: float) -> dict[HullPair, HullOverlap]:
        """Return how solids of different parts stand that are closer than ``floor`` [m].

        They come by their indices, ascending and in order; each overlap points from the first to
        the second.

        Raises:
            TooManyLooks: the file has taken more than it may.
        """
        boxes = self.bounds()
        strangers = np.triu(self.parts[:, None] != self.parts[None, :], 1)
        found = {}
        for first, second in np.argwhere(strangers & boxes_near(boxes, boxes, floor)).tolist():
            self.looks.take()
            overlap = self.items[first].collider.stand(self.items[second].collider)
            if overlap.depth > -floor:
                found[first, second] = overlap
        return found

    def groups(self, joint: JointLine) -> tuple[SolidGroup, ...]:
        """Return the solids grouped by how they move with ``joint`` and its followers.

        Those that stand come first.
        """
        if joint.name not in self._groups:
            self._groups[joint.name] = self._grouped(joint)
        return self._groups[joint.name]

    def _grouped(self, joint: JointLine) -> tuple[SolidGroup, ...]:
        led = (joint, *self.tree.followers(joint))
        names = {other.name for other in led if self._rate(joint, other) != 0.0}
        ways: list[tuple[JointLine, ...]] = [() for _ in self.tree.parts]
        for part, parent, above in self._steps:
            ways[part] = (*ways[parent], above) if above.name in names else ways[parent]
        by_way: dict[tuple[str, ...], list[int]] = {}
        for part, way in enumerate(ways):
            by_way.setdefault(tuple(other.name for other in way), []).append(part)
        groups = []
        for _, parts in sorted(by_way.items(), key=lambda entry: (len(entry[0]) > 0, entry[1])):
            member = np.zeros(len(self.tree.parts), dtype=bool)
            member[parts] = True
            rates = tuple((other, self._rate(joint, other)) for other in ways[parts[0]])
            solids = tuple(np.flatnonzero(member[self.parts]).tolist())
            groups.append(SolidGroup(solids, tuple(parts), rates))
        return tuple(groups)

    def moved_parts(self, joint: JointLine) -> frozenset[int]:
        """Return the parts that a joint moves, itself or by its followers."""
        moving = (group for group in self.groups(joint) if group.ways)
        return frozenset(part for group in moving for part in group.parts)

    def seen(
        self,
        moving: SolidGroup,
        standing: SolidGroup,
        poses: Mapping[str, FloatArray],
        length: float,
    ) -> Path:
        """Return how one group moves as seen from another, from the posed values on.

        Links said to be fixed keep their place at the start; :meth:`way` says where they go.
        """
        names = [[joint.name for joint, _ in group.ways] for group in (moving, standing)]
        shared = 0
        while names[0][: shared + 1] == names[1][: shared + 1] and shared < len(names[0]):
            shared += 1
        back = [(joint, -rate) for joint, rate in reversed(standing.ways[shared:])]
        return _path([*back, *moving.ways[shared:]], poses, length)

    def way(self, group: SolidGroup, poses: Mapping[str, FloatArray], length: float) -> Path:
        """Return how a group moves in the world, from the posed values on."""
        return _path(group.ways, poses, length)

    def between(self, first: int, second: int) -> frozenset[str]:
        """Return the names of the free joints that move two parts against one another."""
        here, there = (self._above(part) for part in (first, second))
        return frozenset((name, *leaders(name, self.tree.mimics))[-1] for name in here ^ there)

    def _above(self, part: int) -> set[str]:
        """Return the names of the moving joints above a part."""
        found = set()
        for below, parent, joint in reversed(self._steps):
            if below == part:
                found.add(joint.name)
                part = parent
        return found

    def _rate(self, joint: JointLine, other: JointLine) -> float:
        start, end = (self.tree.value_of(other.name, {joint.name: value}) for value in (0.0, 1.0))
        return end - start


def _path(
    ways: Sequence[tuple[JointLine, float]], poses: Mapping[str, FloatArray], length: float
) -> Path:
    return Path(tuple((joint_axis(j, poses[j.child]), rate) for j, rate in ways), length)


def _steps(tree: Tree, part_of: Mapping[str, int]) -> tuple[tuple[int, int, JointLine], ...]:
    """Yield every part but the root's, its parent part and the joint between; parents first."""
    moving = (joint for joint in tree.order if joint.kind in MOVING_KINDS)
    return tuple((part_of[joint.child], part_of[joint.parent], joint) for joint in moving)
