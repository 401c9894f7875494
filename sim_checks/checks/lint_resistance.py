"""Do friction and damping of a joint let a hand open it, and can engines integrate them?"""

from __future__ import annotations

import math

import numpy as np

from ..config import LintConfig
from ..description import Description, FloatArray, JointLine, Link
from ..geometry.kinematics import Tree, sweep_range
from ..geometry.path import JointAxis, joint_axis
from ..geometry.placing import placed
from .result import Findings, about, graded, measured, significant, warning

#: What robot-learning environments commonly step by [s].
TIME_STEP_S = 1.0 / 240.0

Posed = list[tuple[Link, FloatArray]]


def resistance_findings(description: Description, tree: Tree, config: LintConfig) -> Findings:
    """Yield errors where no hand opens the joint, warnings where it takes much or may explode.

    Explicit engines explode from too much damping.
    """
    poses = tree.link_poses(tree.closed)
    links = {link.name: link for link in description.links}
    for joint in tree.moving:
        limits = sweep_range(joint)
        points = float(np.linalg.norm(joint.axis)) > 0.0
        if limits is None or not points or not min(joint.friction, joint.damping) >= 0.0:
            continue
        moved = [(links[name], poses[name]) for name in sorted(tree.below(joint))]
        line = joint_axis(joint, poses[joint.child])
        reach = _reach(line, moved)
        if reach > 0.0:
            yield from _force_findings(joint, limits[1] - limits[0], reach, config)
        yield from _step_finding(joint, _moved_inertia(line, moved), config)


def _force_findings(joint: JointLine, length: float, reach: float, config: LintConfig) -> Findings:
    within = f"open it against its damping within {config.opening_s:g} s"
    where = "" if joint.kind == "prismatic" else " at its far edge"
    for code, force, purpose in (
        ("friction_excessive", joint.friction / reach, "overcome its friction"),
        ("damping_excessive", joint.damping * length / config.opening_s / reach, within),
    ):
        if force > config.pull_soft_n:
            hard = force > config.pull_hard_n
            limit = config.pull_hard_n if hard else config.pull_soft_n
            takes = f"joint {joint.name!r}: it takes {force:.4g} N{where} to {purpose}"
            message = f"{takes}, want at most {limit:g} N"
            told = measured(round(force, 3), "N", limit)
            yield graded(hard, code, message, **about(joint), **told)


def _step_finding(joint: JointLine, inertia: float, config: LintConfig) -> Findings:
    if not inertia > 0.0:
        return
    share = joint.damping * TIME_STEP_S / inertia
    if share > config.damping_step:
        message = (
            f"joint {joint.name!r}: damping takes away {share:.3g} times its speed in one step of "
            "1/240 s: Bullet and others that integrate it explicitly overshoot "
            f"above {config.damping_step:g} and become unstable above 2"
        )
        told = measured(significant(share), "of speed", config.damping_step)
        yield warning("damping_stiff", message, **about(joint), **told)


def _reach(line: JointAxis, moved: Posed) -> float:
    """Return the farthest point's distance from the axis [m]; 1 for a slide, which has no lever."""
    if not line.turning:
        return 1.0
    shapes = ((s, pose) for link, pose in moved for s in (*link.collisions, *link.visuals))
    arms = (line.arms(placed(shape.vertices, pose)) for shape, pose in shapes)
    return max((float(np.linalg.norm(a, axis=1).max(initial=0.0)) for a in arms), default=0.0)


def _moved_inertia(line: JointAxis, moved: Posed) -> float:
    """Return the inertia about the axis [kg m2], or along it [kg]; 0 where the file gives none."""
    total = 0.0
    for link, pose in moved:
        held = link.inertia
        if held is not None and math.isfinite(held.mass) and np.isfinite(held.tensor).all():
            along = pose[:3, :3].T @ line.axis
            (arm,) = line.arms(placed(held.center[None], pose))
            turning = float(along @ held.tensor @ along + held.mass * (arm @ arm))
            total += turning if line.turning else held.mass
    return total
