"""Are a joint's range, its axis and what may drive it of a size that fits the object?"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ..config import LintConfig
from ..description import Description, FloatArray, JointLine
from ..geometry.boxy import edge_meant
from ..geometry.kinematics import MOVING_KINDS, Tree
from ..geometry.path import JointAxis, joint_axis
from ..geometry.placing import box_gap, diagonal, joined, placed, shape_corners
from .result import Findings, about, error, graded, measured, rounded, significant, warning

#: Directions in the half-degrees of a circle in which an axis may stand off.
AROUND = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)


def range_findings(description: Description, tree: Tree | None, config: LintConfig) -> Findings:
    """Yield errors for impossible ranges and axes, warnings for tiny ranges and drives."""
    poses = {} if tree is None else tree.link_poses(tree.closed)
    shapes = ((link.name, (*link.collisions, *link.visuals)) for link in description.links)
    corners = {name: shape_corners(own) for name, own in shapes if name in poses}
    boxes = {name: placed(points, poses[name]) for name, points in corners.items() if len(points)}
    across = diagonal(boxes.values())
    for joint in description.joints:
        if joint.kind not in MOVING_KINDS:
            continue
        ends = (joint.lower, joint.upper)
        stated = all(end is not None and math.isfinite(end) for end in ends)
        if stated and joint.kind != "continuous":
            length = (joint.upper or 0.0) - (joint.lower or 0.0)
            yield from _size_findings(joint, length, across, config)
        yield from _drive_findings(joint)
        if tree is not None:
            yield from _place_findings(joint, tree, poses, boxes, config)
    if tree is not None:
        yield from _oblique_findings(description, tree, poses, config)


def _size_findings(joint: JointLine, length: float, across: float, config: LintConfig) -> Findings:
    slides = joint.kind == "prismatic"
    most = config.slide_share * across if slides else config.turns * 2.0 * math.pi
    least = config.tiny_slide_m if slides else config.tiny_turn_rad
    unit = joint.unit
    value = significant(length)
    if slides and not across > 0.0:
        most = math.inf
    if length > most:
        turns = f"that is {length / (2 * math.pi):.3g} turns"
        of = f"the object is {across:.3g} m across" if slides else turns
        but = f"{of}{_slip(length, across, slides)}"
        message = f"joint {joint.name!r} moves by {length:.6g} {unit}, but {but}"
        told = measured(value, unit, significant(most))
        yield error("range_implausible", message, **about(joint), **told)
    elif 0.0 < length < least:
        message = f"joint {joint.name!r} moves by {length:.3g} {unit} and so opens nothing, "
        message += f"want {least:.3g} at least"
        told = measured(value, unit, significant(least))
        yield warning("range_tiny", message, **about(joint), **told)


def _slip(length: float, across: float, slides: bool) -> str:
    """Return the likely reason for a range that is too long but would be fair in another unit."""
    if slides and 0.01 <= length / 1000.0 <= across:
        return ": millimetres, most likely, where metres are meant"
    if not slides and length <= 360.0:
        return ": degrees, most likely, where radians are meant"
    return ""


def _drive_findings(joint: JointLine) -> Findings:
    for word, number in (("effort", joint.effort), ("velocity", joint.velocity)):
        if number is not None and not number > 0.0:
            message = f"joint {joint.name!r} has {word} {number:g} in its limit: "
            message += "nothing may move it; want more than 0"
            yield warning("invalid_effort", message, **about(joint), **measured(number, limit=0.0))


def _place_findings(
    joint: JointLine,
    tree: Tree,
    poses: Mapping[str, FloatArray],
    boxes: Mapping[str, FloatArray],
    config: LintConfig,
) -> Findings:
    below = tree.below(joint)
    moved = [corners for name, corners in boxes.items() if name in below]
    rest = [corners for name, corners in boxes.items() if name not in below]
    size = diagonal(moved)
    if not (moved and rest and size > 0.0):
        return
    gap = box_gap(np.vstack(moved), np.vstack(rest))
    most = config.apart * max(size, diagonal(rest))
    if gap > most:
        part = f"the part that joint {joint.name!r} moves"
        away = f"{gap:.3g} m away from the rest of the object, further than the size of either"
        message = f"{part} is {away}; want at most {most:.3g} m"
        yield error("part_remote", message, **about(joint), **rounded(gap, "m", most))
        return
    if joint.kind == "prismatic" or not float(np.linalg.norm(joint.axis)) > 0.0:
        return
    line = joint_axis(joint, poses[joint.child])
    distance = min(_beside(line, np.vstack(group)) for group in (moved, rest))
    if distance > config.axis_soft * size:
        hard = distance > config.axis_hard * size
        message = (
            f"the axis of joint {joint.name!r} passes {distance:.3g} m beside every part, "
            f"further than the size of the part that it moves, {size:.3g} m; a hinge is on a part"
        )
        limit = (config.axis_hard if hard else config.axis_soft) * size
        yield graded(hard, "axis_remote", message, **about(joint), **rounded(distance, "m", limit))


def _oblique_findings(
    description: Description, tree: Tree, poses: Mapping[str, FloatArray], config: LintConfig
) -> Findings:
    links = {link.name: link for link in description.links}
    parts = tree.part_of()
    most = config.oblique_deg
    for joint in tree.moving:
        line = joint_axis(joint, poses[joint.child])
        own = ((links[name], poses[name]) for name in tree.parts[parts[joint.child]])
        shapes = ((shape, at) for link, at in own for shape in link.visuals or link.collisions)
        mesh = joined(shapes) if line.turning else None
        edge = None if mesh is None else edge_meant(*mesh, line.axis)
        angle = 0.0 if edge is None else math.degrees(math.acos(min(float(edge @ line.axis), 1.0)))
        if angle > most:
            message = (
                f"the axis of joint {joint.name!r} is {angle:.1f} deg off every edge of the box "
                f"that it turns, want at most {most:g}: doors and lids turn along an edge"
            )
            yield error("axis_oblique", message, **about(joint), **rounded(angle, "deg", most))


def _beside(line: JointAxis, corners: FloatArray) -> float:
    """Return how far a line passes beside the convex hull of points [m]; 0 if it goes through."""
    first = np.cross(line.axis, np.eye(3)[int(np.argmin(np.abs(line.axis)))])
    first /= np.linalg.norm(first)
    flat = (corners - line.origin) @ np.column_stack([first, np.cross(line.axis, first)])
    around = np.column_stack([np.cos(AROUND), np.sin(AROUND)])
    # Some direction sees every point at least so far ahead.
    return max(0.0, float((flat @ around.T).min(axis=0).max()))
