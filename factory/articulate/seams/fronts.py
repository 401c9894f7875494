"""The panels of one side, and which side is the front."""

from __future__ import annotations

from dataclasses import dataclass

from ...geometry.crossings import Side
from ...mesh import Mesh
from .evidence import level_seams, upright_seams
from .handles import Face, cleared
from .panels import Panel, choose
from .rectangles import SHORTEST, lines_of, rectangles_of
from .relief import Relief, relief_of


@dataclass(frozen=True)
class Front:
    """What was read of one side.

    Attributes:
        relief: the side.
        face: it without handles.
        panels: what opens there.
    """

    relief: Relief
    face: Face
    panels: tuple[Panel, ...]

    @property
    def value(self) -> float:
        """What speaks for this side being the front."""
        return sum(panel.value for panel in self.panels)


def front_of(mesh: Mesh, side: Side) -> Front:
    """Read one side of a mesh."""
    relief = relief_of(mesh, side)
    face = cleared(relief)
    first_row, last_row, first_column, last_column = relief.box
    level = lines_of(level_seams(relief, face), first_row, last_row)
    upright = lines_of(upright_seams(relief, face).turned(), first_column, last_column)
    shortest = SHORTEST * min(last_row - first_row, last_column - first_column)
    found = rectangles_of(level, upright, shortest)
    return Front(relief, face, choose(relief, face, found))
