"""Solids become one skin: those of a part, or those of the whole object."""

from __future__ import annotations

from typing import Any

import numpy as np

from asset_factory.factory.mesh import FloatArray, IntArray

from .labelled import Labelled, joined, some


def parts_united(mesh: Labelled, rng: np.random.Generator, share: float = 0.85) -> Labelled:
    """Return the solids of a share of the parts as one skin each, without what they cover."""
    chosen = some(rng, int(mesh.part.max()) + 1, share)[mesh.part]
    parts = np.unique(mesh.part[chosen])
    united = [_united(mesh.chosen(mesh.part == part)) for part in parts]
    return joined([mesh.chosen(~chosen), *united])


def all_united(mesh: Labelled) -> Labelled:
    """Unite all parts in one surface; pieces grow by 4 mm or less until gaps close."""
    return _united(mesh.grown(min(0.004, 0.01 * mesh.longest)))


def _united(mesh: Labelled) -> Labelled:
    """Unite closed pieces; others are handed back as they are."""
    import manifold3d

    own = mesh.with_own_vertices()
    start = int(manifold3d.Manifold.reserve_ids(own.piece_count))
    bodies = [
        _body(own.vertices, own.faces[own.piece == number], start + number)
        for number in range(own.piece_count)
    ]
    closed = [body for body in bodies if body is not None]
    if len(closed) < 2:
        return mesh
    whole = manifold3d.Manifold.batch_boolean(closed, manifold3d.OpType.Add).to_mesh64()
    run = np.asarray(whole.run_index, dtype=np.int64)
    origin = np.asarray(whole.run_original_id, dtype=np.int64) - start
    label = np.repeat(own.piece_labels[origin], np.diff(run) // 3, axis=0)
    label[:, 1] = 0
    faces = np.asarray(whole.tri_verts, dtype=np.int64)
    skin = Labelled(np.array(whole.vert_properties[:, :3]), faces, label)
    missing = np.setdiff1d(mesh.part, skin.part)
    left = np.array([body is None for body in bodies])[own.piece]
    return joined([skin, own.chosen(left | np.isin(own.part, missing))])


def _body(vertices: FloatArray, faces: IntArray, mark: int) -> Any:
    """Return a solid whose faces keep where they came from; ``None`` if open.

    Open pieces are not only refused, some crash the process.
    """
    import manifold3d

    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    there = edges[:, 0] * len(vertices) + edges[:, 1]
    back = edges[:, 1] * len(vertices) + edges[:, 0]
    if len(np.unique(there)) < len(there) or not np.array_equal(np.sort(there), np.sort(back)):
        return None
    used, own = np.unique(faces, return_inverse=True)
    ends = np.array([0, faces.size], dtype=np.uint64)
    run = np.array([mark], dtype=np.uint32)
    corners = own.reshape(-1, 3).astype(np.uint64)
    mesh = manifold3d.Mesh64(vertices[used], corners, run_index=ends, run_original_id=run)
    body = manifold3d.Manifold(mesh)
    closed = body.status() == manifold3d.Error.NoError and body.volume() > 0.0
    return body if closed else None
