"""Names of parts and joints, as every articulator gives them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from ..articulation import JointKind

#: What follows a part's name in its joint's.
JOINT_SUFFIX: Mapping[JointKind, str] = MappingProxyType(
    {
        JointKind.PRISMATIC: "slide",
        JointKind.REVOLUTE: "hinge",
        JointKind.CONTINUOUS: "turn",
    }
)


def numbered(labels: Iterable[str]) -> list[str]:
    """Return each label with its number among those alike: ``door_0``, ``door_1``, ``lid_0``."""
    count: Counter[str] = Counter()
    names = []
    for label in labels:
        names.append(f"{label}_{count[label]}")
        count[label] += 1
    return names
