"""The truth on a mesh that keeps no trace of its parts, and after an articulator has cut that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from asset_factory.factory.articulation import Articulation, Part
from asset_factory.factory.geometry.clean import clean
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.soup import plain_soup
from asset_factory.factory.mesh import FloatArray, IntArray, Mesh

#: Triangles looked at together.
_CHUNK = 256


def merged(articulation: Articulation, rng: np.random.Generator) -> Articulation:
    """Return the same parts and joints over a mesh whose order, seams and looks hide the parts.

    Faces are shuffled, vertices are numbered as those faces use them and welded by position across
    parts, as for any mesh file that is read; materials, texture coordinates and normals are gone.
    Faces without area are too.

    Raises:
        InputRejected: no face has any area.
    """
    order = rng.permutation(len(articulation.mesh.faces))
    corners = articulation.mesh.vertices[articulation.mesh.faces[order]]
    cleaned = clean(plain_soup(corners), articulation.articulator)
    owner = face_parts(articulation)[order][cleaned.source_faces]
    parts = tuple(
        Part(part.name, np.flatnonzero(owner == i)) for i, part in enumerate(articulation.parts)
    )
    return Articulation(
        cleaned.mesh, parts, articulation.joints, articulation.articulator, articulation.notes
    )


def on_mesh(truth: Articulation, mesh: Mesh) -> Articulation:
    """Return the same parts and joints over the same mesh, some of its triangles perhaps cut."""
    if len(mesh.faces) == len(truth.mesh.faces):
        return truth
    part = face_parts(truth)[sources(truth.mesh, mesh)]
    parts = tuple(
        replace(each, faces=np.flatnonzero(part == index)) for index, each in enumerate(truth.parts)
    )
    return replace(truth, mesh=mesh, parts=parts)


def sources(whole: Mesh, cut: Mesh) -> IntArray:
    """Return the triangle that each one of a cut mesh is, or was cut from, [face_count]."""
    known = {row.tobytes(): index for index, row in enumerate(_corners(whole))}
    found = np.array([known.get(row.tobytes(), -1) for row in _corners(cut)], dtype=np.int64)
    left = np.flatnonzero(found < 0)
    gone = np.setdiff1d(np.arange(len(whole.faces)), found)
    triangles = whole.vertices[whole.faces[gone]]
    middles = cut.vertices[cut.faces[left]].mean(axis=1)
    for start in range(0, len(left), _CHUNK):
        chosen = slice(start, start + _CHUNK)
        found[left[chosen]] = gone[_outside(middles[chosen], triangles).argmin(axis=1)]
    return found


def _corners(mesh: Mesh) -> FloatArray:
    return np.ascontiguousarray(mesh.vertices[mesh.faces].reshape(-1, 9))


def _outside(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return how far points are outside triangles, over their size; [points, triangles]."""
    a, b, c = triangles.transpose(1, 0, 2)
    one = b - a
    other = c - a
    normal = np.cross(one, other)
    area = np.maximum(np.einsum("ij,ij->i", normal, normal), np.finfo(np.float64).tiny)
    away = points[:, None] - a[None]
    v = np.einsum("pti,ti->pt", np.cross(away, other[None]), normal) / area
    w = np.einsum("pti,ti->pt", np.cross(one[None], away), normal) / area
    off = np.abs(np.einsum("pti,ti->pt", away, normal)) / area**0.75
    beside = np.maximum(0.0, np.maximum(np.maximum(-v, -w), v + w - 1.0))
    return np.asarray(beside + off)
