"""Physics joints of a USD stage: axes, anchors, limits in its frame, from the authored pose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from asset_factory.sim_checks.read.usd.prims import AXES, joint_kind

from ...articulation import rotation_about
from ...errors import InputRejected
from ...mesh import FloatArray

ALIGNED = np.radians(2.0)
"""Angle between two bodies' joint frames, about another axis than the joint's, to match [rad].

Beyond it nothing is known about the joint's value at the authored pose."""
CLOSE = 0.02
"""The same for their distance off the axis, as a share of that along it or of the joint's range."""


@dataclass(frozen=True)
class UsdJoint:
    """A joint in the stage's frame and units, at the authored pose.

    Attributes:
        name: of the prim.
        kind: ``revolute``, ``prismatic`` or ``fixed``.
        bodies: what it holds, first ``body0``.
        axis: unit, ``body1`` moves along or about it, shape [3].
        anchor: a point on it, shape [3].
        lower, upper: [rad] or [units], from the authored pose; ``None`` where there is no limit.
    """

    name: str
    kind: str
    bodies: tuple[str, str]
    axis: FloatArray
    anchor: FloatArray
    lower: float | None
    upper: float | None


@dataclass(frozen=True)
class _Frame:
    rotation: FloatArray
    position: FloatArray


class BodyFrames:
    """Where joints attach to bodies.

    Args:
        stage: a ``Usd.Stage``.
        cache: a ``UsdGeom.XformCache``.
        body_of: which body a prim belongs to.
    """

    def __init__(self, stage: Any, cache: Any, body_of: Callable[[Any], str]) -> None:
        self._stage = stage
        self._cache = cache
        self._body_of = body_of

    def body(self, relation: Any) -> str:
        """The body that a joint's relationship names; the static world if it names nothing."""
        prim = self._target(relation)
        return "" if prim is None else self._body_of(prim)

    def frame(self, relation: Any, position: Any, rotation: Any) -> _Frame:
        """The joint's frame on that body, in the stage's; lengths there scale as the body does."""
        prim = self._target(relation)
        matrix = (
            np.eye(4) if prim is None else np.array(self._cache.GetLocalToWorldTransform(prim)).T
        )
        local = np.array(position.Get() or (0.0, 0.0, 0.0), dtype=np.float64)
        turn = rotation.Get()
        own = (
            np.eye(3)
            if turn is None
            else _rotation(np.array([turn.GetReal(), *turn.GetImaginary()], dtype=float))
        )
        return _Frame(_rotation_part(matrix[:3, :3]) @ own, matrix[:3, :3] @ local + matrix[:3, 3])

    def _target(self, relation: Any) -> Any:
        targets = relation.GetForwardedTargets()
        prim = self._stage.GetPrimAtPath(targets[0]) if targets else None
        return prim if prim and not prim.IsPseudoRoot() else None


def joint_of(prim: Any, frames: BodyFrames) -> UsdJoint:
    """Return one joint. Raises InputRejected: ``unsupported_joint``, ``unreadable``."""
    from pxr import UsdPhysics

    joint = UsdPhysics.Joint(prim)
    ends = joint.GetBody0Rel(), joint.GetBody1Rel()
    first, second = (
        frames.frame(end, position, rotation)
        for end, position, rotation in (
            (ends[0], joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
            (ends[1], joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()),
        )
    )
    kind = _kind(prim)
    token = AXES["X"]
    lower = upper = None
    if kind != "fixed":
        schema = (UsdPhysics.RevoluteJoint if kind == "revolute" else UsdPhysics.PrismaticJoint)(
            prim
        )
        token = AXES.get(str(schema.GetAxisAttr().Get()), token)
        lower = _limit(schema.GetLowerLimitAttr(), kind)
        upper = _limit(schema.GetUpperLimitAttr(), kind)
        given = (
            joint.GetLocalPos1Attr().HasAuthoredValue()
            and joint.GetLocalRot1Attr().HasAuthoredValue()
        )
        at = _value_at_pose(kind, token, first, second, upper) if given else 0.0
        lower, upper = (None if value is None else value - at for value in (lower, upper))
    axis = first.rotation @ token
    if not (np.isfinite(axis).all() and np.isfinite(first.position).all()):
        raise InputRejected("unreadable", f"joint {prim.GetName()!r}: its frame is not finite")
    bodies = frames.body(ends[0]), frames.body(ends[1])
    return UsdJoint(str(prim.GetName()), kind, bodies, axis, first.position, lower, upper)


def _kind(prim: Any) -> str:
    kind = joint_kind(prim)
    if kind in ("revolute", "prismatic", "fixed"):
        return kind
    raise InputRejected(
        "unsupported_joint",
        f"joint {prim.GetName()!r}: is a {kind}; want a revolute, prismatic or fixed joint",
    )


def _limit(attribute: Any, kind: str) -> float | None:
    value = attribute.Get()
    if value is None or not np.isfinite(value):
        return None
    return float(np.radians(value)) if kind == "revolute" else float(value)


def _value_at_pose(
    kind: str, token: FloatArray, first: _Frame, second: _Frame, upper: float | None
) -> float:
    """The joint's value at the authored pose [rad] or [units]; 0 where frames do not match."""
    relative = first.rotation.T @ second.rotation
    cross = np.array(
        [
            relative[2, 1] - relative[1, 2],
            relative[0, 2] - relative[2, 0],
            relative[1, 0] - relative[0, 1],
        ]
    )
    # Twice the sine and twice the cosine of a rotation about the axis; of another one the rest
    # below is not small.
    angle = float(np.arctan2(token @ cross, np.trace(relative) - 1.0))
    turned = angle if kind == "revolute" else 0.0
    rest = rotation_about(token, -turned) @ relative
    off_angle = float(np.arccos(np.clip((np.trace(rest) - 1.0) / 2.0, -1.0, 1.0)))
    between = first.rotation.T @ (second.position - first.position)
    along = float(between @ token)
    off_axis = float(np.linalg.norm(between - along * token))
    if kind == "revolute":
        return turned if off_angle <= ALIGNED else 0.0
    reach = max(abs(along), abs(upper or 0.0))
    return along if off_angle <= ALIGNED and off_axis <= CLOSE * reach else 0.0


def _rotation(quaternion: FloatArray) -> FloatArray:
    """The rotation of a quaternion, real part first, of any length; none for zero. Shape [3, 3]."""
    length = float(np.linalg.norm(quaternion))
    if not length > 0.0:
        return np.eye(3)
    w, x, y, z = quaternion / length
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _rotation_part(linear: FloatArray) -> FloatArray:
    """The rotation nearest to a matrix that scales too, by polar decomposition, shape [3, 3]."""
    u, _, v = np.linalg.svd(linear)
    flip = np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v)))])
    return np.asarray(u @ flip @ v)
