"""A mesh with its sides: what stated parts are looked for on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...articulation import rotation_about
from ...geometry.components import connected_components
from ...geometry.posing import UP
from ...mesh import FloatArray, Mesh
from ...views.raster import Side
from ...views.view import Views
from ..geometric.rounds import FROM_ABOVE
from ..seams.fronts import Front, fronts_of
from ..seams.pieces import PieceOutlines

#: Quarter turns about z that bring a stated front to -Y.
_TURNS: Mapping[str, int] = {"-y": 0, "-x": 1, "y": 2, "x": 3}


@dataclass(frozen=True, eq=False)
class SeenMesh:
    """A mesh with its sides, to be kept by who changes the boxes on them.

    Attributes:
        mesh: whose front is -Y.
        back: rotation of the mesh to where its front was stated to be, shape [3, 3].
    """

    mesh: Mesh
    back: FloatArray

    @classmethod
    def of(cls, mesh: Mesh, front: str = "-y") -> SeenMesh:
        """Return a mesh turned so that a stated front is -Y."""
        turn = rotation_about(UP, _TURNS[front] * np.pi / 2.0)
        return cls(mesh.turned(turn), turn.T)

    @cached_property
    def views(self) -> Views:
        """Return its sides; their parts are the pieces that it is made of."""
        return Views(self.mesh, connected_components(self.mesh))

    @cached_property
    def around(self) -> dict[Side, Front]:
        """Return its upright sides."""
        return fronts_of(self.views)

    @cached_property
    def above(self) -> dict[Side, Front]:
        """Return the sides of the mesh turned so that its top is its front."""
        return fronts_of(Views(self.mesh.turned(FROM_ABOVE)))

    @cached_property
    def _outlines(self) -> dict[Side, PieceOutlines]:
        return {}

    def outlines(self, side: Side) -> PieceOutlines:
        """Return what one side shows of its pieces."""
        if side not in self._outlines:
            self._outlines[side] = PieceOutlines.of(self.views, side)
        return self._outlines[side]

    def look(self) -> None:
        """Look at its upright sides now."""
        for front in self.around.values():
            _ = front.pulls
