"""The published code's loose arrays as clouds."""

import numpy as np

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.intake.importers.prediction import point_on_line
from asset_factory.learn.evaluate.published.cloud import ScoredCloud


def cloud_from(arrays, side):
    """Of the ``gt`` or the ``pred`` arrays of one fixture."""

    def get(name):
        return arrays[f"{side}_{name}"]

    count = len(get("is_part_revolute"))
    parents = [-1] * count
    for parent, child in get("motion_hierarchy"):
        parents[child] = int(parent)
    joints = []
    for part in range(count):
        own = []
        # Turning first: the slide is along an axis that does not turn along.
        if get("is_part_prismatic")[part]:
            lower, upper = get("prismatic_range")[part]
            axis = get("prismatic_axis")[part]
            own.append(
                Joint(f"slide{part}", JointKind.PRISMATIC, 0, 0, axis, np.zeros(3), lower, upper)
            )
        if get("is_part_revolute")[part]:
            line = get("revolute_plucker")[part]
            axis = line[:3] / np.linalg.norm(line[:3])
            lower, upper = get("revolute_range")[part]
            origin = point_on_line(line[:3], line[3:])
            own.append(Joint(f"turn{part}", JointKind.REVOLUTE, 0, 0, axis, origin, lower, upper))
        joints.append(tuple(own))
    return ScoredCloud(get("points"), get("part_ids"), tuple(parents), tuple(joints))
