"""Edges at which two faces meet, and what hangs together over links of any kind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..mesh import BoolArray, IntArray
from .triangles import FOLLOWING


@dataclass(frozen=True, eq=False)
class SharedEdges:
    """Edges of exactly two faces, in the order of their vertices.

    Attributes:
        vertices: of each edge, the lower one first, shape [n, 2].
        faces: that share it, shape [n, 2].
        forward: whether each of these walks it from its lower vertex on, shape [n, 2]; where one
            does and the other does not they are wound alike.
    """

    vertices: IntArray
    faces: IntArray
    forward: BoolArray


def shared_edges(faces: IntArray) -> SharedEdges:
    """Find the edges that exactly two faces share; ``faces`` has shape [face_count, 3]."""
    directed = np.stack([faces, faces[:, FOLLOWING]], axis=2).reshape(-1, 2)
    low = directed.min(axis=1)
    high = directed.max(axis=1)
    key = low * (int(faces.max(initial=-1)) + 1) + high
    order = np.argsort(key, kind="stable")
    key = key[order]
    starts = np.flatnonzero(np.diff(key, prepend=-1))
    first = starts[np.diff(np.append(starts, len(key))) == 2]
    pairs = np.stack([order[first], order[first + 1]], axis=1)
    return SharedEdges(
        np.stack([low[pairs[:, 0]], high[pairs[:, 0]]], axis=1),
        pairs // 3,
        directed[pairs, 0] == low[pairs],
    )


def label_linked(count: int, links: npt.NDArray[np.integer]) -> IntArray:
    """Find groups of linked things.

    Args:
        count: how many things there are.
        links: pairs of them, shape [n, 2].

    Returns:
        The number of each thing's group, in the order of the groups' first things, shape [count].
    """
    graph = coo_matrix((np.ones(len(links), dtype=bool), links.T), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
