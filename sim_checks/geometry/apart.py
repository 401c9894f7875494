"""Which joints cannot reach one another, so that a simulator may drive them at the same time."""

from collections.abc import Mapping

import numpy as np

from ..description import Description, FloatArray, JointLine, Link
from .kinematics import NotATree, build_tree, free_ranges, unit_axis
from .path import Path

#: What two joints of a group move stays further apart than this [m]; engines keep margins of up to
#: 2 mm around shapes.
MARGIN_M = 0.005
#: Intervals of a range around which boxes are found.
STEPS = 32
#: Which end of a box each of its corners has along each axis, shape [8, 3].
BOX = np.indices((2, 2, 2)).reshape(3, 8).T


def joints_apart(description: Description) -> tuple[tuple[str, ...], ...]:
    """Return groups of joints whose links stay apart, each over its whole range.

    Left out are joints that move with others, that carry other joints or that have no range, and
    groups of one joint alone.
    """
    try:
        tree = build_tree(description)
    except NotATree:
        return ()
    ranges = free_ranges(tree)
    poses = tree.link_poses({name: start for name, (start, _) in ranges.items()})
    corners = {link.name: _corners(link, poses) for link in description.links}
    groups: list[dict[str, FloatArray]] = []
    for joint in tree.free:
        links = tree.below(joint)
        carries = any(other.parent in links for other in tree.moving)
        if joint.name not in ranges or tree.followers(joint) or carries:
            continue
        points = np.vstack([corners[name] for name in sorted(links)])
        box = _swept(joint, ranges[joint.name], poses[joint.child], points)
        group = next((each for each in groups if _are_apart(box, each)), None)
        if group is None:
            groups.append({joint.name: box})
        else:
            group[joint.name] = box
    return tuple(tuple(group) for group in groups if len(group) > 1)


def _corners(link: Link, poses: Mapping[str, FloatArray]) -> FloatArray:
    """Return the corners of boxes around a link's collision shapes [m], shape [corner_count, 3]."""
    found = [np.zeros((0, 3))]
    for shape in link.collisions:
        ends = np.array([shape.vertices.min(axis=0), shape.vertices.max(axis=0)])
        found.append(ends[BOX, np.arange(3)])
    pose = poses[link.name]
    return np.vstack(found) @ pose[:3, :3].T + pose[:3, 3]


def _swept(
    joint: JointLine, limits: tuple[float, float], pose: FloatArray, points: FloatArray
) -> FloatArray:
    """Return the box around points over a joint's range [m], shape [2, 3].

    Args:
        joint: which moves them.
        limits: its range [rad] or [m].
        pose: of the joint's child at the lower limit, shape [4, 4].
        points: where they are at the lower limit [m], shape [point_count, 3].
    """
    if len(points) == 0:
        return np.array([np.full(3, np.inf), np.full(3, -np.inf)])
    length = limits[1] - limits[0]
    path = Path(joint.kind != "prismatic", pose[:3, 3], pose[:3, :3] @ unit_axis(joint), length)
    boxes = path.orbit(points).swept_bounds(np.linspace(0.0, length, STEPS + 1))
    return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])


def _are_apart(box: FloatArray, group: Mapping[str, FloatArray]) -> bool:
    """Tell whether a box, shape [2, 3], stays clear of all those of a group."""
    others = np.array(list(group.values()))
    clear = (box[0] - others[:, 1] > MARGIN_M) | (others[:, 0] - box[1] > MARGIN_M)
    return bool(clear.any(axis=1).all())
