"""Does friction hold the joints that it should hold, or do they creep?

What should be held is decided by the description alone: its masses, centres of mass, axes and
friction. What its weight should move is free to move.
"""

from __future__ import annotations

from typing import Any

from ..config import CheckConfig, MotionConfig
from ..description import Description, JointLine
from ..geometry.kinematics import find_tree
from ..geometry.statics import gravity_load
from ..report import Finding
from ..simulators.simulator import HoldMotion, Observation, Simulator
from .result import DECIMALS, CheckResult, Findings, about, graded, not_finite, rounded

#: Where no file of the format can tell the engine better.
SOFT = "; its joint friction is soft, and this format cannot tell it to be stiff"


def check_creep(
    description: Description, engine: Simulator, observation: Observation, config: CheckConfig
) -> CheckResult:
    """Check what joints did that were left alone part-way open.

    Creep is a warning where no file of the format can tell the engine how stiffly friction holds.
    """
    tree = find_tree(description)
    if tree is None:
        return CheckResult()
    soft = description.format in engine.soft_friction
    lines = {line.name: line for line in description.joints}
    ranges = {motion.joint: motion.range for motion in observation.motions}
    advice = SOFT if soft else engine.friction_advice
    findings: list[Finding] = []
    rows: list[dict[str, Any]] = []
    for held in observation.holds:
        line = lines.get(held.joint)
        load = None if line is None else gravity_load(description, tree, line, held.values)
        if line is None or load is None or abs(load) > config.motion.hold_share * line.friction:
            continue
        findings += _findings(held, line, ranges[held.joint], config.motion, soft, advice)
        row = {"at": held.values[held.joint], "moved": held.moved, "load": load}
        rows.append({"joint": held.joint, **{k: round(v, DECIMALS) + 0.0 for k, v in row.items()}})
    # Of each code and joint the largest.
    kinds = dict.fromkeys((each.code, each.joint) for each in findings)
    alike = ([each for each in findings if (each.code, each.joint) == kind] for kind in kinds)
    worst = (max(same, key=lambda each: each.value or 0.0) for same in alike)
    return CheckResult(tuple(worst), {"hold": rows})


def _findings(
    held: HoldMotion, line: JointLine, length: float, config: MotionConfig, soft: bool, advice: str
) -> Findings:
    subject = about(line)
    at = f"{round(held.values[line.name], DECIMALS) + 0.0:.4g}"
    if not held.finite:
        yield not_finite(f"joint {line.name!r}", f"left alone at {at}", **subject)
        return
    most = config.creep_m if line.kind == "prismatic" else config.creep_rad
    allowed = min(most, config.creep_share * length)
    unit = line.unit
    if held.moved > allowed:
        pressed = held.pressed_by
        why = advice if pressed is None else f"; {pressed[0]!r} presses on {pressed[1]!r}"
        message = (
            f"joint {line.name!r}, left alone at {at}, crept by {held.moved:.3g} "
            f"{unit} in {config.held_s:g} s though its friction of {line.friction:.3g} holds its "
            f"weight; at most {allowed:.3g} {unit} is allowed{why}"
        )
        yield graded(not soft, "creeps", message, **subject, **rounded(held.moved, unit, allowed))
