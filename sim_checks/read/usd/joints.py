"""Physics joints of a USD stage: frames on both bodies, axis and limits, in SI units."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...description import DescriptionError, FloatArray, Mimic
from .bodies import WORLD, PhysicsBody, rotation_of, split_scale

#: The relationship by which a PhysX joint names its leader, of the axis that it is about.
PHYSX_MIMIC = re.compile(r"physxMimicJoint:\w+:referenceJoint")
#: Directions that joints' axes are named by.
AXES = dict(zip("XYZ", np.eye(3), strict=True))
PoseOf = Callable[[Any], FloatArray]


@dataclass(frozen=True)
class PhysicsJoint:
    """A joint as written.

    Attributes:
        name: of its prim.
        kind: ``revolute``, ``prismatic``, ``fixed``, or the file's word for anything else.
        bodies: paths of what it holds, first ``body0``.
        frames: of the joint in each body's own frame [m], shape [4, 4] each.
        axis: in the joint's frame, shape [3].
        lower, upper: [rad] or [m]; ``None`` where there is no limit.
        damping: [N m s/rad] or [N s/m].
        friction: [N m] or [N], where Newton's attribute states it.
        placed: whether the file states its frame on ``body1``.
        mimic: the joint that it follows, by its prim's name, by Newton's or PhysX's attributes.
    """

    name: str
    kind: str
    bodies: tuple[str, str]
    frames: tuple[FloatArray, FloatArray]
    axis: FloatArray = field(default_factory=lambda: AXES["X"])
    lower: float | None = None
    upper: float | None = None
    damping: float = 0.0
    friction: float = 0.0
    placed: bool = False
    mimic: Mimic | None = None


def require_ends(prim: Any) -> None:
    """Refuse a joint that names a body which no prim is; one that names none holds the world.

    Raises:
        DescriptionError: ``missing_element``.
    """
    for relation in joint_ends(prim):
        for target in relation.GetForwardedTargets():
            if not prim.GetStage().GetPrimAtPath(target):
                which = relation.GetName().removeprefix("physics:")
                message = f"joint {prim.GetName()!r}: its {which} names {target}, which is no prim"
                raise DescriptionError("missing_element", message)


def joint_ends(prim: Any) -> tuple[Any, Any]:
    """Return the relationships by which a joint names its ``body0`` and ``body1``."""
    from pxr import UsdPhysics

    joint = UsdPhysics.Joint(prim)
    return joint.GetBody0Rel(), joint.GetBody1Rel()


def _joint_kind(prim: Any) -> str:
    """Return ``revolute``, ``prismatic``, ``fixed``, or the file's word for any other joint."""
    from pxr import UsdPhysics

    for kind in ("revolute", "prismatic", "fixed"):
        if prim.IsA(getattr(UsdPhysics, f"{kind.capitalize()}Joint")):
            return kind
    return str(prim.GetTypeName())


def read_joint(prim: Any, bodies: dict[str, PhysicsBody], pose_of: PoseOf) -> PhysicsJoint:
    """Return one joint, a prim of a type derived from ``UsdPhysics.Joint``.

    Bodies are given by path, and ``pose_of`` returns a prim's pose in the world, metres and scale
    included; of ``None`` the stage's.
    """
    from pxr import UsdPhysics

    joint = UsdPhysics.Joint(prim)
    (first, one), (second, other) = (_end(each, bodies, pose_of) for each in joint_ends(prim))
    place = joint.GetLocalPos1Attr()
    turn = joint.GetLocalRot1Attr()
    frame = _frame(joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr(), one, bodies[first])
    frames = (frame, _frame(place, turn, other, bodies[second]))
    kind = _joint_kind(prim)
    name = str(prim.GetName())
    if kind not in ("revolute", "prismatic"):
        return PhysicsJoint(name, kind, (first, second), frames)
    turns = kind == "revolute"
    schema = (UsdPhysics.RevoluteJoint if turns else UsdPhysics.PrismaticJoint)(prim)
    unit = np.pi / 180.0 if turns else float(np.cbrt(np.prod(bodies[first].scale)))
    return PhysicsJoint(
        name,
        kind,
        (first, second),
        frames,
        AXES.get(str(schema.GetAxisAttr().Get()), AXES["X"]),
        _limit(schema.GetLowerLimitAttr(), unit),
        _limit(schema.GetUpperLimitAttr(), unit),
        _damping(prim, "angular" if turns else "linear", unit if turns else 1.0),
        _number(prim.GetAttribute("newton:friction")),
        bool(place.HasAuthoredValue() and turn.HasAuthoredValue()),
        _mimic(prim, unit),
    )


def _mimic(prim: Any, unit: float) -> Mimic | None:
    """Return what a joint follows, of which one of its units is ``unit`` [rad] or [m].

    Newton says ``joint = coef0 + coef1 leader``, PhysX ``joint + gearing leader + offset = 0``.
    """
    from pxr import UsdGeom

    relation = prim.GetRelationship("newton:mimicJoint")
    words = ("newton:mimicCoef1", "newton:mimicCoef0")
    sign = 1.0
    if not (relation and relation.HasAuthoredTargets()):
        named = [r for r in prim.GetRelationships() if PHYSX_MIMIC.fullmatch(r.GetName())]
        if not named:
            return None
        relation = named[0]
        before = relation.GetName().removesuffix("referenceJoint")
        words = (f"{before}gearing", f"{before}offset")
        sign = -1.0
    targets = relation.GetForwardedTargets()
    leader = prim.GetStage().GetPrimAtPath(targets[0]) if targets else None
    if leader is None or not leader:
        return None
    metres = float(UsdGeom.GetStageMetersPerUnit(prim.GetStage()))
    led = np.pi / 180.0 if _joint_kind(leader) == "revolute" else metres
    multiplier = prim.GetAttribute(words[0])
    said = float(multiplier.Get()) if multiplier and multiplier.HasAuthoredValue() else 1.0
    constant = _number(prim.GetAttribute(words[1]))
    return Mimic(str(leader.GetName()), sign * said * unit / led, sign * constant * unit)


def _end(relation: Any, bodies: dict[str, PhysicsBody], pose_of: PoseOf) -> tuple[str, FloatArray]:
    """Return the body that a relationship names, or the one around, and the pose of what it names.

    A relationship that names nothing means the world.
    """
    targets = relation.GetForwardedTargets()
    path = targets[0] if targets else None
    while path is not None and not path.isEmpty and str(path) not in bodies:
        path = path.GetParentPath()
    body = WORLD if path is None or path.isEmpty else str(path)
    stage = relation.GetStage()
    prim = (stage.GetPrimAtPath(targets[0]) if targets else None) or stage.GetPrimAtPath(body)
    return body, pose_of(None if prim.IsPseudoRoot() else prim)


def _frame(position: Any, rotation: Any, pose: FloatArray, body: PhysicsBody) -> FloatArray:
    """Return a joint's frame in its body's, from where it is on the prim of that pose."""
    local = np.array(position.Get() or (0.0, 0.0, 0.0), dtype=np.float64)
    frame, _ = split_scale(pose)
    frame[:3, :3] = frame[:3, :3] @ rotation_of(rotation.Get())
    frame[:3, 3] += pose[:3, :3] @ local
    return np.asarray(np.linalg.inv(body.pose) @ frame)


def _limit(attribute: Any, unit: float) -> float | None:
    value = attribute.Get()
    return None if value is None or not np.isfinite(value) else float(value) * unit


def _damping(prim: Any, motion: str, per: float) -> float:
    from pxr import UsdPhysics

    if not prim.HasAPI(UsdPhysics.DriveAPI, motion):
        return 0.0
    return _number(UsdPhysics.DriveAPI.Get(prim, motion).GetDampingAttr()) / per


def _number(attribute: Any) -> float:
    value = attribute.Get() if attribute else None
    return 0.0 if value is None else float(value)
