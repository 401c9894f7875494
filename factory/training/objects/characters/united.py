"""Solids become one skin: those of a part, or those of the whole object, so that no component is pure."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ....mesh import FloatArray, IntArray
from .labelled import Labelled, joined, some


def parts_united(mesh: Labelled, rng: np.random.Generator, share: float = 0.85) -> Labelled:
    """The solids of a part as one skin, without what they cover of one another; ``share`` of the parts."""
    chosen = some(rng, int(mesh.part.max()) + 1, share)
    kept = [mesh.chosen(~chosen[mesh.part])] if (~chosen[mesh.part]).any() else []
    for part in np.unique(mesh.part[chosen[mesh.part]]):
        kept.append(_united(mesh.chosen(mesh.part == part)))
    return joined(kept)


def all_united(mesh: Labelled, rng: np.random.Generator, reach: float = 0.004) -> Labelled:
    """One skin around all parts, as if modelled in one go: pieces are grown until gaps close, then united.

    Args:
        mesh: of closed solids.
        rng: not used; every pass takes one.
        reach: by how much a piece grows at either end [m]; less for a small object.
    """
    del rng
    return _united(grown(mesh, min(reach, 0.01 * mesh.longest)))


def grown(mesh: Labelled, reach: float) -> Labelled:
    """Every piece stretched about its middle by ``reach`` at either end [m]; negative: shrunk."""
    own = mesh.with_own_vertices()
    low, high = own.boxes()
    middle, half = (low + high) / 2.0, np.maximum((high - low) / 2.0, 1e-6)
    # What is thinner than the change would turn inside out.
    change = np.maximum(half + reach, 0.5 * half) / half
    piece = np.zeros(len(own.vertices), dtype=np.int64)
    piece[own.faces] = own.piece[:, None]
    return replace(own, vertices=middle[piece] + (own.vertices - middle[piece]) * change[piece])


def _united(mesh: Labelled) -> Labelled:
    """Closed pieces united; others are handed back as they are."""
    import manifold3d

    bodies: list[Any] = []
    sources: dict[int, tuple[int, int]] = {}
    left: list[int] = []
    own = mesh.with_own_vertices()
    order = np.argsort(own.piece, kind="stable")
    bounds = np.searchsorted(own.piece[order], np.arange(own.piece_count + 1))
    start = int(manifold3d.Manifold.reserve_ids(own.piece_count))
    for number in range(own.piece_count):
        rows = order[bounds[number] : bounds[number + 1]]
        faces = own.faces[rows]
        first = int(faces.min())
        vertices: FloatArray = own.vertices[first : int(faces.max()) + 1]
        if not _is_closed(faces):
            left.append(number)
            continue
        body = manifold3d.Manifold(_marked(vertices, faces - first, start + number))
        if body.status() != manifold3d.Error.NoError or body.volume() <= 0.0:
            left.append(number)
            continue
        sources[start + number] = int(own.part[rows[0]]), int(own.material[rows[0]])
        bodies.append(body)
    if len(bodies) < 2:
        return mesh
    whole = manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add).to_mesh64()
    ends = np.asarray(whole.run_index, dtype=np.int64)
    marks = np.array([sources[int(mark)] for mark in whole.run_original_id], dtype=np.int64)
    labels: IntArray = np.repeat(marks, (ends[1:] - ends[:-1]) // 3, axis=0)
    faces = np.asarray(whole.tri_verts, dtype=np.int64)
    skin = Labelled(
        np.array(whole.vert_properties[:, :3]),
        faces,
        labels[:, 0],
        np.zeros(len(faces), dtype=np.int64),
        labels[:, 1],
    )
    missing = np.setdiff1d(mesh.part, skin.part)
    again = np.isin(own.piece, left) | np.isin(own.part, missing)
    return joined([skin, own.chosen(again)]) if again.any() else skin


def _is_closed(faces: IntArray) -> bool:
    """Whether every edge is passed once each way: open pieces are not only refused, some crash the process."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    count = int(faces.max()) + 1
    there, back = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
    return len(np.unique(there)) == len(there) and np.array_equal(np.sort(there), np.sort(back))


def _marked(vertices: FloatArray, faces: IntArray, mark: int) -> Any:
    """A solid whose faces say where they came from, whatever becomes of them."""
    import manifold3d

    ends = np.array([0, faces.size], dtype=np.uint64)
    run = np.array([mark], dtype=np.uint32)
    return manifold3d.Mesh64(vertices, faces.astype(np.uint64), run_index=ends, run_original_id=run)
