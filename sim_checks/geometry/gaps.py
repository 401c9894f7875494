"""How two parts' visible surfaces stand where their hulls meet: a gap, or an overlap's depth.

Visible meshes are what they are: open, doubled, turned inside out, of three hundred thousand faces.
So nothing here asks for an inside, but for what a triangle soup can answer: whether two soups cut
one another (FCL is right about that), how far apart they are if they do not (and about that), and
how far one has to be pulled before they no longer do. That way out is tried along the hulls' own
and across the faces that meet; the shortest counts, at every place where they meet by itself, and
of the places the deepest. So the depth is of the same kind as the hulls', and an upper bound where
a shorter way lies in a direction not tried. Where no way out is found within the hulls' depth, as
when a ring hangs in another, that depth is the answer.

Only faces near the place where the hulls meet are looked at, whole. A part that swallows another
without touching it has that one inside only if its own surface there is closed: an open box has a
hollow. Then the way out is measured from outside.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.sparse.csgraph import connected_components

from ..description import BoolArray, FloatArray, IntArray
from .collision import Skin
from .placing import grow_box
from .surfaces import WELD, Patch, PosedSurface, SurfaceMeeting, VisibleSurface, patches

#: First and finest pull [m].
FINEST = 1e-5
#: A way out is found to this share of itself, by so many halvings.
HALVINGS = 5
#: Face pairs that are asked where and how they meet, places where they do, and directions tried at
#: each.
MET_FACES = 500
MOST_ZONES = 12
MET_DIRECTIONS = 8
#: How far the first is pulled deeper into the other, to see whether the two only graze [m].
GRAZE = 5e-4
#: Sine of the smallest angle between two directions tried.
SAME_DIRECTION = 0.2
#: Corners that are asked whether they lie inside.
ASKED = 12


def visible_gap(first: PosedSurface, second: PosedSurface, meeting: SurfaceMeeting) -> float:
    """Return how two surfaces stand around a meeting [m]: a gap, or a negative depth.

    The gap is at most the meeting's margin. The first surface is of the part whose hull is first in
    the meeting.
    """
    one, other = patches(first, second, meeting)
    if one is None or other is None:
        held = ((inner, outer) for inner, outer in ((one, second), (other, first)) if inner)
        swallowed = any(_inside(outer, _corners(inner, meeting)).any() for inner, outer in held)
        return -meeting.depth if swallowed and meeting.depth > 0.0 else meeting.margin
    pairs = one.skin.touching(other.skin, MET_FACES)
    if len(pairs):
        # Large faces may touch far from where the hulls do: then no zone holds both.
        zones = tuple(_zones(one, other, pairs, meeting)) or ((one, other),)
        out = max(_way_out(*zone, meeting) for zone in zones)
        # A pin whose end lies flush with a block touches it hardly, and yet is buried in it.
        sunk = 0.0
        if out <= 0.5 * meeting.depth:
            sunk = max(_buried(one, other, meeting), _buried(other, one, meeting))
        return -max(out, min(sunk, meeting.depth))
    # A corner that only touches is buried by a rounding error.
    deepest = max(_buried(one, other, meeting), _buried(other, one, meeting))
    if meeting.depth > 0.0 and deepest > FINEST:
        return -_from_outside(one, other, meeting)
    return min(meeting.margin, one.skin.distance(other.skin))


def _zones(
    one: Patch, other: Patch, pairs: IntArray, meeting: SurfaceMeeting
) -> Iterator[tuple[Patch, Patch]]:
    """Yield the places where two surfaces meet, each by itself.

    A drawer too wide meets two walls, and lies deep in neither. The largest few, as what both
    surfaces show around each.
    """
    corners = one.corners[pairs[:, 0]], other.corners[pairs[:, 1]]
    low = np.maximum(meeting.box[0], np.maximum(*(side.min(axis=1) for side in corners)))
    high = np.minimum(meeting.box[1], np.minimum(*(side.max(axis=1) for side in corners)))
    half = meeting.margin / 2.0
    way = max(0.0, meeting.depth) * meeting.direction
    back = np.minimum(way, 0.0)
    ahead = np.maximum(way, 0.0)
    low, high = np.minimum(low, high) - half, np.maximum(low, high) + half
    near = ((low[:, None] <= high[None]) & (low[None] <= high[:, None])).all(axis=2)
    labels = connected_components(near, directed=False)[1]
    for label in np.argsort(-np.bincount(labels), kind="stable")[:MOST_ZONES]:
        rows = labels == label
        box = np.array([low[rows].min(axis=0) - half, high[rows].max(axis=0) + half])
        # What of either lies deeper in the other comes by on the way out.
        here = one.whole.patch(box + np.array([back, ahead]))
        there = other.whole.patch(box - np.array([ahead, back]))
        if here is not None and there is not None:
            yield here, there


def _way_out(one: Patch, other: Patch, meeting: SurfaceMeeting) -> float:
    """Return the first's shortest pull after which the two do not meet [m], or the hulls' depth."""
    longest = best = max(meeting.depth, meeting.margin)
    for index, direction in enumerate(_directions(one, other, meeting)):
        # Off the hulls' own way out, faces that were not looked at come into play after the margin.
        deeper = float(direction @ -meeting.direction) <= -SAME_DIRECTION
        most = best if index == 0 else GRAZE if deeper else meeting.margin
        best = _least_pull(one, other, direction, min(most, best), best)
    one.skin.shift(np.zeros(3))
    return best if best < longest else max(meeting.depth, FINEST)


def _least_pull(one: Patch, other: Patch, direction: FloatArray, most: float, best: float) -> float:
    """Return the first pull up to ``most`` [m] that frees; ``best`` if none does."""
    meets = 0.0
    free = FINEST
    while _meets_after(one, other, free * direction):
        if free >= most:
            return best
        meets = free
        free = min(2.0 * free, most)
    if free <= FINEST:
        return min(free, best)
    for _ in range(HALVINGS):
        middle = 0.5 * (meets + free)
        if _meets_after(one, other, middle * direction):
            meets = middle
        else:
            free = middle
    return free


def _meets_after(one: Patch, other: Patch, shift: FloatArray) -> bool:
    one.skin.shift(shift)
    return one.skin.meets(other.skin)


def _directions(one: Patch, other: Patch, meeting: SurfaceMeeting) -> FloatArray:
    """Return where to pull the first: the hulls' way out, then across the faces that meet."""
    pairs = one.skin.touching(other.skin, MET_FACES)
    corners = [one.corners[np.unique(pairs[:, 0])], other.corners[np.unique(pairs[:, 1])]]
    a, b, c = np.vstack(corners).transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    # The largest faces say best where the surfaces point.
    order = np.argsort(-lengths, kind="stable")
    order = order[lengths[order] > FINEST**2]
    found = [-meeting.direction]
    for normal in normals[order] / lengths[order, None]:
        for vector in (normal, -normal):
            if all(float(vector @ known) < 1.0 - 0.5 * SAME_DIRECTION**2 for known in found):
                found.append(vector)
        if len(found) > MET_DIRECTIONS:
            break
    return np.array(found)


def _from_outside(one: Patch, other: Patch, meeting: SurfaceMeeting) -> float:
    """Return how far to pull the first out of what it is in, or holds, to touch nothing [m].

    Searched from clear back in.
    """
    touching = 0.0
    clear = meeting.depth
    for share in np.linspace(1.0, 0.0, 2**HALVINGS + 1)[1:-1]:
        if _meets_after(one, other, -share * meeting.depth * meeting.direction):
            touching = float(share) * meeting.depth
            break
        clear = float(share) * meeting.depth
    one.skin.shift(np.zeros(3))
    return clear if touching > 0.0 else meeting.depth


def _buried(outer: Patch, inner: Patch, meeting: SurfaceMeeting) -> float:
    """Measure how deep corners of the inner patch are inside the outer's surface [m]; 0 if none.

    A few corners are asked, so it may be deeper.
    """
    corners = _corners(inner, meeting)
    # A point is a triangle of no size.
    inside = corners[_inside(outer.whole, corners)]
    specks = (Skin(np.tile(corner, (3, 1)), np.array([[0, 1, 2]])) for corner in inside)
    return max((speck.distance(outer.skin) for speck in specks), default=0.0)


def _corners(inner: Patch, meeting: SurfaceMeeting) -> FloatArray:
    """Return a few of a patch's corners where the hulls meet.

    Beyond, the other's nearest face may not have been looked at.
    """
    corners = inner.corners.reshape(-1, 3)
    low, high = grow_box(meeting.box, WELD)
    within = (corners >= low) & (corners <= high)
    corners = np.unique(corners[within.all(axis=1)], axis=0)
    return corners[:: max(1, len(corners) // ASKED)][:ASKED]


def _inside(outer: PosedSurface, corners: FloatArray) -> BoolArray:
    """Tell which points of the world are inside closed pieces of a surface, shape [point_count]."""
    surface = outer.surface
    points = (corners - outer.pose[:3, 3]) @ outer.pose[:3, :3]
    order = np.argsort(surface.pieces, kind="stable")
    starts = np.flatnonzero(np.diff(surface.pieces[order], prepend=-1))
    low = np.minimum.reduceat(surface.boxes[0][order], starts)
    high = np.maximum.reduceat(surface.boxes[1][order], starts)
    held = np.all((points[:, None] > low) & (points[:, None] < high), axis=2)
    inside = np.zeros(len(points), dtype=bool)
    for piece in np.flatnonzero(held.any(axis=0)):
        rows = np.split(order, starts[1:])[piece]
        if surface.closed(rows):
            inside[held[:, piece]] |= np.abs(_windings(surface, rows, points[held[:, piece]])) > 0.5
    return inside


def _windings(surface: VisibleSurface, rows: IntArray, points: FloatArray) -> FloatArray:
    """Return the winding numbers of closed faces around points, shape [point_count].

    After van Oosterom and Strackee (1983).
    """
    corners = surface.vertices[surface.faces[rows]]
    windings = np.empty(len(points))
    for index, point in enumerate(points):
        a, b, c = (corners[:, k] - point for k in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c))
        dots = [np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a))]
        angle = np.arctan2(volume, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb)
        windings[index] = angle.sum() / (2.0 * np.pi)
    return windings
