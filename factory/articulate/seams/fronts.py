"""The panels of one side, and which side is the front."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.crossings import Side
from ...mesh import FloatArray, IntArray, Mesh
from .evidence import Seams, level_seams, upright_seams
from .handles import Face, cleared
from .panels import FrontPanel, FrontScene, choose
from .rectangles import SHORTEST, lines_of, rectangles_of
from .relief import Relief, relief_of

AROUND = (Side.FRONT, Side.RIGHT, Side.BACK, Side.LEFT)
OPPOSITE = {
    Side.FRONT: Side.BACK,
    Side.BACK: Side.FRONT,
    Side.LEFT: Side.RIGHT,
    Side.RIGHT: Side.LEFT,
}


@dataclass(frozen=True)
class Front:
    """What was read of one side.

    Attributes:
        relief: the side.
        face: it without handles.
        level: evidence for horizontal seams.
        panels: what opens there.
    """

    relief: Relief
    face: Face
    level: Seams
    panels: tuple[FrontPanel, ...]

    @property
    def value(self) -> float:
        """What speaks for this side being the front."""
        return sum(panel.value for panel in self.panels)


def fronts_of(mesh: Mesh, pieces: IntArray | None = None) -> dict[Side, Front]:
    """The four sides of a mesh (metres, z up), each read for panels.

    Args:
        mesh: metres, z up.
        pieces: that it is made of, by face; one by default.
    """
    reliefs = {side: relief_of(mesh, side, pieces) for side in AROUND}
    faces = {side: cleared(relief) for side, relief in reliefs.items()}
    return {
        side: _front(
            reliefs[side],
            faces[side].without_mirrored(faces[OPPOSITE[side]]),
            reliefs[OPPOSITE[side]],
        )
        for side in AROUND
    }


def _front(relief: Relief, face: Face, behind: Relief) -> Front:
    first_row, last_row, first_column, last_column = relief.box
    level = level_seams(relief, face)
    rows = lines_of(level, first_row, last_row)
    columns = lines_of(upright_seams(relief, face).turned(), first_column, last_column)
    shortest = SHORTEST * min(last_row - first_row, last_column - first_column)
    found = rectangles_of(rows, columns, shortest)
    scene = FrontScene(relief, face, thickness(relief, behind), rows, columns)
    return Front(relief, face, level, choose(scene, found))


def thickness(relief: Relief, behind: Relief) -> FloatArray:
    """How much lies between what is seen from a side and from its opposite [pixels]."""
    depth = float(relief.depth) / relief.raster.pixel
    return np.asarray(depth + relief.height + behind.height[:, ::-1])
