"""Stated parts of meshes of several pieces: the pieces that they are made of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import JointKind
from ...geometry.triangles import face_areas
from ...mesh import FloatArray
from ...part import OpensBy, Panel, PartKind
from ...views.raster import Side, side_facing
from ...views.view import Views
from ..seams.cutting import Region, inside
from ..seams.pieces import DEEPEST, OWN, WHOLE, PieceOutlines, own_pieces
from ..seams.placing import OpeningPart
from .boxed import StatedBox, StatedWay
from .seen import SeenMesh
from .snapping import OFF

#: A piece with so much of its surface above a lid's seam is the lid's.
ABOVE = 0.7
#: What is turned shows so much of its box, as the pieces that it is made of: a star in a square.
TURNED = 0.25
LEAST_SHOWN = 0.01


def way_of(seen: SeenMesh, mover: OpeningPart, part: StatedBox) -> StatedWay:
    """Return a part with the pieces that it is made of, if it is some pieces."""
    outlines = seen.outlines(part.view.side)
    low, high = part.corners
    shown = outlines.shown(low, high)
    enough = OWN
    margin = OFF / 2.0 * float((high - low).max())
    if mover.panel is not None:
        # What hangs in the air before a panel is another part's: a cistern's lever.
        own = own_pieces(outlines, mover.panel, margin)
        on_it = outlines.high[:, 2] >= mover.panel.front - margin
        own &= on_it | outlines.meeting(own & on_it)
        leaves = own & (shown >= OWN)
        own = outlines.set_in(own, together=not leaves.any())
        for leaf in np.flatnonzero(leaves).tolist():
            if _shows_its_back(seen, outlines, leaf):
                # A door between two rooms has handles on either side.
                own |= outlines.within(*outlines.ends[:, leaf, :2]) >= WHOLE
            own &= ~outlines.around(leaf)
    elif part.is_panel or mover.kind is PartKind.SCREEN:
        own = _share_within(seen.views, mover.region) >= ABOVE
    else:
        own = outlines.within(low - margin, high + margin) >= WHOLE
        own &= outlines.deep <= DEEPEST[False] * outlines.depth
        own &= shown >= LEAST_SHOWN
        enough = TURNED
    if part.stated.also:
        own &= _share_within(seen.views, mover.region) >= ABOVE
    if shown[own].sum() < enough or own.all():
        return StatedWay(mover)
    low = outlines.low[own].min(axis=0)
    high = outlines.high[own].max(axis=0)
    panel = mover.panel
    if panel is not None and np.allclose(panel.frame, part.view.side.frame):
        mover = _hung_at(mover, panel, low[:2], high[:2])
    if part.stated.range is None and mover.motion.kind is JointKind.PRISMATIC:
        mover = _in_its_rails(mover, float(high[2]))
    return StatedWay(mover, np.flatnonzero(own[seen.views.owner]))


def _shows_its_back(seen: SeenMesh, outlines: PieceOutlines, piece: int) -> bool:
    """Tell whether a piece that is seen from one side is seen from behind as well."""
    side = outlines.view.side
    behind = seen.outlines(side_facing(side.frame[2]))
    ends = (outlines.ends[:, piece] @ side.frame @ behind.view.side.frame.T)[:, :2]
    return bool(behind.shown(ends.min(axis=0), ends.max(axis=0))[piece] >= OWN)


def find_outline(
    seen: SeenMesh, side: Side, corners: FloatArray, reach: FloatArray
) -> FloatArray | None:
    """Return the outline of the piece that a rectangle means, low and high [m], shape [2, 2].

    Args:
        seen: the mesh.
        side: that is looked at.
        corners: of the rectangle: right and up [m], low and high, shape [2, 2].
        reach: how far each edge may be off [m], right and up, shape [2].

    Returns:
        ``None`` where no piece has such an outline, or there is but one piece.
    """
    if not seen.views.owner.any():
        return None
    outlines = seen.outlines(side)
    boxes = outlines.ends[..., :2].swapaxes(0, 1)
    off = (np.abs(boxes - corners) / reach).max(axis=(1, 2))
    # What ends where all of the mesh does is its body, or found by that outline.
    whole = np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
    part = np.abs(boxes - whole).max(axis=(1, 2)) > outlines.view.raster.pixel
    off = np.where(part & (outlines.shown(*corners) >= OWN), off, np.inf)
    best = int(off.argmin())
    return np.asarray(boxes[best]) if off[best] <= 1.0 else None


def _share_within(views: Views, region: Region) -> FloatArray:
    """Return the share of each piece's surface in a region, shape [piece_count]."""
    within = inside(views.mesh, region)
    areas = face_areas(views.mesh)
    whole = np.bincount(views.owner, weights=areas)
    inner = np.bincount(views.owner, weights=areas * within, minlength=len(whole))
    return np.asarray(inner / np.maximum(whole, 1e-12))


def _hung_at(mover: OpeningPart, panel: Panel, low: FloatArray, high: FloatArray) -> OpeningPart:
    """Return a panel in the outline [m] of its pieces, hinged there: a stated box may be off."""
    (left, bottom), (right, top) = off = np.array([low - panel.low, high - panel.high])
    if np.abs(off).max() > 2.0 * OFF * panel.size.max():
        return mover
    edge = {
        OpensBy.LEFT: left * panel.frame[0],
        OpensBy.RIGHT: right * panel.frame[0],
        OpensBy.TOP: top * panel.frame[1],
        OpensBy.BOTTOM: bottom * panel.frame[1],
    }.get(panel.opens, np.zeros(3))
    motion = replace(mover.motion, origin=mover.motion.origin + edge)
    return replace(mover, motion=motion, panel=replace(panel, low=low, high=high))


def _in_its_rails(mover: OpeningPart, back: float) -> OpeningPart:
    """Return a drawer with its box, which ends at ``back`` [m], sliding no further than that."""
    panel = mover.panel
    if panel is None or not panel.has_box(back):
        return mover
    upper = min(mover.motion.upper, back - panel.front)
    return replace(mover, motion=replace(mover.motion, upper=upper))
