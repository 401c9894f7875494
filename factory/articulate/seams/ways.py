"""The ways in which a panel may open."""

from enum import StrEnum


class OpensBy(StrEnum):
    """How a panel opens, as the viewer sees it: the edge of its hinge, or outwards."""

    LEFT = "left"
    RIGHT = "right"
    BOTTOM = "bottom"
    TOP = "top"
    OUT = "out"
