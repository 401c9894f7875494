"""Physics joints of a USD stage: frames on both bodies, axis and limits, in SI units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...description import FloatArray
from .bodies import WORLD, PhysicsBody, rotation_of, split_scale
from .prims import AXES, joint_kind

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


def read_joint(prim: Any, bodies: dict[str, PhysicsBody], pose_of: PoseOf) -> PhysicsJoint:
    """Return one joint.

    Args:
        prim: of a type derived from ``UsdPhysics.Joint``.
        bodies: by path.
        pose_of: a prim's pose in the world, metres and scale included; of ``None`` the stage's.
    """
    from pxr import UsdPhysics

    joint = UsdPhysics.Joint(prim)
    first, one = _end(joint.GetBody0Rel(), bodies, pose_of)
    second, other = _end(joint.GetBody1Rel(), bodies, pose_of)
    place = joint.GetLocalPos1Attr()
    turn = joint.GetLocalRot1Attr()
    frames = (
        _frame(joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr(), one, bodies[first]),
        _frame(place, turn, other, bodies[second]),
    )
    kind = joint_kind(prim)
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
    )


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
