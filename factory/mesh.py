"""A mesh as the factory understands it: metres, z up, welded, textures kept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


def read_only(array: npt.ArrayLike, dtype: npt.DTypeLike = np.float64) -> npt.NDArray[np.generic]:
    """Return a contiguous copy of ``array`` that nobody can edit in place."""
    copy = np.array(array, dtype=dtype, order="C", copy=True)
    copy.setflags(write=False)
    return copy


def freeze(thing: object, *names: str, dtype: npt.DTypeLike = np.float64) -> None:
    """Make arrays of a frozen dataclass read-only, each a copy of its own; ``None`` stays."""
    for name in names:
        value = getattr(thing, name)
        if value is not None:
            object.__setattr__(thing, name, read_only(value, dtype))


def cross(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the cross products of rows, shape [n, 3], as ``np.cross`` does, several times faster.

    Args:
        first: shape [n, 3].
        second: shape [n, 3].
    """
    x, y, z = first.T
    u, v, w = second.T
    products = np.empty(first.shape, dtype=np.result_type(first, second))
    np.subtract(y * w, z * v, out=products[:, 0])
    np.subtract(z * u, x * w, out=products[:, 1])
    np.subtract(x * v, y * u, out=products[:, 2])
    return products


def unit_rows(vectors: FloatArray) -> FloatArray:
    """Return vectors of length 1 that point as these do, shape [..., 3]; 0 stays 0."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


@dataclass(frozen=True)
class Texture:
    """An image, as it was encoded in the input.

    Attributes:
        data: the encoded file, bytes.
        suffix: file extension with its dot, ``.png`` or ``.jpg``.
    """

    data: bytes = field(repr=False)
    suffix: str


@dataclass(frozen=True)
class Material:
    """How a face looks.

    Attributes:
        name: unique within one mesh.
        color: base colour, linear RGBA in [0, 1].
        texture: base colour image, multiplied by ``color``; ``None`` for a plain colour.
    """

    name: str
    color: tuple[float, float, float, float] = (0.7, 0.7, 0.7, 1.0)
    texture: Texture | None = None


@dataclass(frozen=True)
class Mesh:
    """Triangles in the object frame [m], z up, with appearance kept per face corner.

    Vertices are welded by position, so that texture seams neither split components nor make sharp
    edges; what a seam separates (texture coordinates, normals) lives on the corners instead.

    Attributes:
        vertices: positions [m], shape [vertex_count, 3], float64.
        faces: vertex indices, shape [face_count, 3], int64.
        corner_uv: texture coordinates per face corner, origin bottom left, shape [face_count, 3,
            2]; NaN where the input had none. ``None`` if no face has any.
        corner_normals: unit shading normals per face corner, shape [face_count, 3, 3]; NaN where
            the input had none. ``None`` if no face has any.
        face_material: index into ``materials``, shape [face_count], int64.
        materials: at least one.
    """

    vertices: FloatArray
    faces: IntArray
    corner_uv: FloatArray | None
    corner_normals: FloatArray | None
    face_material: IntArray
    materials: tuple[Material, ...]

    def __post_init__(self) -> None:
        freeze(self, "vertices", "corner_uv", "corner_normals")
        freeze(self, "faces", "face_material", dtype=np.int64)
        face_count = len(self.faces)
        if self.vertices.ndim != 2 or self.vertices.shape[1] != 3:
            raise ValueError(f"mesh: vertices have shape {self.vertices.shape}, want [n, 3]")
        if self.faces.ndim != 2 or self.faces.shape[1] != 3:
            raise ValueError(f"mesh: faces have shape {self.faces.shape}, want [n, 3]")
        if not np.isfinite(self.vertices).all():
            raise ValueError("mesh: a vertex is not finite; clean the mesh first")
        if face_count and not 0 <= self.faces.min() <= self.faces.max() < len(self.vertices):
            raise ValueError(f"mesh: a face index is outside 0..{len(self.vertices) - 1}")
        if self.face_material.shape != (face_count,):
            raise ValueError(
                f"mesh: face_material has shape {self.face_material.shape}, want [{face_count}]"
            )
        if not self.materials:
            raise ValueError("mesh: no material; give it the default Material('default')")
        if face_count and not 0 <= self.face_material.min() <= self.face_material.max() < len(
            self.materials
        ):
            raise ValueError(f"mesh: a face_material is outside 0..{len(self.materials) - 1}")
        for name, width in (("corner_uv", 2), ("corner_normals", 3)):
            value = getattr(self, name)
            if value is not None and value.shape != (face_count, 3, width):
                raise ValueError(
                    f"mesh: {name} has shape {value.shape}, want [{face_count}, 3, {width}]"
                )

    @classmethod
    def from_triangles(
        cls, vertices: npt.ArrayLike, faces: npt.ArrayLike, material: Material | None = None
    ) -> Mesh:
        """Return a mesh of one plain material; ``vertices`` [m] and ``faces`` as in the class."""
        triangles = np.asarray(faces, dtype=np.int64).reshape(-1, 3)
        return cls(
            vertices=np.asarray(vertices, dtype=np.float64).reshape(-1, 3),
            faces=triangles,
            corner_uv=None,
            corner_normals=None,
            face_material=np.zeros(len(triangles), dtype=np.int64),
            materials=(material or Material("default"),),
        )

    @cached_property
    def bounds(self) -> FloatArray:
        """Lower and upper corner of the axis-aligned box of the used vertices [m], shape [2, 3]."""
        used = self.vertices[np.unique(self.faces)] if len(self.faces) else np.zeros((1, 3))
        return np.stack([used.min(axis=0), used.max(axis=0)])

    @property
    def extents(self) -> FloatArray:
        """Side lengths of the axis-aligned box [m], shape [3]."""
        return np.asarray(self.bounds[1] - self.bounds[0])

    @property
    def diagonal(self) -> float:
        """Return the length of the box's diagonal [m]."""
        return float(np.linalg.norm(self.extents))

    def submesh(self, face_indices: npt.ArrayLike) -> Mesh:
        """Return the given faces as a mesh of their own, unused vertices and materials dropped."""
        selected = np.asarray(face_indices, dtype=np.int64)
        faces = self.faces[selected]
        used, compact = np.unique(faces, return_inverse=True)
        kept_materials, face_material = np.unique(self.face_material[selected], return_inverse=True)
        return Mesh(
            vertices=self.vertices[used],
            faces=compact.reshape(-1, 3),
            corner_uv=None if self.corner_uv is None else self.corner_uv[selected],
            corner_normals=None if self.corner_normals is None else self.corner_normals[selected],
            face_material=face_material.reshape(-1),
            materials=tuple(self.materials[i] for i in kept_materials) or self.materials[:1],
        )

    def turned(self, rotation: npt.ArrayLike) -> Mesh:
        """Return the mesh turned about the origin by ``rotation``, shape [3, 3]."""
        motion = np.eye(4)
        motion[:3, :3] = rotation
        return self.transformed(motion)

    def transformed(self, matrix: npt.ArrayLike) -> Mesh:
        """Move the mesh by a 4x4 matrix: rotation, scale along any axes, translation.

        A mirroring matrix also reverses the winding, so that faces keep pointing outwards.
        """
        m = np.asarray(matrix, dtype=np.float64)
        linear = m[:3, :3]
        vertices = self.vertices @ linear.T + m[:3, 3]
        order = np.array([0, 2, 1] if np.linalg.det(linear) < 0 else [0, 1, 2])
        normals = self.corner_normals
        if normals is not None:
            normals = unit_rows(normals @ np.linalg.inv(linear))[:, order]
        return Mesh(
            vertices=vertices,
            faces=self.faces[:, order],
            corner_uv=None if self.corner_uv is None else self.corner_uv[:, order],
            corner_normals=normals,
            face_material=self.face_material,
            materials=self.materials,
        )


def concatenate(meshes: list[Mesh]) -> Mesh:
    """Return one mesh of all faces of ``meshes``, in order; vertices are not welded across them.

    Equal materials are shared; different materials of one name are told apart by a suffix.
    """
    if not meshes:
        raise ValueError("concatenate: no meshes")
    materials = list(dict.fromkeys(each for mesh in meshes for each in mesh.materials))
    place = {material: number for number, material in enumerate(materials)}
    names = distinct_names(each.name for each in materials)
    counts = [len(mesh.faces) for mesh in meshes]
    face_material: list[IntArray] = []
    vertex_offset = 0
    faces = []
    for mesh in meshes:
        local = np.array([place[each] for each in mesh.materials], dtype=np.int64)
        face_material.append(local[mesh.face_material])
        faces.append(mesh.faces + vertex_offset)
        vertex_offset += len(mesh.vertices)
    return Mesh(
        vertices=np.concatenate([m.vertices for m in meshes]),
        faces=np.concatenate(faces),
        corner_uv=stack_corners([m.corner_uv for m in meshes], counts, 2),
        corner_normals=stack_corners([m.corner_normals for m in meshes], counts, 3),
        face_material=np.concatenate(face_material),
        materials=tuple(
            replace(each, name=name) for each, name in zip(materials, names, strict=True)
        ),
    )


def stack_corners(
    pieces: Sequence[FloatArray | None], counts: Sequence[int], width: int
) -> FloatArray | None:
    """Join pieces' corner attributes, NaN for a piece without; ``None`` if all are without."""
    if all(piece is None for piece in pieces):
        return None
    filled = [
        np.full((count, 3, width), np.nan) if piece is None else piece
        for piece, count in zip(pieces, counts, strict=True)
    ]
    return np.concatenate(filled)


def distinct_names(names: Iterable[str], taken: Iterable[str] = ()) -> list[str]:
    """Return names, told apart by a number from earlier ones and from those that are taken."""
    used = set(taken)
    reached: dict[str, int] = {}
    result = []
    for given in names:
        # Thousands of one name would else count from one again and again.
        name = given
        number = reached.get(given, 1)
        while name in used:
            number += 1
            name = f"{given}_{number}"
        reached[given] = number
        used.add(name)
        result.append(name)
    return result
