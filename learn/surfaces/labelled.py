"""A labelled mesh that passes work on: which part and which piece every face belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.edges import label_linked
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import areas_of, doubled_normals
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray, Material, Mesh

#: A part keeps at least this share of its surface, whatever a pass drops.
KEPT_SHARE = 0.15
#: What stands for a texture, which no longer fits: linear RGBA.
WOOD = (0.5, 0.36, 0.22, 1.0)


@dataclass(frozen=True)
class Labelled:
    """Triangles and what they belong to; passes take one and give another.

    Attributes:
        vertices: object frame [m], shape [vertex_count, 3].
        faces: vertex indices, shape [face_count, 3].
        label: part, piece and material of each face, shape [face_count, 3]; pieces, the solids that
            faces belong to, are numbered 0, 1, ... without gaps.
    """

    vertices: FloatArray
    faces: IntArray
    label: IntArray

    @classmethod
    def of(cls, articulation: Articulation) -> Labelled:
        """Return an articulation's mesh; faces of a part that share vertices are one piece."""
        mesh = articulation.mesh
        part = face_parts(articulation)
        label = np.stack([part, part, mesh.face_material], axis=1)
        own = cls(mesh.vertices, mesh.faces, label).with_own_vertices()
        edges = np.concatenate([own.faces[:, [0, 1]], own.faces[:, [1, 2]]])
        label[:, 1] = label_linked(len(own.vertices), edges)[own.faces[:, 0]]
        return replace(own, label=_numbered(label))

    def articulation(self, original: Articulation, character: str) -> Articulation:
        """Return these faces with the parts and joints of ``original``, and a note."""
        used, corners = np.unique(self.faces, return_inverse=True)
        looks = tuple(plain(material) for material in original.mesh.materials)
        faces = corners.reshape(-1, 3)
        mesh = Mesh(self.vertices[used], faces, None, None, self.label[:, 2], looks)
        parts = tuple(
            replace(part, faces=np.flatnonzero(self.part == i))
            for i, part in enumerate(original.parts)
        )
        return replace(original, mesh=mesh, parts=parts, notes=(*original.notes, character))

    @property
    def part(self) -> IntArray:
        """Return the part of every face, shape [face_count]."""
        return np.asarray(self.label[:, 0])

    @property
    def piece(self) -> IntArray:
        """Return the piece of every face, shape [face_count]."""
        return np.asarray(self.label[:, 1])

    @property
    def piece_count(self) -> int:
        """Return how many pieces there are."""
        return int(self.piece.max(initial=-1)) + 1

    @property
    def piece_labels(self) -> IntArray:
        """Return part, piece and material of every piece, shape [piece_count, 3]."""
        return self.label[np.unique(self.piece, return_index=True)[1]]

    @property
    def corners(self) -> FloatArray:
        """Return the corners of every face [m], shape [face_count, 3, 3]."""
        return np.asarray(self.vertices[self.faces])

    @property
    def crosses(self) -> FloatArray:
        """Return the normal of every face, as long as twice its area [m2], [face_count, 3]."""
        return doubled_normals(self.corners)

    @property
    def areas(self) -> FloatArray:
        """Return the area of every face [m2], shape [face_count]."""
        return areas_of(self.corners)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corner of the box of all faces [m], each of shape [3]."""
        used = self.vertices[self.faces.reshape(-1)]
        return used.min(axis=0), used.max(axis=0)

    @property
    def longest(self) -> float:
        """Return the longest side of the box of all faces [m]."""
        low, high = self.bounds
        return float((high - low).max())

    def boxes(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corner of every piece's box [m], each of shape [piece_count, 3]."""
        order = np.argsort(self.piece, kind="stable")
        start = np.searchsorted(self.piece[order], np.arange(self.piece_count))
        corners = self.corners[order]
        low = np.minimum.reduceat(corners.min(axis=1), start)
        return low, np.maximum.reduceat(corners.max(axis=1), start)

    def chosen(self, faces: BoolArray) -> Labelled:
        """Return only these faces."""
        return Labelled(self.vertices, self.faces[faces], _numbered(self.label[faces]))

    def without(self, faces: BoolArray) -> Labelled:
        """Leave out these faces; a part that would lose too much of its surface loses nothing."""
        areas = self.areas
        whole = np.bincount(self.part, areas)
        left = np.bincount(self.part, np.where(faces, 0.0, areas))
        kept = ~(faces & (left >= KEPT_SHARE * whole)[self.part])
        return self if kept.all() else self.chosen(kept)

    def with_own_vertices(self) -> Labelled:
        """Give every piece vertices of its own."""
        key = self.piece[:, None] * len(self.vertices) + self.faces
        used, faces = np.unique(key, return_inverse=True)
        vertices = self.vertices[used % len(self.vertices)]
        return replace(self, vertices=vertices, faces=faces.reshape(-1, 3))

    def grown(self, reach: float, least: float = 0.5) -> Labelled:
        """Stretch every piece about its middle by ``reach`` at either end [m].

        Nothing shrinks to less than a share of it: thin pieces would turn inside out.
        """
        own = self.with_own_vertices()
        low, high = own.boxes()
        half = np.maximum((high - low) / 2.0, 1e-9)
        piece = np.zeros(len(own.vertices), dtype=np.int64)
        piece[own.faces] = own.piece[:, None]
        middle = (low + half)[piece]
        factor = np.maximum(1.0 + reach / half, least)[piece]
        return replace(own, vertices=middle + (own.vertices - middle) * factor)

    def sampled(
        self, shares: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, IntArray, FloatArray]:
        """Return points on each face, and at these shares of all area [m]; faces; weights there.

        Weights are those of the face's corners, shape [point_count, 3].
        """
        areas = self.areas
        far = np.searchsorted(np.cumsum(areas / areas.sum()), shares)
        face = np.concatenate([np.arange(len(areas)), np.minimum(far, len(areas) - 1)])
        u, v = rng.random((2, len(face)))
        root = np.sqrt(u)
        weights = np.stack([1.0 - root, root * (1.0 - v), root * v], axis=1)
        return np.einsum("ni,nij->nj", weights, self.corners[face]), face, weights


def joined(several: Sequence[Labelled]) -> Labelled:
    """Join all faces of several meshes, in order; they share no vertices and no pieces."""
    before = np.cumsum([(0, 0), *((len(m.vertices), m.piece_count) for m in several[:-1])], axis=0)
    placed = list(zip(several, before.tolist(), strict=True))
    return Labelled(
        np.concatenate([each.vertices for each in several]),
        np.concatenate([each.faces + vertex for each, (vertex, _) in placed]),
        np.concatenate([each.label + np.array((0, piece, 0)) for each, (_, piece) in placed]),
    )


def plain(material: Material) -> Material:
    """Return the material without its texture."""
    return material if material.texture is None else Material(material.name, WOOD)


def some(rng: np.random.Generator, count: int, share: float) -> BoolArray:
    """Return each of ``count`` things with probability ``share``."""
    return np.asarray(rng.random(count) < share)


def _numbered(label: IntArray) -> IntArray:
    """Return the same labels, pieces numbered without gaps."""
    numbered = np.array(label, dtype=np.int64)
    numbered[:, 1] = np.unique(label[:, 1], return_inverse=True)[1].reshape(-1)
    return numbered
