"""The most probable tree over a set of parts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...mesh import IntArray

Edge = tuple[int, int]


def spanning_arborescence(logits: npt.ArrayLike, parts: IntArray) -> tuple[Edge, ...]:
    """Return the edges (parent, child) of the tree with most ``log sigmoid(logit)``, by child.

    Edmonds' algorithm over all pairs; every part may be the root, and the best one is.

    Args:
        logits: ``logits[i, j]``: that ``i`` is the parent of ``j``; finite, shape [n, n]. The
            diagonal is not read.
        parts: distinct indices; none or one give no edges.
    """
    import networkx as nx

    if len(parts) < 2:
        return ()
    weights = -np.logaddexp(0.0, -np.asarray(logits, dtype=np.float64))
    graph = nx.DiGraph()
    graph.add_nodes_from(int(part) for part in parts)
    graph.add_weighted_edges_from(
        (int(i), int(j), float(weights[i, j])) for i in parts for j in parts if i != j
    )
    tree = nx.maximum_spanning_arborescence(graph)
    return tuple(sorted(((int(i), int(j)) for i, j in tree.edges), key=lambda edge: edge[1]))


def induced(edges: tuple[Edge, ...], parts: IntArray) -> tuple[Edge, ...]:
    """Return the tree's edges among ``parts``, by child; orphans go to the nearest kept ancestor.

    Where the root is lost this may be several trees.
    """
    alive = {int(part) for part in parts}
    parent = {child: above for above, child in edges}
    found: dict[int, int] = {}
    for part in sorted(alive):
        above = parent.get(part)
        while above is not None and above not in alive:
            above = parent.get(above)
        if above is not None:
            found[part] = above
    return tuple((above, part) for part, above in sorted(found.items()))
