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
from ..simulators.simulator import HoldMotion, Observation
from .result import DECIMALS, CheckResult, Findings, about, graded, not_finite, rounded


def check_creep(
    description: Description,
    simulator: str,
    observation: Observation,
    config: CheckConfig,
    *,
    soft: bool,
) -> CheckResult:
    """Check what joints did that were left alone part-way open.

    Creep is a warning where no file of the format can tell the engine how stiffly friction holds
    (``soft``).
    """
    tree = find_tree(description)
    if tree is None:
        return CheckResult()
    lines = {line.name: line for line in description.joints}
    ranges = {motion.joint: motion.range for motion in observation.motions}
    findings: list[Finding] = []
    rows: list[dict[str, Any]] = []
    for held in observation.holds:
        line = lines.get(held.joint)
        load = None if line is None else gravity_load(description, tree, line, held.values)
        if line is None or load is None:
            continue
        if abs(load) > config.motion.hold_share * line.friction:
            continue
        findings.extend(_findings(held, line, ranges[held.joint], simulator, config.motion, soft))
        row = {"at": held.values[held.joint], "moved": held.moved, "load": load}
        rows.append({"joint": held.joint, **{k: round(v, DECIMALS) + 0.0 for k, v in row.items()}})
    # Of each code and joint the largest.
    kinds = dict.fromkeys((each.code, each.joint) for each in findings)
    alike = ([each for each in findings if (each.code, each.joint) == kind] for kind in kinds)
    worst = (max(same, key=lambda each: each.value or 0.0) for same in alike)
    return CheckResult(tuple(worst), {"hold": rows})


def _findings(
    held: HoldMotion,
    line: JointLine,
    length: float,
    simulator: str,
    config: MotionConfig,
    soft: bool,
) -> Findings:
    subject = about(line, simulator)
    at = f"{round(held.values[line.name], DECIMALS) + 0.0:.4g}"
    if not held.finite:
        yield not_finite(f"joint {line.name!r}", f"left alone at {at}", **subject)
        return
    most = config.creep_m if line.kind == "prismatic" else config.creep_rad
    allowed = min(most, config.creep_share * length)
    unit = line.unit
    if held.moved > allowed:
        message = (
            f"{simulator}: joint {line.name!r}, left alone at {at}, crept by {held.moved:.3g} "
            f"{unit} in {config.held_s:g} s though its friction of {line.friction:.3g} holds its "
            f"weight; at most {allowed:.3g} {unit} is allowed{_remedy(held, simulator, soft)}"
        )
        yield graded(not soft, "creeps", message, **subject, **rounded(held.moved, unit, allowed))


def _remedy(held: HoldMotion, simulator: str, soft: bool) -> str:
    if held.pressed_by is not None:
        one, two = held.pressed_by
        return f"; {one!r} presses on {two!r}"
    if soft:
        return f"; {simulator}'s joint friction is soft, and this format cannot tell it to be stiff"
    return "; solimpfriction near 1 makes MuJoCo's stiff" if simulator == "mujoco" else ""
