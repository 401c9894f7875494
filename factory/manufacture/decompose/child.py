"""CoACD, which crashes and hangs: called in a child process only, and only here."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...config import DecomposeConfig

Triangles = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]


def coacd_pieces(solid: Triangles, error_m: float, config: DecomposeConfig) -> list[Triangles]:
    """Return the convex pieces of a closed manifold. Call through ``run_isolated`` only.

    It has vertices [m] and faces; no concavity larger than ``error_m`` is left [m].
    """
    import coacd  # heavy, native, and only ever loaded in the child

    coacd.set_log_level("off")
    vertices, faces = solid
    pieces = coacd.run_coacd(
        coacd.Mesh(vertices, faces),
        threshold=error_m,
        max_convex_hull=-1,
        # Its preprocessing is a voxel remesh that thickens boards by millimetres; the gate replaces
        # it.
        preprocess_mode="off",
        resolution=config.resolution,
        mcts_iterations=config.iterations,
        mcts_nodes=config.nodes,
        mcts_max_depth=config.search_depth,
        seed=config.seed,
        real_metric=True,
    )
    return [(np.asarray(v, dtype=np.float64), np.asarray(f, dtype=np.int64)) for v, f in pieces]
