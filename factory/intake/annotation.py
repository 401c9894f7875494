"""Parts and joints as somebody wrote them down, before they are made into a valid tree."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.sim_checks.description import Mimic

from ..mesh import FloatArray, IntArray, read_only


@dataclass(frozen=True)
class AnnotatedJoint:
    """A joint in the input's frame and units, as annotated: nothing is checked or normalised yet.

    Attributes:
        name: as in the annotation.
        kind: ``fixed``, ``revolute``, ``continuous``, ``prismatic`` or ``both`` (turns, then
            slides).
        parent, child: part ids.
        axis: direction at the annotated rest pose, any length, shape [3].
        origin: a point on the axis, shape [3].
        lower, upper: [rad] or [input length units]; ``None`` where there is no limit.
        slide_axis, slide_lower, slide_upper: of the second joint of ``both``.
        damping, friction: as annotated, SI; ``None`` where absent.
        mimic: the joint that it follows, by name, in the units of both; ``None`` for none.
    """

    name: str
    kind: str
    parent: int
    child: int
    axis: FloatArray
    origin: FloatArray
    lower: float | None
    upper: float | None
    slide_axis: FloatArray | None = None
    slide_lower: float | None = None
    slide_upper: float | None = None
    damping: float | None = None
    friction: float | None = None
    mimic: Mimic | None = None


@dataclass(frozen=True)
class Annotation:
    """Which face belongs to which part, and how parts are jointed.

    Attributes:
        face_part: part id per face of the *input*, in its own order, shape [input_face_count].
        part_names: indexed by part id; a part may own no face.
        joints: in any order; may be a forest, or not even that.
        source: ``urdf``, ``mjcf``, ``usd`` or ``pred.npz``.
    """

    face_part: IntArray
    part_names: tuple[str, ...]
    joints: tuple[AnnotatedJoint, ...]
    source: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "face_part", read_only(self.face_part, np.int64))
