"""Panels of a front, alone or several at once, and which of them can be there together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

from .handles import Protrusion
from .rectangles import Rectangle

#: Two panels may share this much of the smaller one.
OVERLAP = 0.08


@dataclass(frozen=True, eq=False)
class FrontPanel:
    """A rectangle that opens.

    Attributes:
        rectangle: where it is.
        handles: its pulls, the most prominent first.
        value: what speaks for it: grows with evidence, no probability.
        cut: its border is half-way between handles; nobody saw a seam there.
    """

    rectangle: Rectangle
    handles: tuple[Protrusion, ...]
    value: float
    cut: bool = False

    @property
    def handle(self) -> Protrusion | None:
        """Return the one that it is pulled by."""
        return self.handles[0] if self.handles else None

    @property
    def aspect(self) -> float:
        """Return the width over height."""
        return float(self.rectangle.size[1] / max(self.rectangle.size[0], 1))


@dataclass(frozen=True, eq=False)
class Group:
    """Panels that are there together or not at all.

    Attributes:
        rectangle: around them.
        panels: one, or the pieces of the rectangle.
    """

    rectangle: Rectangle
    panels: tuple[FrontPanel, ...]

    @property
    def value(self) -> float:
        """Add the panels' values, as if each were independent."""
        return sum(panel.value for panel in self.panels)


def apart(one: Rectangle, other: Rectangle) -> bool:
    """Return whether two rectangles may both be panels."""
    return one.shared(other) <= OVERLAP * min(one.area, other.area)


Placed = TypeVar("Placed", FrontPanel, Group)


def clear_of(some: Sequence[Placed], others: Sequence[FrontPanel]) -> list[Placed]:
    """Return those that overlap none of the others."""
    return [
        each for each in some if all(apart(each.rectangle, other.rectangle) for other in others)
    ]


def together(groups: Sequence[Group]) -> list[Group]:
    """Return the set without overlaps that is worth most, of those that start with any one group.

    To each start the others are added in order of their value, if nothing is in their way.
    """
    ordered = sorted(groups, key=lambda group: -group.value)
    clear = [[apart(one.rectangle, other.rectangle) for other in ordered] for one in ordered]
    best: list[int] = []
    most = 0.0
    for start in range(len(ordered)):
        chosen = [start]
        for index, group in enumerate(ordered):
            if group.value > 0.0 and all(clear[index][other] for other in chosen):
                chosen.append(index)
        worth = sum(ordered[index].value for index in chosen)
        if worth > most + 1e-9:
            best = chosen
            most = worth
    return [ordered[index] for index in sorted(best)]
