"""How an object is made differently from the plain way, because a repair asks for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind
from ..geometry.welding import welded
from .solids.plates import plates

Pair = tuple[str, str]


@dataclass(frozen=True)
class Plan:
    """How the next round is made differently from the plain one.

    Attributes:
        separate: pairs of part names whose hulls are cut apart, where the meshes themselves allow
            it.
        exclude: pairs that MuJoCo is told not to collide: the knuckles of hinges, which other
            engines ignore.
        upper: joint name -> shortened upper limit [rad] or [m].
        frozen: dispensable joints that cannot move, made fixed.
        build_fronts: thin fronts are built anew, with the body around them, as bare ones are.
        given_up: guessed joints whose parts cannot be parts of their own, made one with what they
            hang on.
        fewer: the asset has too many hulls: they are joined, further off the surfaces.
        steps: what was decided, one sentence each, oldest first.
    """

    separate: frozenset[Pair] = frozenset()
    exclude: frozenset[Pair] = frozenset()
    upper: Mapping[str, float] = field(default_factory=dict)
    frozen: frozenset[str] = frozenset()
    given_up: frozenset[str] = frozenset()
    build_fronts: bool = False
    fewer: bool = False
    steps: tuple[str, ...] = ()


@dataclass(frozen=True)
class Spare:
    """What the object is still worth having without.

    Attributes:
        joints: that may be frozen.
        guesses: part -> its joint, where both are guesses and there is a surer one; the least sure
            first.
        fronts: parts that are thin fronts and that could be built anew.
    """

    joints: frozenset[str] = frozenset()
    guesses: Mapping[str, str] = field(default_factory=dict)
    fronts: frozenset[str] = frozenset()


def as_planned(articulation: Articulation, plan: Plan) -> Articulation:
    """The same tree with the joints that a plan shortens or freezes."""
    articulation = welded(articulation, plan.given_up) if plan.given_up else articulation

    def changed(joint: Joint) -> Joint:
        if joint.name in plan.frozen:
            return replace(joint, kind=JointKind.FIXED, lower=0.0, upper=0.0)
        return replace(joint, upper=plan.upper[joint.name]) if joint.name in plan.upper else joint

    return replace(articulation, joints=tuple(changed(joint) for joint in articulation.joints))


def dispensable_joints(articulation: Articulation, share: float) -> Spare:
    """Joints without which the object is still worth having, should they turn out to be wrong.

    Small ones; and of joints that were guessed all but the surest: a guess that is blocked is a
    wrong guess. Never all that there are.

    Args:
        articulation: parts and joints.
        share: largest diagonal of everything a small joint moves, over the object's.
    """
    rated = [joint for joint in articulation.movable_joints if joint.confidence is not None]
    surest = max(rated, key=lambda joint: joint.confidence or 0.0, default=None)
    guessed = sorted(
        (joint for joint in rated if joint is not surest), key=lambda joint: joint.confidence or 0.0
    )
    small = _small_joints(articulation, share) - ({surest.name} if surest else set())
    return Spare(
        joints=small | {joint.name for joint in guessed},
        guesses={articulation.parts[joint.child].name: joint.name for joint in guessed},
        fronts=frozenset(articulation.parts[part].name for part in plates(articulation)),
    )


def _small_joints(articulation: Articulation, share: float) -> frozenset[str]:
    moved: list[set[int]] = [{part} for part in range(len(articulation.parts))]
    for joint in reversed(articulation.joints):
        moved[joint.parent] |= moved[joint.child]
    small = set()
    for joint in articulation.movable_joints:
        faces = np.concatenate(
            [articulation.parts[part].faces for part in sorted(moved[joint.child])]
        )
        if (
            len(faces)
            and articulation.mesh.submesh(faces).diagonal <= share * articulation.mesh.diagonal
        ):
            small.add(joint.name)
    return frozenset(small) if len(small) < len(articulation.movable_joints) else frozenset()
