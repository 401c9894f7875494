"""Does the engine hold each joint as the file has it?

Compared are kind, limits, axis, mimic, damping and friction.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np

from ..config import LoadingConfig
from ..description import Description, JointLine
from ..geometry.coupling import leaders, whole_chain
from ..geometry.kinematics import MOVING_KINDS, sound_mimics, unit_axis
from ..report import Finding
from ..simulators.world import LoadedJoint
from .result import (
    Concerned,
    Findings,
    about,
    error,
    finite,
    listed,
    measured,
    note,
    rounded,
    significant,
    three,
    warning,
)

#: An axis shorter than this is no direction; what an engine makes of it is the lint's business.
NO_AXIS = 1e-9
#: Digits that single precision holds.
SINGLE = 7


def joint_findings(
    description: Description, joints: Mapping[str, LoadedJoint], config: LoadingConfig
) -> Findings:
    """Yield errors where a joint moves otherwise than the file says, warnings for omissions."""
    for line in description.joints:
        if line.kind != "fixed":
            yield from _joint(line, joints.get(line.name), config)
    yield from _coupling(description, joints, config)
    yield from _ignored(description, joints)
    written = {line.name for line in description.joints}
    if more := [name for name in joints if name not in written]:
        yield added("joints", more)


def added(what: str, names: Sequence[str], **concerned: Unpack[Concerned]) -> Finding:
    """Return the warning that an engine holds ``links`` or ``joints`` that no file gave it."""
    held = f"holds {len(names)} {what} that the file does not have"
    message = f"{held}, want none: {listed(names)}"
    code = {"links": "link_added", "joints": "joint_added"}[what]
    return warning(code, message, **concerned, **rounded(len(names), what, 0.0))


def joint_numbers(joint: LoadedJoint) -> dict[str, Any]:
    """Return a joint as held, as JSON data."""
    mimic = None if joint.forced_by_judge else joint.mimic
    return {
        "joint": joint.name,
        "kind": joint.kind,
        "lower": significant(joint.lower, SINGLE),
        "upper": significant(joint.upper, SINGLE),
        "axis": None if joint.axis is None else [significant(x, SINGLE) for x in joint.axis],
        "damping": significant(joint.damping, SINGLE),
        "friction": significant(joint.friction, SINGLE),
        "follows": None if mimic is None else mimic.leader,
        "rate": None if mimic is None else significant(mimic.multiplier, SINGLE),
        "offset": None if mimic is None else significant(mimic.offset, SINGLE),
    }


def _joint(line: JointLine, held: LoadedJoint | None, config: LoadingConfig) -> Findings:
    subject = about(line)
    if held is None:
        message = f"joint {line.name!r} of the file is not in the loaded model"
        yield error("joint_missing", message, **subject)
        return
    lower = -math.inf if line.lower is None else line.lower
    upper = math.inf if line.upper is None else line.upper
    endless = math.isinf(lower) and {held.kind, line.kind} <= {"revolute", "continuous"}
    if line.kind in MOVING_KINDS and held.kind != line.kind and not endless:
        message = f"joint {line.name!r} is {held.kind}, the file says {line.kind}"
        yield error("joint_kind", message, **subject)
    unit = line.unit
    for side, said, has in (("lower", lower, held.lower), ("upper", upper, held.upper)):
        if _differ(said, has, config.limit):
            holds = f"{side} limit of joint {line.name!r} is {has:.6g} {unit}"
            message = f"{holds}, the file says {said:.6g} {unit}"
            yield error("limit_mismatch", message, **subject, **measured(has, unit, said))
    turned = math.degrees(_turned(line, held))
    most = math.degrees(config.angle_rad)
    if turned > most:
        message = (
            f"the axis of joint {line.name!r} is {three(held.axis)}, "
            f"{turned:.4g} deg from {three(unit_axis(line))} of the file"
        )
        yield error("axis_mismatch", message, **subject, **rounded(turned, "deg", most))


def _turned(line: JointLine, held: LoadedJoint) -> float:
    """Return the angle between the file's axis and the engine's [rad]; 0 where one tells none."""
    told = line.kind in MOVING_KINDS and float(np.linalg.norm(line.axis)) > NO_AXIS
    if held.axis is None or not told:
        return 0.0
    axis = np.asarray(held.axis, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    if not length > NO_AXIS:
        return math.pi
    return 2.0 * math.asin(min(1.0, 0.5 * float(np.linalg.norm(axis / length - unit_axis(line)))))


def _coupling(
    description: Description, joints: Mapping[str, LoadedJoint], config: LoadingConfig
) -> Findings:
    mimics = sound_mimics(description)
    dropped = []
    for line in description.joints:
        held = joints.get(line.name)
        if held is None or line.kind not in MOVING_KINDS:
            continue
        followed = leaders(line.name, mimics)
        subject = about(line)
        if followed and (held.follows is None or held.forced_by_judge):
            dropped.append(line.name)
        elif line.mimic is not None and not followed:
            # It follows nothing that can be followed, which the lint says.
            continue
        elif held.follows is not None and held.follows not in followed:
            said = f"follows {followed[0]!r}" if followed else "is free"
            message = (
                f"joint {line.name!r} is made to follow {held.follows!r}, "
                f"in the file it {said}; want them coupled as written"
            )
            yield error("mimic_mismatch", message, **subject)
        elif (has := held.mimic) is not None:
            whole = whole_chain(line.name, mimics, held.follows)
            pairs = ((whole.multiplier, has.multiplier), (whole.offset, has.offset))
            wrong = next((pair for pair in pairs if _differ(*pair, config.limit)), None)
            if wrong is not None:
                message = (
                    f"joint {line.name!r} is held at {has.multiplier:.6g} times "
                    f"{has.leader!r} plus {has.offset:.6g}, "
                    f"the file says {whole.multiplier:.6g} times plus {whole.offset:.6g}"
                )
                limit, value = map(finite, wrong)
                yield error("mimic_mismatch", message, **subject, value=value, limit=limit)
    if dropped:
        uncoupled = f"does not couple {listed(dropped)} to another joint as the file does"
        message = f"{uncoupled}: whoever simulates it must"
        yield warning("mimic_ignored", message, **rounded(len(dropped), "joints", 0.0))


def _ignored(description: Description, joints: Mapping[str, LoadedJoint]) -> Findings:
    for quantity in ("friction", "damping"):
        names = []
        for line in description.joints:
            held = joints.get(line.name)
            said = getattr(line, quantity)
            if held is None or line.kind not in MOVING_KINDS or said == 0.0:
                continue
            has = getattr(held, quantity)
            if has is None or not math.isclose(has, said, rel_tol=1e-4):
                names.append(line.name)
        if names:
            message = f"drops the {quantity} that the file gives to {listed(names)}"
            count = measured(float(len(names)), "joints")
            yield note(f"{quantity}_ignored", message, joints=tuple(names), **count)


def _differ(said: float, has: float, tolerance: float) -> bool:
    if math.isnan(said):
        # The lint says so; there is no number to hold anyone to.
        return False
    if math.isinf(said) or math.isinf(has):
        return said != has
    return not abs(said - has) <= tolerance * max(1.0, abs(said))
