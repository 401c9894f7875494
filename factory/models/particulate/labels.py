"""From labelled points to labelled faces; faces that hang together agree, stray patches go."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ...geometry.edges import label_linked
from ...mesh import BoolArray, FloatArray, IntArray
from .surface import Surface, last_of

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
    key = point_faces * count + point_labels
    votes = np.bincount(key, minlength=face_count * count).reshape(face_count, count)
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
    fused = np.arange(count)
    if how is Refinement.AUTO:
        fused = fused_components(surface, labels, fused_share)
    inside = np.isin(surface.components, fused)
    if how is Refinement.AUTO:
        area = np.bincount(labels, weights=surface.areas)
        stray = area < TINY * area.sum()
        # Merging then gives them to what surrounds them.
        labels = np.where(inside & stray[labels], one_each, labels)
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


def _area_by_label(surface: Surface, labels: IntArray) -> FloatArray:
    """Return areas [component_count, label_count]; faces without any weigh next to nothing."""
    count = int(labels.max(initial=0)) + 1
    key = surface.components * count + labels
    weights = np.maximum(surface.areas, np.finfo(np.float64).tiny)
    rows = int(surface.components.max(initial=-1)) + 1
    area = np.bincount(key, weights=weights, minlength=rows * count)
    return np.asarray(area.reshape(rows, count))


def merged_into_one_each(surface: Surface, labels: IntArray, inside: BoolArray) -> IntArray:
    """Return labels that are one connected patch at most in each component, [face_count].

    Again and again the smallest patch whose label has another patch in its component takes the
    bordering label that covers most of the component.

    Args:
        surface: whose faces border on one another.
        labels: of its faces, at least 0.
        inside: which faces to treat, whole components; the others keep their labels.
    """
    pairs = surface.neighbours
    same = labels[pairs[:, 0]] == labels[pairs[:, 1]]
    patch = label_linked(len(labels), pairs[same])
    borders = np.unique(np.sort(patch[pairs[~same & inside[pairs[:, 0]]]], axis=1), axis=0)
    _, first = np.unique(patch, return_index=True)
    graph = _Patches(
        label=labels[first].tolist(),
        area=np.bincount(patch, weights=surface.areas, minlength=len(first)).tolist(),
        component=surface.components[first].tolist(),
        neighbours=[set() for _ in first],
        chosen=np.flatnonzero(inside[first]).tolist(),
    )
    for one, other in borders.tolist():
        graph.neighbours[one].add(other)
        graph.neighbours[other].add(one)
    graph.merge()
    owners = last_of(np.array(graph.parent, dtype=np.int64))
    return np.asarray(graph.label, dtype=np.int64)[owners][patch]


@dataclass
class _Patches:
    """Patches by number; a patch that was swallowed points to the one that did."""

    label: list[int]
    area: list[float]
    component: list[int]
    neighbours: list[set[int]]
    chosen: list[int]

    def __post_init__(self) -> None:
        self.parent = list(range(len(self.label)))
        self.count: dict[tuple[int, int], int] = {}
        self.total: dict[tuple[int, int], float] = {}
        for patch in self.chosen:
            key = self.component[patch], self.label[patch]
            self.count[key] = self.count.get(key, 0) + 1
            self.total[key] = self.total.get(key, 0.0) + self.area[patch]

    def merge(self) -> None:
        queue = [(self.area[patch], self.label[patch], patch) for patch in self.chosen]
        heapq.heapify(queue)
        while queue:
            area, _, patch = heapq.heappop(queue)
            alive = self.parent[patch] == patch and area == self.area[patch]
            if not alive or self.count[self.component[patch], self.label[patch]] < 2:
                # A label never gets more patches, so what is alone now stays alone.
                continue
            kept = self._relabel(patch)
            heapq.heappush(queue, (self.area[kept], self.label[kept], kept))

    def _relabel(self, patch: int) -> int:
        """Give the patch to the bordering label that covers most; returns its patch's number."""
        component = self.component[patch]
        old = self.label[patch]
        near = {self.label[n] for n in self.neighbours[patch]}
        new = max(near, key=lambda label: (self.total[component, label], -label))
        self.count[component, old] -= 1
        self.count[component, new] += 1
        self.total[component, old] -= self.area[patch]
        self.total[component, new] += self.area[patch]
        self.label[patch] = new
        joined = [patch, *(n for n in self.neighbours[patch] if self.label[n] == new)]
        self.count[component, new] -= len(joined) - 1
        kept = max(joined, key=lambda n: (len(self.neighbours[n]), -n))
        for other in joined:
            if other != kept:
                self._swallow(kept, other)
        return kept

    def _swallow(self, kept: int, other: int) -> None:
        self.parent[other] = kept
        self.area[kept] += self.area[other]
        for neighbour in self.neighbours[other]:
            self.neighbours[neighbour].discard(other)
            if neighbour != kept:
                self.neighbours[neighbour].add(kept)
                self.neighbours[kept].add(neighbour)
        self.neighbours[kept].discard(other)
        self.neighbours[other] = set()
