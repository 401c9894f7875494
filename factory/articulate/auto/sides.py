"""Meshes of several pieces, read from their sides: which pieces, or parts of pieces, open there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.triangles import face_areas
from ...mesh import BoolArray, FloatArray, IntArray, Mesh
from ...part import OpensBy, Panel
from ...views.crossings import Crossings, crossings
from ...views.raster import Side
from ...views.view import View, Views
from ..proposal import Proposal
from ..seams.cutting import CutMesh, cut_around, inside, uncut
from ..seams.hypotheses import hypotheses_of_views
from ..seams.placing import OpeningPart
from .partition import INSIDE
from .trust import log_odds

#: A piece belongs to a panel if so much of its outline lies there, give or take [pixels].
WHOLE = 0.9
MARGIN = 2.0
#: Pieces that are the panel's own show so much of it; else it is cut out of those that show at
#: least so much.
OWN = 0.6
LEAST_SHOWN = 0.02
#: What a panel is cut out of is filled to this share behind it.
FILLED = 0.8
#: Two faces of a sheet are no further apart than this [pixels].
SHEET = 0.01
#: The object is so deep, as a share of the panel's shorter side: no house door, no lone front.
DEEP = 0.3
#: What slides may reach so far back, what turns only so far, as shares of the object's depth.
DEEPEST = {True: 0.97, False: 0.5}
#: Probability below which what a side shows is left fixed.
SURE_SIGHT = 0.45
#: Panels line up if their edges differ by no more than this share of the mesh's size.
IN_LINE = 0.03
#: A panel takes at most this share of a mesh's area.
MOST = 0.7


@dataclass(frozen=True, eq=False)
class Sightings:
    """What the sides show, by one hypothesis.

    Attributes:
        cut: the mesh; triangles are divided only where a panel is a part of a piece.
        pieces: of every face of the cut mesh, shape [face_count].
        found: what opens, over the cut mesh.
        views: of the cut mesh.
    """

    cut: CutMesh
    pieces: IntArray
    found: tuple[Proposal, ...]
    views: Views

    @property
    def mesh(self) -> Mesh:
        """Return the mesh that the proposals are about."""
        return self.cut.mesh

    def carried(self, proposals: Sequence[Proposal]) -> tuple[Proposal, ...]:
        """Return the proposals about the uncut mesh as ones about the cut one."""
        return tuple(replace(each, faces=each.faces[self.cut.source]) for each in proposals)

    def beyond(self, proposals: Sequence[Proposal], known: Sequence[BoolArray]) -> list[Proposal]:
        """Return the proposals that lie in nothing known to move, as a drawer's front does.

        Args:
            proposals: over the cut mesh.
            known: faces of the uncut mesh, shape [face_count] each.
        """
        areas = face_areas(self.mesh)
        moving = [faces[self.cut.source] for faces in known]
        return [
            each
            for each in proposals
            if not any(
                areas[each.faces & faces].sum() > INSIDE * areas[each.faces].sum()
                for faces in moving
            )
        ]

    def beside(self, proposals: Sequence[Proposal], known: Sequence[BoolArray]) -> list[Proposal]:
        """Return proposals of whole pieces that are in a row or column with what is known to move.

        Who models one front as a piece models each so. Of 16 parts of pieces seen on objects of
        the develop half where rules of shape are sure of something, none was right; of 43 whole
        pieces 23 were.

        Args:
            proposals: over the cut mesh.
            known: faces of the uncut mesh, shape [face_count] each.
        """
        boxes = [self._box(faces[self.cut.source]) for faces in known]
        reach = IN_LINE * self.mesh.extents
        return [
            each
            for each in proposals
            if self._is_whole(each.faces)
            and any(_in_line(self._box(each.faces), box, reach) for box in boxes)
        ]

    def _is_whole(self, faces: BoolArray) -> bool:
        return bool((np.isin(self.pieces, self.pieces[faces]) == faces).all())

    def _box(self, faces: BoolArray) -> FloatArray:
        points = self.mesh.vertices[self.mesh.faces[faces].ravel()]
        return np.stack([points.min(axis=0), points.max(axis=0)])


def _in_line(one: FloatArray, other: FloatArray, reach: FloatArray) -> bool:
    """Return whether two boxes, shape [2, 3], lie next to each other and line up across that."""
    gap = np.maximum(one[0] - other[1], other[0] - one[1])
    apart = int(gap.argmax())
    across = [axis for axis in range(3) if axis != apart]
    ends = np.abs(one - other) <= reach
    level = any(ends[:, axis].all() for axis in across) and all(
        ends[:, axis].any() for axis in across
    )
    return bool(level and -reach[apart] <= gap[apart] <= 2.0 * reach[apart])


def sightings(views: Views) -> tuple[Sightings, ...]:
    """Return what the sides of a mesh of several pieces show, the likeliest hypothesis first.

    Args:
        views: of the mesh (metres, z up), whose parts are its pieces.
    """
    panels = [
        [seen for mover in movers if (seen := _SidePanel.of(mover)) is not None]
        for movers in hypotheses_of_views(views)
    ]
    sides = {each.side for some in panels for each in some}
    outlines = {side: _Outlines.of(views, side) for side in sides}
    return tuple(_sighted(views, outlines, some) for some in panels)


@dataclass(frozen=True, eq=False)
class _SidePanel:
    """A part that is a panel of a side."""

    mover: OpeningPart
    panel: Panel
    side: Side

    @classmethod
    def of(cls, mover: OpeningPart) -> _SidePanel | None:
        """Return a part with its panel and side; ``None`` of others, or on a mesh askew."""
        panel = mover.panel
        if panel is None:
            return None
        sides = [side for side in Side if np.allclose(side.frame[2], panel.frame[2])]
        return cls(mover, panel, sides[0]) if sides else None


def _sighted(
    views: Views, outlines: Mapping[Side, _Outlines], panels: Sequence[_SidePanel]
) -> Sightings:
    pieces = views.owner
    owners = [_panel_pieces(outlines[each.side], each.panel) for each in panels]
    cut = uncut(views.mesh)
    for each, (own, whole) in zip(panels, owners, strict=True):
        if len(own) and not whole:
            cut = cut_around(cut, each.mover.region)
    areas = face_areas(cut.mesh)
    found = []
    for each, (own, whole) in zip(panels, owners, strict=True):
        faces = np.isin(pieces[cut.source], own)
        if not whole:
            faces &= inside(cut.mesh, each.mover.region)
        if faces.any() and areas[faces].sum() <= MOST * areas.sum():
            found.append(_proposal(each.mover, faces))
    seen = views if cut.mesh is views.mesh else Views(cut.mesh)
    return Sightings(cut, pieces[cut.source], tuple(found), seen)


def _proposal(mover: OpeningPart, faces: BoolArray) -> Proposal:
    signs = {
        "sides": 1.0,
        "shown": log_odds(mover.existence),
        "way": log_odds(mover.sure),
    }
    return replace(mover.proposal(faces), signs=signs)


@dataclass(frozen=True, eq=False)
class _Outlines:
    """Boxes of a mesh's pieces and what is seen of them, in one side's frame.

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

    @classmethod
    def of(cls, views: Views, side: Side) -> _Outlines:
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


def _panel_pieces(outlines: _Outlines, panel: Panel) -> tuple[IntArray, bool]:
    """Return the pieces that a panel is made of, and whether it is all of them.

    Where the pieces that lie within its rectangle are not what is seen of it, the panel is a part
    of those that are seen. Then the mesh must be solid there: who models an inside models doors.
    """
    low = panel.low
    high = panel.high
    shown = outlines.shown(low, high)
    depth = float(outlines.high[:, 2].max() - outlines.low[:, 2].min())
    nothing = np.zeros(0, dtype=np.int64)
    deep, filled = outlines.behind(low, high)
    if deep < DEEP * (high - low).min():
        return nothing, True
    margin = MARGIN * outlines.view.raster.pixel
    inside_it = outlines.within(low - margin, high + margin) >= WHOLE
    begins = outlines.low[:, 2] <= panel.front + (panel.thickness or 0.0)
    slides = panel.opens is OpensBy.OUT
    shallow = outlines.high[:, 2] - outlines.low[:, 2] <= DEEPEST[slides] * depth
    own = inside_it & begins & shallow
    if shown[own].sum() >= OWN:
        return np.flatnonzero(own), True
    if filled < FILLED:
        return nothing, False
    return np.flatnonzero(shown >= LEAST_SHOWN), False
