"""How an object is made differently from the plain way, because a repair asks for it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ..articulate.locate import located
from ..articulation import Articulation, Joint, JointKind
from ..geometry.coupling import with_common_ranges
from ..geometry.welding import welded
from ..mesh import FloatArray
from ..part import PartKind
from .hinges import at_front_edge
from .repair import Pair, Repair, RepairKind
from .separate.budget import SeenSurface
from .solids.skin import plates

#: Thin fronts of meshes of more faces are built at once: carved mouldings take minutes to search.
MANY_FACES = 20_000
#: What is no further off than this share of the object's diagonal is lain on.
NEAR_SHARE = 0.03


@dataclass(frozen=True)
class Plan:
    """How the next round is made differently from the plain one.

    Attributes:
        separate: pairs of part names whose hulls are cut apart, where the meshes themselves allow
            it.
        exclude: pairs that MuJoCo is told not to collide: the knuckles of hinges, which other
            engines ignore.
        upper, lower: joint name -> limit that was pulled in [rad] or [m].
        mended: joint name -> the joint that it should have been: with another axis, elsewhere, or
            with limits where it had none.
        frozen: dispensable joints that cannot move, made fixed.
        build_fronts: thin fronts are built anew, with the body around them, as bare ones are.
        rehung: guessed hinges that are at the front edges of their doors now.
        given_up: guessed joints whose parts cannot be parts of their own, made one with what they
            lie on.
        hollow: parts whose open surfaces are never closed or filled, whatever stands in them.
        closely: hulls stay as close to the surfaces as they were decomposed, as long as they are
            no more than one part may have.
        fewer: the asset has too many hulls: they are joined, further off the surfaces, until so
            few are left.
        repairs: the changes, oldest first.
    """

    separate: frozenset[Pair] = frozenset()
    exclude: frozenset[Pair] = frozenset()
    upper: Mapping[str, float] = field(default_factory=dict)
    lower: Mapping[str, float] = field(default_factory=dict)
    mended: Mapping[str, Joint] = field(default_factory=dict)
    frozen: frozenset[str] = frozenset()
    given_up: frozenset[str] = frozenset()
    build_fronts: bool = False
    hollow: frozenset[str] = frozenset()
    closely: bool = False
    fewer: int | None = None
    rehung: frozenset[str] = frozenset()
    repairs: tuple[Repair, ...] = ()

    def repaired(self, *repairs: Repair, **changes: Any) -> Plan:
        """Return the plan with other fields, and the repairs that changed them."""
        return replace(self, **changes, repairs=(*self.repairs, *repairs))


@dataclass(frozen=True)
class Spare:
    """What the object is still worth having without.

    Attributes:
        joints: that may be frozen.
        guesses: part -> its joint, where both are guesses and there is a better one; the least
            valuable first, by probability times the share of the object's diagonal it moves.
        fronts: parts that are thin fronts and that could be built anew.
        hinges: guessed ones that could be at the front edges of their doors.
    """

    joints: frozenset[str] = frozenset()
    guesses: Mapping[str, str] = field(default_factory=dict)
    fronts: frozenset[str] = frozenset()
    hinges: frozenset[str] = frozenset()


def first_plan(articulation: Articulation, spare: Spare) -> Plan:
    """Return how an object is made before anything is known of it."""
    faces = len(articulation.mesh.faces)
    if not spare.fronts or faces <= MANY_FACES:
        return Plan()
    fronts = tuple(sorted(spare.fronts))
    built = Repair(RepairKind.FRONTS_BUILT_AT_ONCE, parts=fronts, before=faces, unit="faces")
    return Plan(build_fronts=True, repairs=(built,))


def as_planned(articulation: Articulation, plan: Plan) -> Articulation:
    """Return the same tree with the joints that a plan rehangs, mends, shortens or freezes."""
    if plan.given_up:
        onto = lying_on(articulation, plan.given_up)
        articulation = welded(articulation, plan.given_up, onto)

    def changed(joint: Joint) -> Joint:
        if joint.name in plan.rehung:
            joint = at_front_edge(articulation, joint) or joint
        if joint.name in plan.frozen:
            return replace(joint, kind=JointKind.FIXED, lower=0.0, upper=0.0)
        if joint.name in plan.mended:
            mended = plan.mended[joint.name]
            joint = replace(joint, axis=mended.axis, origin=mended.origin)
            if mended.kind is not joint.kind:
                joint = replace(joint, kind=mended.kind, lower=mended.lower, upper=mended.upper)
        return replace(
            joint,
            lower=plan.lower.get(joint.name, joint.lower),
            upper=plan.upper.get(joint.name, joint.upper),
        )

    joints = with_common_ranges([changed(joint) for joint in articulation.joints])
    return _relocated(articulation, replace(articulation, joints=joints))


def lying_on(articulation: Articulation, joints: Collection[str]) -> dict[str, int]:
    """Return by joint the part that most of its own part's surface lies near, if any.

    Parts that carry others are left out, and none lies on a part that these joints move.
    """
    leaving = {joint.child for joint in articulation.joints if joint.name in joints}
    carriers = {joint.parent for joint in articulation.joints}
    shown = {
        index: SeenSurface.of(articulation.part_mesh(index)).points
        for index, part in enumerate(articulation.parts)
        if len(part.faces)
    }
    others = {index: points for index, points in shown.items() if index not in leaving}
    near = NEAR_SHARE * articulation.mesh.diagonal
    found = {}
    for joint in articulation.joints:
        if joint.name in joints and joint.child in shown and joint.child not in carriers:
            nearest = _nearest(shown[joint.child], others, near)
            if nearest is not None:
                found[joint.name] = nearest
    return found


def _nearest(points: FloatArray, others: dict[int, FloatArray], near: float) -> int | None:
    """Return which of some parts is the nearest of most points [m], shape [n, 3]."""
    if not others:
        return None
    distances = np.array([cKDTree(other).query(points)[0] for other in others.values()])
    touching = distances.min(axis=0) < near
    if not touching.any():
        return None
    counts = np.bincount(distances.argmin(axis=0)[touching], minlength=len(others))
    return list(others)[int(counts.argmax())]


def _relocated(before: Articulation, made: Articulation) -> Articulation:
    """Return the tree as made; parts that were given limits say anew what they are: no knobs."""
    ended = {
        joint.child
        for was, joint in zip(before.joints, made.joints, strict=True)
        if was.kind is JointKind.CONTINUOUS and joint.kind is JointKind.REVOLUTE
    }
    if not ended:
        return made
    parts = tuple(
        replace(part, kind=PartKind.PART) if index in ended else part
        for index, part in enumerate(made.parts)
    )
    return located(replace(made, parts=parts))


def dispensable_joints(articulation: Articulation, share: float) -> Spare:
    """Find joints without which the object is still worth having, should they be wrong.

    Small ones, which move no more than a ``share`` of the object's diagonal; and of joints that
    were guessed all but the best: a guess that is blocked is a wrong guess. Never all that there
    are.
    """
    moved = _moved_shares(articulation)
    rated = [joint for joint in articulation.movable_joints if joint.confidence is not None]
    rated.sort(key=lambda joint: (joint.confidence or 0.0) * moved[joint.name])
    guessed = rated[:-1]
    small = {name for name, size in moved.items() if 0.0 < size <= share}
    small = small - {joint.name for joint in rated[-1:]} if len(small) < len(moved) else set()
    return Spare(
        joints=frozenset(small | {joint.name for joint in guessed}),
        guesses={articulation.parts[joint.child].name: joint.name for joint in guessed},
        fronts=frozenset(articulation.parts[part].name for part in plates(articulation)),
        hinges=frozenset(joint.name for joint in rated if at_front_edge(articulation, joint)),
    )


def _moved_shares(articulation: Articulation) -> dict[str, float]:
    """Return the diagonal of all that each joint moves over the object's; 0 of empty carriers."""
    shares = {}
    for joint in articulation.movable_joints:
        parts = articulation.carried(joint.child)
        faces = np.concatenate([articulation.parts[part].faces for part in parts])
        size = articulation.mesh.submesh(faces).diagonal if len(faces) else 0.0
        shares[joint.name] = size / articulation.mesh.diagonal
    return shares
