"""Where every link is for given joint values: the checks' own forward kinematics."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..description import Description, FloatArray, JointLine, Mimic, sensible
from .coupling import Limits, common_ranges, leaders, sound_chains
from .placing import rigid

MOVING_KINDS = ("revolute", "continuous", "prismatic")


class NotATree(ValueError):
    """The joints do not hang every link, once, below one root."""


@dataclass(frozen=True)
class Tree:
    """The joints in an order that visits parents first.

    Attributes:
        root: the one link that is no joint's child.
        order: all joints, parents first.
        moving: those of ``order`` that move, in file order.
        parts: links that no moving joint separates, as tuples of link names in file order; the
            root's part first.
        mimics: follower -> what it follows, both joints that move; one that names no such joint, or
            that leads back to itself, is left out and so moves freely (the lint says it).
    """

    root: str
    order: tuple[JointLine, ...]
    moving: tuple[JointLine, ...]
    parts: tuple[tuple[str, ...], ...]
    mimics: Mapping[str, Mimic] = field(default_factory=dict)

    @property
    def free(self) -> tuple[JointLine, ...]:
        """Return the joints of ``moving`` that follow no other: the independent variables."""
        return tuple(joint for joint in self.moving if joint.name not in self.mimics)

    def followers(self, joint: JointLine) -> tuple[JointLine, ...]:
        """Return the joints that follow ``joint``, directly or through others; file order."""
        led = {name for name in self.mimics if joint.name in leaders(name, self.mimics)}
        return tuple(other for other in self.moving if other.name in led)

    @cached_property
    def ranges(self) -> Mapping[str, Limits]:
        """Return :func:`sweep_range` of every free joint that has one, by name; file order.

        It is shortened to where followers stay within their own limits, and left out where nothing
        is left.
        """
        return swept_ranges(self.moving, self.mimics)

    @cached_property
    def closed(self) -> Mapping[str, float]:
        """Return every joint of :attr:`ranges` at lower [rad] or [m]."""
        return {name: lower for name, (lower, _) in self.ranges.items()}

    @cached_property
    def opened(self) -> Mapping[str, float]:
        """Return every joint of :attr:`ranges` at upper [rad] or [m]."""
        return {name: upper for name, (_, upper) in self.ranges.items()}

    def value_of(self, name: str, values: Mapping[str, float]) -> float:
        """Return where a joint is [rad] or [m].

        Its own entry in ``values`` always counts, follower or not. Without one, a follower goes by
        where its leader is, and any other joint is at 0.
        """
        if name in values or name not in self.mimics:
            return values.get(name, 0.0)
        mimic = self.mimics[name]
        return mimic.multiplier * self.value_of(mimic.leader, values) + mimic.offset

    def completed(self, values: Mapping[str, float]) -> dict[str, float]:
        """Return values for every moving joint, followers included; file order."""
        return {joint.name: self.value_of(joint.name, values) for joint in self.moving}

    def link_poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Link frames in the root's frame, each of shape [4, 4].

        Args:
            values: joint name -> value [rad] or [m]. Of the joints left out, followers go by their
                leaders and the others are at 0; a follower's own value, where given, counts
                instead.
        """
        return Poser(self).link_poses(values)

    def below(self, joint: JointLine) -> frozenset[str]:
        """Return the names of the links that move with ``joint``."""
        found = {joint.child}
        for other in self.order:
            if other.parent in found:
                found.add(other.child)
        return frozenset(found)

    def part_of(self) -> dict[str, int]:
        """Link name -> index into ``parts``."""
        return {link: index for index, part in enumerate(self.parts) for link in part}


class Poser:
    """A tree posed again and again: only links that a changed joint moves are posed anew.

    The poses of all others are the same arrays as before.
    """

    def __init__(self, tree: Tree) -> None:
        self._tree = tree
        self._poses: dict[str, FloatArray] = {tree.root: np.eye(4)}
        self._motions: dict[str, tuple[float, FloatArray]] = {}

    def link_poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Return what :meth:`Tree.link_poses` says of the same values, to the last digit."""
        poses = dict(self._poses)
        moved: set[str] = set()
        for joint in self._tree.order:
            value = self._tree.value_of(joint.name, values)
            before = self._motions.get(joint.child)
            if before is None or before[0] != value:
                before = value, joint_motion(joint, value)
                self._motions[joint.child] = before
            elif joint.parent not in moved:
                continue
            poses[joint.child] = poses[joint.parent] @ joint.origin @ before[1]
            moved.add(joint.child)
        self._poses = poses
        return dict(poses)


def build_tree(description: Description) -> Tree:
    """Hang every link below one root.

    Raises:
        NotATree: with the links at fault.
    """
    names = [link.name for link in description.links]
    ends = {end for joint in description.joints for end in (joint.parent, joint.child)}
    if strangers := sorted(ends - set(names)):
        raise NotATree(f"joints name links that are not there: {_listed(strangers)}")
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise NotATree(f"{len(twice)} link names are used twice ({_listed(twice)})")
    holders: dict[str, JointLine] = {}
    for joint in description.joints:
        other = holders.setdefault(joint.child, joint)
        if other is not joint:
            both = f"joints {other.name!r} and {joint.name!r}"
            raise NotATree(f"link {joint.child!r} is the child of {both}, want one")
    roots = [name for name in names if name not in holders]
    if len(roots) != 1:
        raise NotATree(f"{len(roots)} root links ({_listed(roots)}), want 1")
    order = _parents_first(roots[0], description.joints)
    reached = {joint.child for joint in order}
    if loop := [joint.name for joint in description.joints if joint.child not in reached]:
        raise NotATree(f"joints {_listed(loop)} form a loop apart from root {roots[0]!r}")
    moving = tuple(joint for joint in description.joints if joint.kind in MOVING_KINDS)
    return Tree(roots[0], order, moving, _parts(names, roots[0], order), sound_mimics(description))


def find_tree(description: Description) -> Tree | None:
    """Return the tree of a description; ``None`` where its links form none, as the lint says."""
    with suppress(NotATree):
        return build_tree(description)
    return None


def sound_mimics(description: Description) -> dict[str, Mimic]:
    """Return follower -> mimic, where the chain of leaders ends at a joint that moves by itself.

    One by a number that is none, or absurdly large, leads nowhere.
    """
    moving = {joint.name: joint.mimic for joint in description.joints if joint.kind in MOVING_KINDS}
    return sound_chains(moving)


def _listed(names: list[str]) -> str:
    return ", ".join(map(repr, names[:5]))


def _parents_first(root: str, joints: tuple[JointLine, ...]) -> tuple[JointLine, ...]:
    by_parent: dict[str, list[JointLine]] = {}
    for joint in joints:
        by_parent.setdefault(joint.parent, []).append(joint)
    order = list(by_parent.get(root, ()))
    for joint in order:
        order += by_parent.get(joint.child, ())
    return tuple(order)


def _parts(
    names: list[str], root: str, order: tuple[JointLine, ...]
) -> tuple[tuple[str, ...], ...]:
    head = {root: root}
    for joint in order:
        head[joint.child] = joint.child if joint.kind in MOVING_KINDS else head[joint.parent]
    parts: dict[str, list[str]] = {name: [] for name in (root, *names) if head[name] == name}
    for name in names:
        parts[head[name]].append(name)
    return tuple(tuple(part) for part in parts.values())


def joint_motion(joint: JointLine, value: float) -> FloatArray:
    """Return what the joint adds to its origin at ``value`` [rad] or [m]; shape [4, 4]."""
    axis = unit_axis(joint)
    if joint.kind == "prismatic":
        return rigid(np.eye(3), value * axis)
    if joint.kind in MOVING_KINDS:
        return rigid(rotation_about(axis, value), np.zeros(3))
    return np.eye(4)


def unit_axis(joint: JointLine) -> FloatArray:
    """Return the joint's axis at length 1; x where it is zero, as loaders take it."""
    length = float(np.linalg.norm(joint.axis))
    return joint.axis / length if length > 1e-12 else np.array([1.0, 0.0, 0.0])


def rotation_about(axis: FloatArray, angle: float) -> FloatArray:
    """Return the rotation by ``angle`` [rad] about a unit axis; shape [3, 3]."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(angle * axis).as_matrix()


def own_limits(joint: JointLine) -> Limits | None:
    """Return a follower's own limits [rad] or [m]; ``None`` where none, or none sensible, exist."""
    if joint.kind == "continuous" or joint.lower is None or joint.upper is None:
        return None
    limits = joint.lower, joint.upper
    return limits if sensible(limits) and limits[0] < limits[1] else None


def swept_ranges(moving: Iterable[JointLine], mimics: Mapping[str, Mimic]) -> dict[str, Limits]:
    """Return what :attr:`Tree.ranges` does, of joints that move and how some follow others."""
    own = ((j.name, own_limits(j) if j.name in mimics else sweep_range(j)) for j in moving)
    return common_ranges(dict(own), mimics)


def sweep_range(joint: JointLine) -> Limits | None:
    """Return the range over which a joint is swept; a hinge without limits makes one turn.

    ``None`` where there is nothing to sweep: a slide without limits, or limits that are not finite,
    absurdly far apart or not ordered.
    """
    if joint.lower is None or joint.upper is None:
        return None if joint.kind == "prismatic" else (0.0, 2.0 * np.pi)
    if not (sensible((joint.lower, joint.upper)) and joint.lower < joint.upper):
        return None
    if joint.kind != "prismatic" and joint.upper - joint.lower > 2.0 * np.pi:
        return joint.lower, joint.lower + 2.0 * np.pi
    return joint.lower, joint.upper
