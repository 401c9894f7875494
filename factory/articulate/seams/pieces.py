"""The pieces of a mesh, seen from a side, and those that a panel there is made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import BoolArray, FloatArray
from ...part import OpensBy, Panel
from ...views.raster import Side
from ...views.view import View, Views

#: A piece belongs to a panel if so much of its outline lies there.
WHOLE = 0.9
#: Pieces that are the panel's own show so much of it.
OWN = 0.6
#: What slides may reach so far back, what turns only so far, as shares of the object's depth.
DEEPEST = {True: 0.97, False: 0.5}


@dataclass(frozen=True, eq=False)
class PieceOutlines:
    """Boxes of a mesh's pieces and their visible pixels, in one side's frame.

    Attributes:
        view: of the side; its parts are the pieces.
        low, high: of each piece [m], shape [piece_count, 3].
    """

    view: View
    low: FloatArray
    high: FloatArray

    @property
    def ends(self) -> FloatArray:
        """Return both ends of each piece's box [m], shape [2, piece_count, 3]."""
        return np.stack([self.low, self.high])

    @property
    def deep(self) -> FloatArray:
        """Return how deep each piece is [m], shape [piece_count]."""
        return np.asarray(self.high[:, 2] - self.low[:, 2])

    @property
    def depth(self) -> float:
        """Return how deep all of the mesh is [m]."""
        return float(self.high[:, 2].max() - self.low[:, 2].min())

    @classmethod
    def of(cls, views: Views, side: Side) -> PieceOutlines:
        """Look from a side at a mesh [m] whose parts are its pieces."""
        mesh = views.mesh
        pieces = views.owner
        view = views[side]
        local = mesh.vertices @ side.frame.T
        count = int(pieces.max()) + 1
        low = np.full((count, 3), np.inf)
        high = np.full((count, 3), -np.inf)
        for corner in range(3):
            np.minimum.at(low, pieces, local[mesh.faces[:, corner]])
            np.maximum.at(high, pieces, local[mesh.faces[:, corner]])
        return cls(view, low, high)

    def within(self, low: FloatArray, high: FloatArray) -> FloatArray:
        """Return the share of each piece's outline within a rectangle [m], shape [piece_count]."""
        size = np.maximum(self.high[:, :2] - self.low[:, :2], 1e-9)
        common = np.minimum(self.high[:, :2], high) - np.maximum(self.low[:, :2], low)
        return np.asarray((np.clip(common, 0.0, None) / size).clip(0.0, 1.0).prod(axis=1))

    def set_in(self, pieces: BoolArray, *, together: bool) -> BoolArray:
        """Return some pieces with those within the box of one: panes, bottoms of drawers.

        What lies on a box is not within it: the ceiling that a drawer slides under.

        Args:
            pieces: shape [piece_count].
            together: whether those count as well that are within the box of all: between bars.

        Returns:
            Shape [piece_count].
        """
        found = pieces.copy()
        pixel = self.view.raster.pixel
        boxes = [self.ends[:, piece] for piece in np.flatnonzero(pieces)]
        if together and boxes:
            boxes.append(np.stack([self.low[pieces].min(axis=0), self.high[pieces].max(axis=0)]))
        for low, high in boxes:
            within = (self.low >= low - pixel) & (self.high <= high + pixel)
            found |= within.all(axis=1) & (self.low[:, 1] < high[1] - pixel)
        return found

    def meeting(self, pieces: BoolArray) -> BoolArray:
        """Return which pieces' boxes meet the box of one of some, shape [piece_count]."""
        below = self.low[:, None] <= self.high[pieces]
        above = self.high[:, None] >= self.low[pieces]
        return np.asarray(np.all(below & above, axis=2).any(axis=1))

    def around(self, piece: int) -> BoolArray:
        """Return which pieces one is set in by its outline: its frame, shape [piece_count]."""
        low = self.low[:, :2]
        high = self.high[:, :2]
        holds = ((low <= low[piece]) & (high >= high[piece])).all(axis=1)
        return np.asarray(holds & (self.within(low[piece], high[piece]) < WHOLE))

    def shown(self, low: FloatArray, high: FloatArray) -> FloatArray:
        """Return the share of a rectangle [m] that shows each piece, shape [piece_count]."""
        seen = self.view.part[self.view.raster.window(low, high)]
        counts = np.bincount(seen[seen >= 0], minlength=len(self.low))
        return np.asarray(counts / max(seen.size, 1))


def own_pieces(outlines: PieceOutlines, panel: Panel, margin: float) -> BoolArray:
    """Return which pieces may belong to a panel, shape [piece_count].

    Args:
        outlines: of the side.
        panel: on it.
        margin: by which they may reach beyond its rectangle [m].
    """
    inside_it = outlines.within(panel.low - margin, panel.high + margin) >= WHOLE
    begins = outlines.low[:, 2] <= panel.front + (panel.thickness or 0.0)
    share = DEEPEST[panel.opens is OpensBy.OUT]
    shallow = outlines.deep <= share * outlines.depth
    # A door in its frame is as deep as all of it.
    leaf = outlines.deep <= share * float(panel.size.min())
    for piece in np.flatnonzero(inside_it & begins & leaf & ~shallow):
        shallow[piece] = outlines.around(int(piece)).any()
    return np.asarray(inside_it & begins & shallow)
