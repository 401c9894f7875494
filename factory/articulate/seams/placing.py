"""Panels and lids from pictures to space: the region each one fills, and its joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...articulation import Articulation, JointKind
from ...mesh import FloatArray, Mesh
from ...part import OpensBy, Panel, PartKind, Proposer
from ...views.raster import Side
from ..assembly import assembled
from ..proposal import Motion, Proposal
from .cutting import Region, cut_along, inside
from .edges import leaf_thickness, thickness_behind
from .fronts import Front
from .rectangles import Rectangle

#: A panel's outer edge is looked at so far inside of its outline [pixels].
INSET = 4
#: How far a door, a flap or a lid turns [rad], and a drawer slides as a share of the depth behind.
TURN = 1.57
SLIDE = 0.8


@dataclass(frozen=True, eq=False)
class OpeningPart:
    """A part that may open and is not cut out yet, object frame [m].

    Attributes:
        kind: what it is; names the part.
        region: what it fills.
        motion: how it opens.
        panel: as in :class:`~asset_factory.factory.part.Part`; ``None`` for parts that are no panel
            of a side.
    """

    kind: PartKind
    region: Region
    motion: Motion
    panel: Panel | None = None

    def turned(self, rotation: FloatArray) -> OpeningPart:
        """Return the same of an object turned about the origin by ``rotation``, shape [3, 3]."""
        return replace(
            self,
            region=self.region.turned(rotation),
            motion=self.motion.turned(rotation),
            panel=None if self.panel is None else self.panel.turned(rotation),
        )


def cut_out(
    mesh: Mesh,
    parts: Sequence[OpeningPart],
    articulator: str,
    proposer: Proposer,
    probability: float,
) -> Articulation:
    """Return a mesh with parts cut out of it; each has the faces that no earlier one has, if any.

    Args:
        mesh: metres, z up.
        parts: that open.
        articulator: who is asked.
        proposer: who says that they open.
        probability: that one does, 0 to 1.
    """
    cut = cut_along(mesh, (part.region for part in parts)).mesh
    owner = np.zeros(len(cut.faces), dtype=np.int64)
    proposals: list[Proposal] = []
    for part in parts:
        own = inside(cut, part.region) & (owner == 0)
        if own.any():
            proposal = Proposal(
                part.kind,
                own,
                part.motion,
                proposer=proposer,
                existence=probability,
                probability=probability,
            )
            proposals.append(proposal)
            owner[own] = len(proposals)
    return assembled(cut, owner, proposals, articulator)


def box_behind(side: Side, low: FloatArray, high: FloatArray) -> Region:
    """Return all of a rectangle of one side, however deep, in that side's frame [m].

    Args:
        side: that is looked at.
        low: to the right and up, shape [2].
        high: likewise.
    """
    right, up, _ = side.frame
    offsets = np.array([high[0], -low[0], high[1], -low[1]])
    return Region(np.stack([right, -right, up, -up]), offsets)


def box_before(side: Side, low: FloatArray, high: FloatArray, back: float) -> Region:
    """Return what of :func:`box_behind` is before a depth, away from the viewer [m]."""
    before = Region(side.frame[2:], np.array([back]))
    return box_behind(side, low, high).within(before)


def edge_middle(low: FloatArray, high: FloatArray, way: OpensBy) -> FloatArray:
    """Return the middle of the edge at which a rectangle is hinged, or of all of it.

    Args:
        low: to the right and up [m], shape [2].
        high: likewise.
        way: how it opens.
    """
    middle = (low + high) / 2.0
    places = {
        OpensBy.LEFT: (low[0], middle[1]),
        OpensBy.RIGHT: (high[0], middle[1]),
        OpensBy.BOTTOM: (middle[0], low[1]),
        OpensBy.TOP: (middle[0], high[1]),
    }
    return np.asarray(places.get(way, middle))


def rim_depth(front: Front, panel: Rectangle) -> float:
    """Return how far behind the nearest point the outer edge of a panel lies [pixels]."""
    rows, columns = (
        slice(int(start) + inset, int(stop) - inset + 1)
        for start, stop in zip(panel.low, panel.high, strict=True)
        for inset in (min(INSET, int(stop - start) // 2),)
    )
    borders = (
        (rows.stop - 1, columns),
        (rows.start, columns),
        (rows, columns.start),
        (rows, columns.stop - 1),
    )
    shown = (-front.face.height[border][front.relief.seen[border]] for border in borders)
    return max((float(np.median(depth)) for depth in shown if len(depth)), default=0.0)


def panel_mover(
    fronts: Mapping[Side, Front], side: Side, panel: Rectangle, way: OpensBy, kind: PartKind
) -> OpeningPart:
    """Return a panel of a front that opens in one way.

    Args:
        fronts: the four sides.
        side: the panel's.
        panel: one of its panels.
        way: how it opens.
        kind: what it is.
    """
    front = fronts[side]
    behind = front.relief.depth
    raster = front.relief.raster
    right, up, away = raster.side.frame
    low, high = panel.corners(raster)
    rim = raster.near + rim_depth(front, panel) * raster.pixel
    leaf = leaf_thickness(front, panel) if way is not OpensBy.OUT else None
    thickness = leaf or thickness_behind(fronts, side, panel, rim)
    back = rim + thickness if leaf is None else raster.near + behind
    region = box_before(raster.side, low, high, back)
    across, height = edge_middle(low, high, way)
    axis = {
        OpensBy.LEFT: -up,
        OpensBy.RIGHT: up,
        OpensBy.BOTTOM: right,
        OpensBy.TOP: -right,
        OpensBy.OUT: -away,
    }[way]
    slides = way is OpensBy.OUT
    motion = Motion(
        kind=JointKind.PRISMATIC if slides else JointKind.REVOLUTE,
        axis=axis,
        origin=across * right + height * up + rim * away,
        lower=0.0,
        upper=SLIDE * behind if slides else TURN,
    )
    return OpeningPart(
        kind=kind,
        region=region,
        motion=motion,
        panel=Panel(raster.side.frame, low, high, rim, thickness, way),
    )
