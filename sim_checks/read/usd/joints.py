"""Physics joints of a USD stage: frames on both bodies, axis and limits, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...description import FloatArray
from .bodies import WORLD, PhysicsBody, rotation_of
from .prims import AXES, joint_kind


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
    """

    name: str
    kind: str
    bodies: tuple[str, str]
    frames: tuple[FloatArray, FloatArray]
    axis: FloatArray
    lower: float | None
    upper: float | None
    damping: float
    friction: float


def read_joint(prim: Any, bodies: dict[str, PhysicsBody]) -> PhysicsJoint:
    """Return one joint; lengths are those of the bodies that it holds."""
    from pxr import UsdPhysics

    joint = UsdPhysics.Joint(prim)
    first = _target(joint.GetBody0Rel(), bodies)
    second = _target(joint.GetBody1Rel(), bodies)
    frames = (
        _frame(joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr(), bodies[first]),
        _frame(joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr(), bodies[second]),
    )
    kind = joint_kind(prim)
    if kind not in ("revolute", "prismatic"):
        return PhysicsJoint(
            str(prim.GetName()), kind, (first, second), frames, AXES["X"], None, None, 0.0, 0.0
        )
    turns = kind == "revolute"
    schema = (UsdPhysics.RevoluteJoint if turns else UsdPhysics.PrismaticJoint)(prim)
    unit = np.pi / 180.0 if turns else float(np.cbrt(np.prod(bodies[first].scale)))
    return PhysicsJoint(
        str(prim.GetName()),
        kind,
        (first, second),
        frames,
        AXES[str(schema.GetAxisAttr().Get())],
        _limit(schema.GetLowerLimitAttr(), unit),
        _limit(schema.GetUpperLimitAttr(), unit),
        _damping(prim, "angular" if turns else "linear", unit if turns else 1.0),
        _number(prim.GetAttribute("newton:friction")),
    )


def _target(relation: Any, bodies: dict[str, PhysicsBody]) -> str:
    """Return the body that a relationship names, or the one around what it names."""
    targets = relation.GetForwardedTargets()
    path = targets[0] if targets else None
    while path is not None and not path.isEmpty and str(path) not in bodies:
        path = path.GetParentPath()
    return WORLD if path is None or path.isEmpty else str(path)


def _frame(position: Any, rotation: Any, body: PhysicsBody) -> FloatArray:
    frame = np.eye(4)
    frame[:3, :3] = rotation_of(rotation.Get())
    frame[:3, 3] = np.array(position.Get() or (0.0, 0.0, 0.0), dtype=np.float64) * body.scale
    return frame


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
