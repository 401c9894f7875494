"""What the network says about one cloud of points, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from enum import IntEnum

import numpy as np

from ...mesh import Float32Array, read_only


class MotionClass(IntEnum):
    """How a part moves relative to its parent: the columns of the motion logits."""

    FIXED = 0
    REVOLUTE = 1
    PRISMATIC = 2
    BOTH = 3

    @property
    def turns(self) -> bool:
        """Return whether the part turns about an axis."""
        return self in (MotionClass.REVOLUTE, MotionClass.BOTH)

    @property
    def slides(self) -> bool:
        """Return whether the part slides along a direction."""
        return self in (MotionClass.PRISMATIC, MotionClass.BOTH)


@dataclass(frozen=True)
class Prediction:
    """The network's answer for one cloud: logits and regressed numbers, nothing decided yet.

    Lengths are in the network's frame, in which the cloud's box has the longest side 1 and its
    centre at the origin, z up. Joint value 0 is the pose in which the cloud was given.

    Attributes:
        mask_logits: which part a point belongs to, shape [point_count, part_count].
        hierarchy_logits: whether the row's part is the parent of the column's, shape [part_count,
            part_count].
        motion_logits: see :class:`MotionClass`, shape [part_count, 4].
        revolute_direction: of the axis, not normalised, shape [part_count, 3].
        revolute_range: lowest and highest turn by the right-hand rule [rad], shape [part_count, 2].
        prismatic_direction: of the slide, not normalised, shape [part_count, 3].
        prismatic_range: lowest and highest slide, shape [part_count, 2].
        closest_points: the nearest point on the axis of each point's part, shape [point_count, 3];
            ``None`` for the networks that give the axis by its moment instead.
        revolute_moment: direction x point on the axis, in this order, not normalised, shape
            [part_count, 3]; ``None`` for the networks that give closest points.
    """

    mask_logits: Float32Array
    hierarchy_logits: Float32Array
    motion_logits: Float32Array
    revolute_direction: Float32Array
    revolute_range: Float32Array
    prismatic_direction: Float32Array
    prismatic_range: Float32Array
    closest_points: Float32Array | None = field(default=None, repr=False)
    revolute_moment: Float32Array | None = None

    def __post_init__(self) -> None:
        parts = np.shape(self.mask_logits)[-1]
        shapes = {
            "mask_logits": (len(self.mask_logits), parts),
            "hierarchy_logits": (parts, parts),
            "motion_logits": (parts, len(MotionClass)),
            "revolute_direction": (parts, 3),
            "revolute_range": (parts, 2),
            "prismatic_direction": (parts, 3),
            "prismatic_range": (parts, 2),
            "closest_points": (len(self.mask_logits), 3),
            "revolute_moment": (parts, 3),
        }
        for each in fields(self):
            value = getattr(self, each.name)
            if value is None:
                continue
            array = read_only(value, np.float32)
            if array.shape != shapes[each.name]:
                raise ValueError(f"{each.name}: shape {array.shape}, want {shapes[each.name]}")
            object.__setattr__(self, each.name, array)
        if (self.closest_points is None) == (self.revolute_moment is None):
            raise ValueError("the axes need either closest_points or revolute_moment")

    @property
    def part_count(self) -> int:
        """Return how many parts there can be."""
        return int(self.mask_logits.shape[1])
