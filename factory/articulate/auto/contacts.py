"""Loose pieces go to the part they touch: nothing hangs in the air."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.edges import label_linked
from ...geometry.triangles import areas_of
from ...mesh import FloatArray, IntArray, Mesh
from ..evidence.surfels import WHOLE, spread_owned

#: Pieces nearer than this share of the diagonal touch.
TOUCH = 0.004
#: A loose cluster goes to what it touches if it is no larger than this share of it.
SMALLER = 0.25


@dataclass(frozen=True)
class Contacts:
    """Which connected components of a mesh touch.

    Attributes:
        components: of every face, shape [face_count].
        face_areas: of every face [m2], shape [face_count].
        areas: of every component [m2], shape [component_count].
        pairs: of components that touch, the lower first, shape [pair_count, 2].
        weights: in how many places they do, shape [pair_count].
    """

    components: IntArray
    face_areas: FloatArray
    areas: FloatArray
    pairs: IntArray
    weights: IntArray


def contacts_of(mesh: Mesh, components: IntArray) -> Contacts:
    """Return the contacts between points spread evenly over the mesh, the same every time.

    Args:
        mesh: metres.
        components: of its faces, shape [face_count].
    """
    triangles = mesh.vertices[mesh.faces]
    surfels, owner = spread_owned(triangles, WHOLE)
    points = np.concatenate([surfels.points, triangles.reshape(-1, 3)])
    of_point = np.concatenate([components[owner], np.repeat(components, 3)])
    pairs, weights = _touching(points, of_point, TOUCH * mesh.diagonal)
    own = areas_of(triangles)
    areas = np.asarray(np.bincount(components, weights=own), dtype=np.float64)
    return Contacts(components, own, areas, pairs, weights)


def _touching(points: FloatArray, owners: IntArray, reach: float) -> tuple[IntArray, IntArray]:
    """Return owners of points within reach of each other, the lower first, and how many.

    Two components that lie in one another have a pair of points for everything that is near
    everything: those are counted by whole nodes of trees, never listed.
    """
    order = np.argsort(owners, kind="stable")
    groups = np.split(points[order], np.flatnonzero(np.diff(owners[order])) + 1)
    low = np.array([group.min(axis=0) for group in groups])
    high = np.array([group.max(axis=0) for group in groups])
    trees = [cKDTree(group) for group in groups]
    found = []
    for one, tree in enumerate(trees):
        apart = ((low[one + 1 :] > high[one] + reach) | (low[one] > high[one + 1 :] + reach)).any(1)
        for other in one + 1 + np.flatnonzero(~apart):
            count = tree.count_neighbors(trees[other], reach)
            if count:
                found.append((one, other, count))
    table = np.array(found, dtype=np.int64).reshape(-1, 3)
    return np.unique(owners)[table[:, :2]], table[:, 2]


def settled(contacts: Contacts, face_part: IntArray) -> IntArray:
    """Return labels in which small clusters apart from their part join what they touch most.

    Args:
        contacts: of the mesh.
        face_part: part of every face, shape [face_count]; components of several parts are left as
            they are.

    Returns:
        Part of every face, shape [face_count].
    """
    count = len(contacts.areas)
    parts = int(face_part.max(initial=0)) + 1
    cover = np.bincount(
        contacts.components * parts + face_part,
        weights=contacts.face_areas,
        minlength=count * parts,
    )
    cover = cover.reshape(count, parts)
    label = cover.argmax(axis=1)
    whole = cover.max(axis=1) >= 0.999 * np.maximum(contacts.areas, 1e-300)
    one = contacts.pairs[:, 0]
    other = contacts.pairs[:, 1]
    same = label[one] == label[other]
    cluster = label_linked(count, contacts.pairs[same])
    size = np.bincount(cluster, weights=contacts.areas)
    main = np.zeros(parts, dtype=np.int64)
    for part in np.unique(label):
        mine = np.unique(cluster[label == part])
        main[part] = mine[size[mine].argmax()]
    moved = label.copy()
    is_main = cluster == main[label]
    for loose in np.unique(cluster[~is_main]):
        inside = cluster == loose
        touching = (inside[one] != inside[other]) & (is_main[one] | is_main[other])
        if not touching.any() or not whole[inside].all():
            continue
        outside = np.where(inside[one[touching]], other[touching], one[touching])
        votes = np.bincount(label[outside], weights=contacts.weights[touching], minlength=parts)
        host = int(votes.argmax())
        if size[loose] <= SMALLER * size[main[host]]:
            moved[inside] = host
    return np.where(whole[contacts.components], moved[contacts.components], face_part)
