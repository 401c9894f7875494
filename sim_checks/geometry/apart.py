"""Which joints cannot reach one another, so that a simulator may drive them at the same time."""

from __future__ import annotations

import numpy as np

from ..description import Description, FloatArray
from .kinematics import find_tree
from .path import joint_axis
from .placing import box_around, boxes_near, placed, shape_corners

#: What two joints of a group move stays further apart than this [m]; engines keep margins of up to
#: 2 mm around shapes.
MARGIN_M = 0.005
#: The box around nothing, which is apart from all.
NOWHERE = np.array([np.full(3, np.inf), np.full(3, -np.inf)])


def joints_apart(description: Description) -> tuple[tuple[str, ...], ...]:
    """Return groups of joints whose links stay apart, each over its whole range.

    Left out are joints that move with others, that carry other joints or that have no range, and
    groups of one joint alone.
    """
    tree = find_tree(description)
    if tree is None:
        return ()
    poses = tree.link_poses(tree.closed)
    shapes = ((link.name, shape_corners(link.collisions)) for link in description.links)
    corners = {name: placed(points, poses[name]) for name, points in shapes}
    groups: list[dict[str, FloatArray]] = []
    for joint in tree.free:
        links = tree.below(joint)
        carries = any(other.parent in links for other in tree.moving)
        if joint.name not in tree.ranges or tree.followers(joint) or carries:
            continue
        points = np.vstack([corners[name] for name in sorted(links)])
        lower, upper = tree.ranges[joint.name]
        path = joint_axis(joint, poses[joint.child]).path(upper - lower)
        box = box_around([path.swept_boxes(points)]) if len(points) else NOWHERE
        standing = (np.array(list(each.values())) for each in groups)
        near = (bool(boxes_near(box[None], boxes, MARGIN_M).any()) for boxes in standing)
        group = next((each for each, meets in zip(groups, near, strict=True) if not meets), None)
        if group is None:
            groups.append({joint.name: box})
        else:
            group[joint.name] = box
    return tuple(tuple(group) for group in groups if len(group) > 1)
