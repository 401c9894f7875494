"""Does the engine hold each joint as the file has it?

Compared are kind, limits, axis, mimic, damping and friction.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..config import LoadingConfig
from ..description import Description, JointLine, Mimic
from ..geometry.coupling import whole_chain
from ..geometry.kinematics import MOVING_KINDS, sound_mimics, unit_axis
from ..report import Finding
from ..simulators.simulator import LoadedJoint
from .result import error, note, warning

#: Names spelled out in a sentence that concerns many.
MOST_NAMES = 4
#: An axis shorter than this is no direction; what an engine makes of it is the lint's business.
NO_AXIS = 1e-9


def joint_findings(
    description: Description,
    joints: Mapping[str, LoadedJoint],
    simulator: str,
    config: LoadingConfig,
) -> Iterator[Finding]:
    """Yield errors where a joint moves otherwise than the file says, warnings for omissions."""
    for line in description.joints:
        if line.kind != "fixed":
            yield from _joint(line, joints.get(line.name), simulator, config)
    yield from _coupling(description, joints, simulator, config)
    yield from _ignored(description, joints, simulator)
    written = {line.name for line in description.joints}
    added = [name for name in joints if name not in written]
    if added:
        message = (
            f"{simulator} holds {len(added)} joints that the file does not have, "
            f"want none: {listed(added)}"
        )
        yield warning(
            "joint_added",
            message,
            simulator=simulator,
            value=float(len(added)),
            unit="joints",
            limit=0.0,
        )


def joint_numbers(joint: LoadedJoint) -> dict[str, Any]:
    """Return a joint as held, as JSON data."""
    return {
        "joint": joint.name,
        "kind": joint.kind,
        "lower": rounded(joint.lower),
        "upper": rounded(joint.upper),
        "axis": None if joint.axis is None else [rounded(number) for number in joint.axis],
        "damping": rounded(joint.damping),
        "friction": rounded(joint.friction),
        "follows": None if joint.forced_by_judge else joint.follows,
        "rate": None if joint.mimic is None or joint.forced_by_judge else rounded(joint.rate),
        "offset": None if joint.mimic is None or joint.forced_by_judge else rounded(joint.offset),
    }


def listed(names: list[str]) -> str:
    """Return a few names and the number of the others."""
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(repr(name) for name in names[:MOST_NAMES]) + more


def rounded(value: float | None) -> float | None:
    """Round to what single precision holds; ``None`` where there is no number to write."""
    return None if value is None or not math.isfinite(value) else float(f"{value:.7g}")


def finite(value: float) -> float | None:
    """Return the number, or ``None`` where it is none that can be written."""
    return value if math.isfinite(value) else None


def _joint(
    line: JointLine, held: LoadedJoint | None, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    def found(code: str, message: str, **numbers: Any) -> Finding:
        where = (line.parent, line.child)
        sentence = f"{simulator}: {message}"
        return error(code, sentence, simulator=simulator, joint=line.name, parts=where, **numbers)

    if held is None:
        yield found("joint_missing", f"joint {line.name!r} of the file is not in the loaded model")
        return
    lower = -math.inf if line.lower is None else line.lower
    upper = math.inf if line.upper is None else line.upper
    unlimited = {"revolute", "continuous"}
    same_kind = held.kind == line.kind or (
        math.isinf(lower) and {held.kind, line.kind} <= unlimited
    )
    if line.kind in MOVING_KINDS and not same_kind:
        yield found("joint_kind", f"joint {line.name!r} is {held.kind}, the file says {line.kind}")
    unit = "m" if line.kind == "prismatic" else "rad"
    for side, said, has in (("lower", lower, held.lower), ("upper", upper, held.upper)):
        if _differ(said, has, config.limit):
            message = (
                f"{side} limit of joint {line.name!r} is {has:.6g} {unit}, "
                f"the file says {said:.6g} {unit}"
            )
            yield found("limit_mismatch", message, value=finite(has), unit=unit, limit=finite(said))
    turned = _turned(line, held)
    if turned > config.angle_rad:
        message = (
            f"the axis of joint {line.name!r} is {_three(held.axis)}, "
            f"{math.degrees(turned):.4g} deg from {_three(unit_axis(line))} of the file"
        )
        limit = round(math.degrees(config.angle_rad), 6)
        yield found(
            "axis_mismatch", message, value=round(math.degrees(turned), 6), unit="deg", limit=limit
        )


def _turned(line: JointLine, held: LoadedJoint) -> float:
    """Return the angle between the file's axis and the engine's [rad]; 0 where one tells none."""
    if (
        held.axis is None
        or line.kind not in MOVING_KINDS
        or not float(np.linalg.norm(line.axis)) > NO_AXIS
    ):
        return 0.0
    axis = np.asarray(held.axis, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    if not length > NO_AXIS:
        return math.pi
    return 2.0 * math.asin(min(1.0, 0.5 * float(np.linalg.norm(axis / length - unit_axis(line)))))


def _coupling(
    description: Description,
    joints: Mapping[str, LoadedJoint],
    simulator: str,
    config: LoadingConfig,
) -> Iterator[Finding]:
    mimics = sound_mimics(description)
    dropped = []
    for line in description.joints:
        held = joints.get(line.name)
        if held is None or line.kind not in MOVING_KINDS:
            continue
        leaders: list[str] = []
        while (at := leaders[-1] if leaders else line.name) in mimics:
            leaders.append(mimics[at].leader)
        if leaders and (held.follows is None or held.forced_by_judge):
            dropped.append(line.name)
        elif line.mimic is not None and not leaders:
            # It follows nothing that can be followed, which the lint says.
            continue
        elif held.follows is not None and held.follows not in leaders:
            said = f"follows {leaders[0]!r}" if leaders else "is free"
            message = (
                f"{simulator}: joint {line.name!r} is made to follow {held.follows!r}, "
                f"in the file it {said}; want them coupled as written"
            )
            parts = (line.parent, line.child)
            yield error(
                "mimic_mismatch", message, simulator=simulator, joint=line.name, parts=parts
            )
        elif held.mimic is not None:
            yield from _otherwise(
                line, whole_chain(line.name, mimics, held.follows), held.mimic, simulator, config
            )
    if dropped:
        message = (
            f"{simulator} does not couple {listed(dropped)} to another joint as the file does: "
            "whoever simulates it must"
        )
        count = float(len(dropped))
        yield warning(
            "mimic_ignored", message, simulator=simulator, value=count, unit="joints", limit=0.0
        )


def _otherwise(
    line: JointLine, said: Mimic, held: Mimic, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    """Tell whether it follows the joint that the file says, but by other numbers."""
    pairs = ((said.multiplier, held.multiplier), (said.offset, held.offset))
    wrong = next((pair for pair in pairs if _differ(*pair, config.limit)), None)
    if wrong is not None:
        message = (
            f"{simulator}: joint {line.name!r} is held at {held.multiplier:.6g} times "
            f"{held.leader!r} plus {held.offset:.6g}, "
            f"the file says {said.multiplier:.6g} times plus {said.offset:.6g}"
        )
        value = finite(wrong[1])
        limit = finite(wrong[0])
        parts = (line.parent, line.child)
        yield error(
            "mimic_mismatch",
            message,
            simulator=simulator,
            joint=line.name,
            parts=parts,
            value=value,
            limit=limit,
        )


def _ignored(
    description: Description, joints: Mapping[str, LoadedJoint], simulator: str
) -> Iterator[Finding]:
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
            message = f"{simulator} drops the {quantity} that the file gives to {listed(names)}"
            yield note(
                f"{quantity}_ignored",
                message,
                simulator=simulator,
                value=float(len(names)),
                unit="joints",
                joints=tuple(names),
            )


def _differ(said: float, has: float, tolerance: float) -> bool:
    if math.isnan(said):
        # The lint says so; there is no number to hold anyone to.
        return False
    if math.isinf(said) or math.isinf(has):
        return said != has
    return not abs(said - has) <= tolerance * max(1.0, abs(said))


def _three(values: Any) -> str:
    return "(" + ", ".join(f"{float(v):.4g}" for v in values) + ")"
