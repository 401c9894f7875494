"""A labelled mesh that passes work on: which part and which piece every face belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ....articulation import Articulation
from ....geometry.posing import face_parts
from ....mesh import FloatArray, IntArray, Material, Mesh

BoolArray = npt.NDArray[np.bool_]

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
        part: part of each face, shape [face_count].
        piece: number of the solid each face belongs to, 0, 1, ... without gaps, shape [face_count].
        material: of each face, shape [face_count].
    """

    vertices: FloatArray
    faces: IntArray
    part: IntArray
    piece: IntArray
    material: IntArray

    @classmethod
    def of(cls, articulation: Articulation) -> Labelled:
        """The mesh of an articulation; faces that share vertices are one piece, if they are of one part."""
        mesh, part = articulation.mesh, face_parts(articulation)
        key = part[:, None] * len(mesh.vertices) + mesh.faces
        used, corners = np.unique(key, return_inverse=True)
        faces = np.asarray(corners.reshape(-1, 3), dtype=np.int64)
        vertices = mesh.vertices[used % len(mesh.vertices)]
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
        graph = coo_matrix(
            (np.ones(len(edges), dtype=np.int8), edges.T), shape=(len(used), len(used))
        )
        piece = np.asarray(
            connected_components(graph, directed=False)[1][faces[:, 0]], dtype=np.int64
        )
        return cls(vertices, faces, part, _numbered(piece), mesh.face_material)

    def articulation(self, original: Articulation, character: str) -> Articulation:
        """These faces with the parts and joints of ``original``; ``character`` is one sentence about them."""
        used, corners = np.unique(self.faces, return_inverse=True)
        mesh = Mesh(
            vertices=self.vertices[used],
            faces=corners.reshape(-1, 3),
            corner_uv=None,
            corner_normals=None,
            face_material=self.material,
            materials=tuple(plain(material) for material in original.mesh.materials),
        )
        parts = tuple(
            replace(part, faces=np.flatnonzero(self.part == i))
            for i, part in enumerate(original.parts)
        )
        return replace(original, mesh=mesh, parts=parts, notes=(*original.notes, character))

    @property
    def piece_count(self) -> int:
        """How many pieces there are."""
        return int(self.piece.max()) + 1

    @property
    def corners(self) -> FloatArray:
        """Of every face [m], shape [face_count, 3, 3]."""
        return np.asarray(self.vertices[self.faces])

    @property
    def crosses(self) -> FloatArray:
        """Normal of every face, as long as twice its area [m2], shape [face_count, 3]."""
        corners = self.corners
        return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    @property
    def areas(self) -> FloatArray:
        """Of every face [m2], shape [face_count]."""
        return np.asarray(np.linalg.norm(self.crosses, axis=1) / 2.0)

    @property
    def longest(self) -> float:
        """Longest side of the box of all faces [m]."""
        used = self.vertices[self.faces.reshape(-1)].T
        return float((used.max(axis=1) - used.min(axis=1)).max())

    def boxes(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corner of every piece's box [m], each of shape [piece_count, 3]."""
        order = np.argsort(self.piece, kind="stable")
        start = np.searchsorted(self.piece[order], np.arange(self.piece_count))
        corners = self.corners[order]
        return np.minimum.reduceat(corners.min(axis=1), start), np.maximum.reduceat(
            corners.max(axis=1), start
        )

    def part_of_piece(self) -> IntArray:
        """Shape [piece_count]."""
        found = np.zeros(self.piece_count, dtype=np.int64)
        found[self.piece] = self.part
        return found

    def chosen(self, faces: BoolArray) -> Labelled:
        """Only these faces."""
        return Labelled(
            self.vertices,
            self.faces[faces],
            self.part[faces],
            _numbered(self.piece[faces]),
            self.material[faces],
        )

    def without(self, faces: BoolArray) -> Labelled:
        """All but these faces; a part that would lose too much of its surface loses nothing."""
        areas = self.areas
        count = int(self.part.max()) + 1
        whole = np.bincount(self.part, areas, minlength=count)
        left = np.bincount(self.part, np.where(faces, 0.0, areas), minlength=count)
        kept = ~(faces & (left >= KEPT_SHARE * whole)[self.part])
        return self if kept.all() else self.chosen(kept)

    def with_own_vertices(self) -> Labelled:
        """Pieces share no vertices."""
        key = self.piece[:, None] * len(self.vertices) + self.faces
        used, faces = np.unique(key, return_inverse=True)
        return replace(
            self, vertices=self.vertices[used % len(self.vertices)], faces=faces.reshape(-1, 3)
        )


def joined(several: Sequence[Labelled]) -> Labelled:
    """All faces of several meshes, in order; no vertices and no pieces are shared between them."""
    vertex = np.cumsum([0, *(len(each.vertices) for each in several[:-1])])
    piece = np.cumsum([0, *(each.piece_count for each in several[:-1])])
    return Labelled(
        np.concatenate([each.vertices for each in several]),
        np.concatenate([each.faces + n for each, n in zip(several, vertex, strict=True)]),
        np.concatenate([each.part for each in several]),
        np.concatenate([each.piece + n for each, n in zip(several, piece, strict=True)]),
        np.concatenate([each.material for each in several]),
    )


def plain(material: Material) -> Material:
    """The material without its texture."""
    return material if material.texture is None else Material(material.name, WOOD)


def some(rng: np.random.Generator, count: int, share: float) -> BoolArray:
    """Each of ``count`` things with probability ``share``."""
    return np.asarray(rng.random(count) < share)


def _numbered(piece: IntArray) -> IntArray:
    """The same grouping, numbered without gaps."""
    present = np.zeros(int(piece.max()) + 1, dtype=np.int64)
    present[piece] = 1
    return np.asarray((np.cumsum(present) - 1)[piece])
