"""From labelled points to labelled faces, and faces that hang together made to agree."""

from enum import StrEnum

import numpy as np

from ...mesh import FloatArray, IntArray
from .patches import merged_into_one_each
from .surface import BoolArray, Surface

TINY = 0.0005
"""A label with a smaller share of the mesh's area is a stray, not a part fused to others."""
NEARLY_ALL = 0.9
"""A component with this share of the mesh's area is the mesh, as far as parts go."""


class Refinement(StrEnum):
    """How faces of one connected component are made to agree.

    ``component``: one label each, the one with the most area: the paper's rule, for meshes modelled
        part by part.
    ``patch``: each label one connected patch, stray patches going to what surrounds them: for fused
        surfaces.
    ``auto``: ``patch`` for fused components, less strays, ``component`` for the others; see
        :func:`fused_components`.
    ``none``: labels as voted.
    """

    AUTO = "auto"
    COMPONENT = "component"
    PATCH = "patch"
    NONE = "none"


def voted(point_faces: IntArray, point_labels: IntArray, face_count: int) -> IntArray:
    """Return the label most of a face's points have, lowest if tied; -1 for none, [face_count]."""
    count = int(point_labels.max(initial=0)) + 1
    votes = np.bincount(point_faces * count + point_labels, minlength=face_count * count).reshape(
        face_count, count
    )
    best = votes.argmax(axis=1)
    return np.where(votes[np.arange(face_count), best] > 0, best, -1)


def with_gaps_filled(
    surface: Surface, labels: IntArray, points: FloatArray, point_labels: IntArray
) -> IntArray:
    """Return the faces labelled -1 take the label of the labelled point nearest to their centre.

    Args:
        surface: same frame as ``points``.
        labels: of its faces, shape [face_count].
        points: shape [point_count, 3].
        point_labels: shape [point_count].
    """
    from scipy.spatial import cKDTree

    gaps = np.flatnonzero(labels < 0)
    if not len(gaps):
        return labels
    centers = surface.vertices[surface.faces[gaps]].mean(axis=1)
    _, nearest = cKDTree(points).query(centers)
    filled = labels.copy()
    filled[gaps] = point_labels[nearest]
    return filled


def refined(
    surface: Surface, labels: IntArray, how: Refinement, fused_share: float
) -> tuple[IntArray, int]:
    """Return refined labels, shape [face_count], and how many components were taken for fused.

    Args:
        surface: whose faces border on one another.
        labels: of its faces, at least 0.
        how: see :class:`Refinement`.
        fused_share: of a component's area, see :func:`fused_components`; used by ``auto`` only.
    """
    if how is Refinement.NONE:
        return labels, 0
    one_each = by_component(surface, labels)
    if how is Refinement.COMPONENT:
        return one_each, 0
    count = int(surface.components.max(initial=-1)) + 1
    fused = (
        np.arange(count)
        if how is Refinement.PATCH
        else fused_components(surface, labels, fused_share)
    )
    inside = np.isin(surface.components, fused)
    if how is Refinement.AUTO:
        # Merging then gives them to what surrounds them.
        labels = np.where(inside & _tiny(surface, labels)[labels], one_each, labels)
    patched = merged_into_one_each(surface, labels, inside)
    return np.where(inside, patched, one_each), len(fused)


def by_component(surface: Surface, labels: IntArray) -> IntArray:
    """Give every component's faces the label that covers most of its area, shape [face_count]."""
    return np.asarray(_area_by_label(surface, labels).argmax(axis=1)[surface.components])


def fused_components(surface: Surface, labels: IntArray, share: float) -> IntArray:
    """Return the components that are no single parts: some parts exist nowhere else.

    That is so where a component covers at least ``share`` of the mesh, and the labels that
    :func:`by_component` would wipe out of the whole mesh cover at least ``share`` of it; and
    wherever it would wipe out any, if the component is nearly the whole mesh.

    Returns:
        Component numbers, ascending.
    """
    area = _area_by_label(surface, labels)
    total = area.sum(axis=1)
    lost = np.setdiff1d(np.arange(area.shape[1]), area.argmax(axis=1))
    wiped = area[:, lost].sum(axis=1)
    whole = total.sum()
    fused = (wiped >= share * total) & (total >= share * whole) | (total >= NEARLY_ALL * whole)
    return np.flatnonzero(fused & (wiped > 0.0))


def _tiny(surface: Surface, labels: IntArray) -> BoolArray:
    """Return which labels are strays, shape [label_count]."""
    area = np.bincount(labels, weights=surface.areas)
    return np.asarray(area < TINY * area.sum())


def _area_by_label(surface: Surface, labels: IntArray) -> FloatArray:
    """Return areas [component_count, label_count]; faces without any weigh next to nothing."""
    count = int(labels.max(initial=0)) + 1
    key = surface.components * count + labels
    weights = np.maximum(surface.areas, np.finfo(np.float64).tiny)
    rows = int(surface.components.max(initial=-1)) + 1
    return np.asarray(
        np.bincount(key, weights=weights, minlength=rows * count).reshape(rows, count)
    )
