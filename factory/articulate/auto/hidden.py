"""Little pieces that no side shows, which only the network takes for movers."""

import numpy as np

from ...geometry.triangles import face_areas
from ...mesh import IntArray, Mesh
from ...part import Proposer
from ...views.raster import Side
from ...views.view import Views
from ..proposal import Proposal

#: What has at most this share of a mesh's area, and shows at most this share of its own, through
#: gaps, is no mover.
LITTLE = 0.03
HIDDEN = 0.03
#: But for racks: so wide and deep as a share of the mesh, so flat, and so much of the area is in
#: the middle half of either, where a pair of runners has nothing.
BROAD = 0.5
FLAT = 0.1
MIDDLE = 0.2


def without_hidden(views: Views, rated: list[Proposal]) -> list[Proposal]:
    """Drop the network's little pieces that no side shows: runners, shelf pins.

    Nothing can take hold of those, and they bar what really moves. The racks of an oven stay.
    """
    mesh = views.mesh
    areas = face_areas(mesh)
    small = [
        each.proposer is Proposer.NETWORK
        and areas[each.faces].sum() <= LITTLE * areas.sum()
        and not _is_rack(mesh, np.flatnonzero(each.faces))
        for each in rated
    ]
    if not any(small):
        return rated
    shown = np.zeros(len(areas))
    for side in Side:
        view = views[side]
        pixels = np.bincount(view.face[view.seen], minlength=len(areas))
        shown += pixels * view.raster.pixel**2
    return [
        each
        for each, little in zip(rated, small, strict=True)
        if not little or shown[each.faces].sum() > HIDDEN * areas[each.faces].sum()
    ]


def _is_rack(mesh: Mesh, faces: IntArray) -> bool:
    """Return whether faces are a flat level thing that fills half of the mesh's width and depth."""
    piece = mesh.submesh(faces)
    low, high = piece.bounds
    size = high - low
    if (size[:2] < BROAD * mesh.extents[:2]).any() or size[2] > FLAT * size[:2].min():
        return False
    areas = face_areas(piece)
    off = np.abs(piece.vertices[piece.faces].mean(axis=1) - (low + high) / 2.0)[:, :2]
    middle = areas @ (off <= size[:2] / 4.0)
    return bool((middle >= MIDDLE * areas.sum()).all())
