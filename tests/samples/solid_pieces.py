"""The closed pieces that a mesh consists of, as solids whose volume is exact."""

import manifold3d
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from asset_factory.factory.mesh import Mesh


def pieces_of(mesh: Mesh) -> list[manifold3d.Manifold]:
    """One solid for each set of faces that share vertices; each is closed and faces outwards."""
    links = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]]])
    graph = coo_matrix((np.ones(len(links)), links.T), shape=(len(mesh.vertices),) * 2)
    label = connected_components(graph, directed=False)[1][mesh.faces[:, 0]]
    pieces = [mesh.submesh(np.flatnonzero(label == value)) for value in np.unique(label)]
    solids = [
        manifold3d.Manifold(manifold3d.Mesh64(np.array(p.vertices), p.faces.astype(np.uint64)))
        for p in pieces
    ]
    assert all(s.status() == manifold3d.Error.NoError and s.volume() > 0.0 for s in solids)
    return solids


def united(mesh: Mesh) -> manifold3d.Manifold:
    """All pieces of a mesh as one solid; an empty one of a mesh without faces."""
    if not len(mesh.faces):
        return manifold3d.Manifold()
    return manifold3d.Manifold.batch_boolean(pieces_of(mesh), manifold3d.OpType.Add)
