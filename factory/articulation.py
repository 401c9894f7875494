"""Parts and joints as one kinematic tree, and where its links are for given joint values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property

import numpy as np
import numpy.typing as npt

from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.coupling import sound_chains, whole_chain

from .errors import InvalidArticulation
from .mesh import FloatArray, Mesh, freeze
from .part import Part

__all__ = [
    "NAME_CHARACTERS",
    "RESERVED_PART_NAME",
    "UNIT_TOLERANCE",
    "Articulation",
    "Joint",
    "JointKind",
    "Part",
    "Weights",
    "rotation_about",
]


class JointKind(StrEnum):
    """How a part moves relative to its parent."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"


@dataclass(frozen=True)
class Joint:
    """How ``child`` moves relative to ``parent``; value 0 is the pose of the input mesh.

    Attributes:
        name: unique within the articulation.
        kind: see :class:`JointKind`.
        parent, child: indices of parts.
        axis: unit direction in the object frame at rest, shape [3]. Positive values turn by the
            right-hand rule, or slide along it. Positive is opening.
        origin: a point on the axis, object frame at rest [m], shape [3]; also the child link's
            frame origin.
        lower, upper: limits [rad] or [m], ``lower <= 0 <= upper``; ``lower`` is closed. Zero for
            fixed joints; one turn, ``-pi`` to ``pi``, for continuous ones, which have no limits to
            hit.
        damping: [N m s/rad] or [N s/m]; ``None`` lets the exporter choose by kind and mass.
        friction: [N m] or [N]; ``None`` lets the exporter choose.
        confidence: that the child moves so, 0 to 1, as the articulator rates itself; ``None`` if it
            does not.
        mimic: the joint that it moves with, at a ratio above 0 and without an offset, so that both
            are closed and at rest together; ``None`` for one that moves by itself.
    """

    name: str
    kind: JointKind
    parent: int
    child: int
    axis: FloatArray
    origin: FloatArray
    lower: float = 0.0
    upper: float = 0.0
    damping: float | None = None
    friction: float | None = None
    confidence: float | None = None
    mimic: Mimic | None = None

    def __post_init__(self) -> None:
        freeze(self, "axis", "origin")
        object.__setattr__(self, "kind", JointKind(self.kind))
        object.__setattr__(self, "lower", float(self.lower))
        object.__setattr__(self, "upper", float(self.upper))

    @property
    def movable(self) -> bool:
        """Return whether the joint has a degree of freedom."""
        return self.kind is not JointKind.FIXED

    @property
    def turns(self) -> bool:
        """Return whether the joint's value is an angle."""
        return self.kind in (JointKind.REVOLUTE, JointKind.CONTINUOUS)

    @property
    def unit(self) -> str:
        """Return ``rad`` or ``m``."""
        return "rad" if self.turns else "m"

    @property
    def range(self) -> float:
        """Return ``upper - lower`` [rad] or [m]."""
        return self.upper - self.lower

    def motion(self, value: float) -> FloatArray:
        """Return the child's motion for a value [rad] or [m], object frame at rest, [4, 4]."""
        matrix = np.eye(4)
        if self.turns:
            rotation = rotation_about(self.axis, value)
            matrix[:3, :3] = rotation
            matrix[:3, 3] = self.origin - rotation @ self.origin
        elif self.kind is JointKind.PRISMATIC:
            matrix[:3, 3] = self.axis * value
        return matrix

    def velocity(self, points: FloatArray) -> FloatArray:
        """Return how points at rest first move per unit of opening, shape as ``points``, [..., 3].

        Zero for a point of the axis of what turns.
        """
        if self.turns:
            return np.asarray(np.cross(self.axis, points - self.origin))
        return np.broadcast_to(self.axis, points.shape)


def rotation_about(axis: npt.ArrayLike, angle: float) -> FloatArray:
    """Return the rotation for ``angle`` [rad] about a unit ``axis``, [3, 3] (Rodrigues)."""
    x, y, z = np.asarray(axis, dtype=np.float64)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross))


@dataclass(frozen=True)
class Weights:
    """The trained numbers that an articulation rests on.

    Attributes:
        file: name of the checkpoint (not its path).
        digest: SHA-256 of it.
        license: terms of use of them and of assets made with them; ``None``: unknown.
        outputs: the license that they put on whatever they help to make; ``None``: none.
    """

    file: str
    digest: str
    license: str | None
    outputs: str | None = None


@dataclass(frozen=True)
class Articulation:
    """One kinematic tree over one mesh. The constructor refuses anything else.

    Attributes:
        mesh: the whole object in its input pose, metres, z up.
        parts: root first, parents before children.
        joints: ``joints[i]`` holds ``parts[i + 1]``; its ``child`` is ``i + 1``.
        articulator: who said so, e.g. ``geometric``.
        notes: guesses and departures a person should know of, one sentence each.
        weights: of the trained networks that said so, if any did.
        looks_like: the category that the object was taken for; ``None``: for none.

    Raises:
        InvalidArticulation: names the part or joint, the fault and a remedy.
    """

    mesh: Mesh
    parts: tuple[Part, ...]
    joints: tuple[Joint, ...]
    articulator: str
    notes: tuple[str, ...] = field(default=())
    weights: tuple[Weights, ...] = field(default=())
    looks_like: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", tuple(self.weights))
        object.__setattr__(self, "parts", tuple(self.parts))
        object.__setattr__(self, "joints", tuple(self.joints))
        object.__setattr__(self, "notes", tuple(self.notes))
        _check_parts(self.parts, len(self.mesh.faces))
        _check_tree(self.parts, self.joints)
        for joint in self.joints:
            _check_joint(joint)
        _check_mimics(self.joints)

    @property
    def movable_joints(self) -> tuple[Joint, ...]:
        """Return the joints with a degree of freedom, in tree order."""
        return tuple(joint for joint in self.joints if joint.movable)

    def joint(self, name: str) -> Joint:
        """Return the joint of that name. Raises KeyError naming the ones there are."""
        for candidate in self.joints:
            if candidate.name == name:
                return candidate
        raise KeyError(f"no joint {name!r}; there are {[j.name for j in self.joints]}")

    def parent_joint(self, part: int) -> Joint | None:
        """Return the joint that holds part ``part``; ``None`` for the root."""
        return None if part == 0 else self.joints[part - 1]

    def carried(self, part: int) -> tuple[int, ...]:
        """Return ``part`` and all its descendants, in tree order."""
        found = {part}
        for joint in self.joints[part:]:
            if joint.parent in found:
                found.add(joint.child)
        return tuple(sorted(found))

    def link_frame(self, part: int) -> FloatArray:
        """Return a part's link origin at rest [m], shape [3]; its axes are the object frame's."""
        joint = self.parent_joint(part)
        return np.zeros(3) if joint is None else joint.origin

    def completed(self, values: Mapping[str, float]) -> dict[str, float]:
        """Return the value of every joint [rad] or [m].

        Args:
            values: by joint name; of those not named, followers go by their leaders, and all others
                are at 0, the input pose.

        Raises:
            KeyError: a name is not a joint's.
        """
        mimics = {joint.name: joint.mimic for joint in self.joints}
        unknown = set(values) - set(mimics)
        if unknown:
            raise KeyError(f"no joint {sorted(unknown)}; there are {list(mimics)}")

        def value(name: str) -> float:
            mimic = mimics[name]
            if name in values or mimic is None:
                return values.get(name, 0.0)
            return mimic.multiplier * value(mimic.leader)

        return {name: value(name) for name in mimics}

    def together(self, joint: Joint, value: float) -> dict[str, float]:
        """Return the values of a joint, and of all that move with it, where it is at ``value``."""
        own = self._chains.get(joint.name, Mimic(joint.name))
        at = value / own.multiplier
        led = {n: m.multiplier * at for n, m in self._chains.items() if m.leader == own.leader}
        return {own.leader: at, **led, joint.name: value}

    @cached_property
    def _chains(self) -> Mapping[str, Mimic]:
        """Return for each follower the free joint at the head of its chain, and its ratio to it."""
        mimics = sound_chains({joint.name: joint.mimic for joint in self.joints})
        return {name: whole_chain(name, mimics) for name in mimics}

    def part_mesh(self, part: int) -> Mesh:
        """Return the faces of one part, in the object frame at rest."""
        return self.mesh.submesh(self.parts[part].faces)

    def poses(self, values: dict[str, float] | None = None) -> FloatArray:
        """Return each part's motion relative to rest, object frame, shape [part_count, 4, 4].

        Args:
            values: as for :meth:`completed`.

        Raises:
            KeyError: a name is not a joint's.
        """
        given = self.completed(values or {})
        poses = np.tile(np.eye(4), (len(self.parts), 1, 1))
        for joint in self.joints:
            poses[joint.child] = poses[joint.parent] @ joint.motion(given.get(joint.name, 0.0))
        return poses


NAME_CHARACTERS = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.")
#: MuJoCo keeps this name for the ground.
RESERVED_PART_NAME = "world"
UNIT_TOLERANCE = 1e-6


def _check_names(what: str, names: Sequence[str]) -> None:
    for place, name in enumerate(names):
        if not name or not set(name) <= NAME_CHARACTERS:
            raise InvalidArticulation(
                f"{what} {name!r}: want a name of letters, digits, '_', '-' and '.'"
            )
        if name in names[:place]:
            raise InvalidArticulation(f"{what} {name!r}: appears twice, want unique names")


def _check_parts(parts: tuple[Part, ...], face_count: int) -> None:
    if not parts:
        raise InvalidArticulation("articulation: has no parts, want at least a root")
    _check_names("part", [part.name for part in parts])
    owner = np.full(face_count, -1)
    for index, part in enumerate(parts):
        if part.name == RESERVED_PART_NAME:
            raise InvalidArticulation(
                f"part {part.name!r}: MuJoCo keeps that name for the ground, want another"
            )
        if len(part.faces) and not 0 <= part.faces[0] <= part.faces[-1] < face_count:
            raise InvalidArticulation(f"part {part.name!r}: has a face outside 0..{face_count - 1}")
        taken = owner[part.faces]
        if (taken >= 0).any():
            other = parts[int(taken[taken >= 0][0])].name
            raise InvalidArticulation(
                f"part {part.name!r}: shares {int((taken >= 0).sum())} faces with {other!r}"
            )
        owner[part.faces] = index
    if (owner < 0).any():
        raise InvalidArticulation(
            f"articulation: {int((owner < 0).sum())} faces of the mesh belong to no part"
        )


def _check_tree(parts: tuple[Part, ...], joints: tuple[Joint, ...]) -> None:
    if len(joints) != len(parts) - 1:
        raise InvalidArticulation(
            f"articulation: {len(joints)} joints for {len(parts)} parts, want {len(parts) - 1}: "
            "one tree, one root"
        )
    _check_names("joint", [joint.name for joint in joints])
    for index, joint in enumerate(joints):
        if joint.child != index + 1:
            raise InvalidArticulation(
                f"joint {joint.name!r}: child is {joint.child}, want {index + 1} (tree order)"
            )
        if not 0 <= joint.parent < joint.child:
            raise InvalidArticulation(
                f"joint {joint.name!r}: parent is {joint.parent}, "
                f"want one of 0..{joint.child - 1} (parents first)"
            )


def _check_mimics(joints: tuple[Joint, ...]) -> None:
    sound = sound_chains({joint.name: joint.mimic for joint in joints if joint.movable})
    for joint in joints:
        mimic = joint.mimic
        if mimic is None:
            continue
        if joint.name not in sound or not mimic.multiplier > 0.0 or mimic.offset != 0.0:
            raise InvalidArticulation(
                f"joint {joint.name!r}: follows {mimic.leader!r} by {mimic.multiplier:g} times its "
                f"value plus {mimic.offset:g}; want a joint that moves, a ratio above 0, no offset"
            )


def _check_joint(joint: Joint) -> None:
    where = f"joint {joint.name!r}"
    for what, vector in (("axis", joint.axis), ("origin", joint.origin)):
        if vector.shape != (3,) or not np.isfinite(vector).all():
            raise InvalidArticulation(
                f"{where}: {what} must be three finite numbers, not {vector.tolist()}"
            )
    length = float(np.linalg.norm(joint.axis))
    if abs(length - 1.0) > UNIT_TOLERANCE:
        raise InvalidArticulation(f"{where}: axis must have length 1, not {length:.6g}")
    if not (np.isfinite(joint.lower) and np.isfinite(joint.upper)):
        raise InvalidArticulation(
            f"{where}: limits are [{joint.lower}, {joint.upper}], want finite ones"
        )
    if joint.kind is JointKind.FIXED:
        if joint.lower != 0.0 or joint.upper != 0.0:
            raise InvalidArticulation(
                f"{where}: is fixed with limits [{joint.lower}, {joint.upper}], want [0, 0]"
            )
        return
    if not joint.lower < joint.upper:
        raise InvalidArticulation(
            f"{where}: limits are [{joint.lower}, {joint.upper}], want lower < upper"
        )
    if not joint.lower <= 0.0 <= joint.upper:
        raise InvalidArticulation(
            f"{where}: limits [{joint.lower:.6g}, {joint.upper:.6g}] leave out 0, "
            "the pose of the input mesh"
        )
    for what, value in (("damping", joint.damping), ("friction", joint.friction)):
        if value is not None and not (np.isfinite(value) and value >= 0.0):
            raise InvalidArticulation(
                f"{where}: {what} must be a finite number of at least 0, not {value}"
            )
