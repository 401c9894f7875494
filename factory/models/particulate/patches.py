"""Stray patches of a label given to their surroundings, so a label is one patch per component."""

import heapq
from dataclasses import dataclass

import numpy as np

from ...geometry.edges import label_linked
from ...mesh import IntArray
from .surface import BoolArray, Surface


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
    return np.asarray(graph.label, dtype=np.int64)[graph.owners()][patch]


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

    def owners(self) -> IntArray:
        """Return the patch that each one is part of in the end, shape [patch_count]."""
        owners = np.asarray(self.parent, dtype=np.int64)
        while not np.array_equal(owners, owners[owners]):
            owners = owners[owners]
        return owners

    def _relabel(self, patch: int) -> int:
        """Give the patch to the bordering label that covers most; returns its patch's number."""
        component = self.component[patch]
        old = self.label[patch]
        new = max(
            {self.label[n] for n in self.neighbours[patch]},
            key=lambda x: (self.total[component, x], -x),
        )
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
