"""The pieces of a mesh, seen from a side, and those that a panel there is made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import BoolArray, FloatArray
from ...part import OpensBy, Panel
from ...views.crossings import Crossings, crossings
from ...views.raster import Side
from ...views.view import View, Views

#: A piece belongs to a panel if so much of its outline lies there.
WHOLE = 0.9
#: Pieces that are the panel's own show so much of it.
OWN = 0.6
#: Two faces of a sheet are no further apart than this [pixels].
SHEET = 0.01
#: What slides may reach so far back, what turns only so far, as shares of the object's depth.
DEEPEST = {True: 0.97, False: 0.5}


@dataclass(frozen=True, eq=False)
class PieceOutlines:
    """Boxes of a mesh's pieces and their visible pixels, in one side's frame.

    Attributes:
        view: of the side; its parts are the pieces.
        through: from the first surface to the last [m], shape [rows, columns].
        solid: share of that way that is inside of the mesh, shape [rows, columns].
        low, high: of each piece [m], shape [piece_count, 3].
    """

    view: View
    through: FloatArray
    solid: FloatArray
    low: FloatArray
    high: FloatArray

    @property
    def ends(self) -> FloatArray:
        """Return both ends of each piece's box [m], shape [2, piece_count, 3]."""
        return np.stack([self.low, self.high])

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
        return cls(view, *_through(crossings(mesh, view.raster)), low, high)

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

    def behind(self, low: FloatArray, high: FloatArray) -> tuple[float, float]:
        """Measure how deep the mesh is behind a rectangle [m], and how much of that is inside."""
        window = self.view.raster.window(low, high)
        seen = self.view.seen[window]
        if not seen.any():
            return 0.0, 0.0
        return float(np.median(self.through[window][seen])), float(
            np.median(self.solid[window][seen])
        )


def _through(crossed: Crossings) -> tuple[FloatArray, FloatArray]:
    """Return each ray's length from first to last crossing [m], and the share inside.

    Sheets of two faces, one each way, have no inside; the widest gap between two of them is one.
    """
    shape = (crossed.raster.rows, crossed.raster.columns)
    pixel = crossed.pixel
    turns = np.cumsum(np.where(crossed.inward, 1, -1))
    first = np.diff(pixel, prepend=-1) != 0
    before = np.concatenate([[0], turns[:-1]])[first]
    winding = turns - before[np.cumsum(first) - 1]
    same = np.diff(pixel, append=-1) == 0
    length = np.where(same, np.append(np.diff(crossed.depth), 0.0), 0.0)
    count = shape[0] * shape[1]
    whole = np.asarray(np.bincount(pixel, weights=length, minlength=count), dtype=np.float64)
    inner = np.bincount(pixel, weights=length * (winding > 0), minlength=count)
    thin = SHEET * crossed.raster.pixel
    twin = same & (length <= thin) & (crossed.inward != np.append(crossed.inward[1:], False))
    sheet = twin | np.append(False, twin[:-1])
    between = np.where(sheet & np.append(sheet[1:], False), length, 0.0)
    np.maximum.at(inner, pixel, between)
    share = np.divide(inner, whole, out=np.zeros(count), where=whole > 0.0)
    return np.asarray(whole.reshape(shape)), np.asarray(share.reshape(shape))


def own_pieces(outlines: PieceOutlines, panel: Panel, margin: float) -> BoolArray:
    """Return which pieces may belong to a panel, shape [piece_count].

    Args:
        outlines: of the side.
        panel: on it.
        margin: by which they may reach beyond its rectangle [m].
    """
    depth = float(outlines.high[:, 2].max() - outlines.low[:, 2].min())
    inside_it = outlines.within(panel.low - margin, panel.high + margin) >= WHOLE
    begins = outlines.low[:, 2] <= panel.front + (panel.thickness or 0.0)
    deep = outlines.high[:, 2] - outlines.low[:, 2]
    share = DEEPEST[panel.opens is OpensBy.OUT]
    shallow = deep <= share * depth
    # A door in its frame is as deep as all of it.
    leaf = deep <= share * float((panel.high - panel.low).min())
    for piece in np.flatnonzero(inside_it & begins & leaf & ~shallow):
        shallow[piece] = outlines.around(int(piece)).any()
    return np.asarray(inside_it & begins & shallow)
