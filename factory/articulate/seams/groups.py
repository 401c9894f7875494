"""Panels of a front, alone or several at once, and which of them can be there together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

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
        """The one that it is pulled by."""
        return self.handles[0] if self.handles else None

    @property
    def aspect(self) -> float:
        """Width over height."""
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
        """Of all of them, as if each were independent."""
        return sum(panel.value for panel in self.panels)


def apart(one: Rectangle, other: Rectangle) -> bool:
    """Whether two rectangles may both be panels."""
    return one.shared(other) <= OVERLAP * min(one.area, other.area)


def together(groups: Sequence[Group]) -> list[Group]:
    """The set without overlaps that is worth most: greedy, then exchanges that gain."""
    chosen: list[Group] = []
    for _ in range(3):
        changed = False
        for group in groups:
            if group in chosen:
                continue
            against = [g for g in chosen if not apart(group.rectangle, g.rectangle)]
            if group.value > sum(g.value for g in against) + 1e-9:
                chosen = [g for g in chosen if g not in against] + [group]
                changed = True
        if not changed:
            break
    return chosen
