"""CoACD and V-HACD, which crash and hang: called in a child process only, and only here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Triangles = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]


@dataclass(frozen=True)
class Search:
    """CoACD's settings for one call.

    Attributes:
        error_m: largest concavity left [m].
        resolution: surface samples for the concavity.
        iterations, nodes, depth: of the Monte Carlo tree search.
        seed: of the search.
    """

    error_m: float
    resolution: int
    iterations: int
    nodes: int
    depth: int
    seed: int


def coacd_pieces(solid: Triangles, search: Search) -> list[Triangles]:
    """Return the convex pieces of a closed manifold. Call through ``run_isolated`` only."""
    import coacd  # heavy, native, and only ever loaded in the child

    coacd.set_log_level("off")
    vertices, faces = solid
    pieces = coacd.run_coacd(
        coacd.Mesh(vertices, faces),
        threshold=search.error_m,
        max_convex_hull=-1,
        # Its preprocessing is a voxel remesh that thickens boards by millimetres; the gate replaces
        # it.
        preprocess_mode="off",
        resolution=search.resolution,
        mcts_iterations=search.iterations,
        mcts_nodes=search.nodes,
        mcts_max_depth=search.depth,
        seed=search.seed,
        real_metric=True,
    )
    return [(np.asarray(v, dtype=np.float64), np.asarray(f, dtype=np.int64)) for v, f in pieces]


def vhacd_pieces(solid: Triangles, max_hulls: int) -> list[Triangles]:
    """Return the convex pieces by V-HACD's voxels. Call through ``run_isolated`` only."""
    import vhacdx  # optional, native, and only ever loaded in the child

    vertices, faces = solid
    pieces = vhacdx.compute_vhacd(
        vertices,
        np.column_stack([np.full(len(faces), 3), faces]).ravel().astype(np.uint32),
        maxConvexHulls=max_hulls,
        resolution=200_000,
        minimumVolumePercentErrorAllowed=1.0,
        maxRecursionDepth=12,
        shrinkWrap=True,
        maxNumVerticesPerCH=64,
        asyncACD=False,
        minEdgeLength=2,
        findBestPlane=False,
    )
    return [
        (np.asarray(v, dtype=np.float64), np.asarray(f, dtype=np.int64).reshape(-1, 3))
        for v, f in pieces
    ]
