"""How far the parts' own solids overlap, before any decomposition: a repair must not hide it."""

from __future__ import annotations

from dataclasses import dataclass

import manifold3d
import numpy as np
from manifold3d import Manifold

from ...articulation import Articulation
from ...mesh import FloatArray
from ..decompose.solids import gate, union

#: Intersections smaller than this are rounding [m3]: a cube of a twentieth of a millimetre.
LEAST_VOLUME_M3 = 1.25e-13


@dataclass(frozen=True)
class MeshOverlap:
    """The intersection of two solids.

    Attributes:
        volume_m3: of the whole intersection.
        depth_m: thickness of its thickest connected piece; an upper estimate, exact for slabs.
    """

    volume_m3: float
    depth_m: float


def part_solids(articulation: Articulation) -> tuple[Manifold | None, ...]:
    """Each part as one closed solid at rest, object frame; ``None`` if surfaces enclose nothing."""
    return tuple(_solid(articulation, index) for index in range(len(articulation.parts)))


def _solid(articulation: Articulation, part: int) -> Manifold | None:
    if not len(articulation.parts[part].faces):
        return None
    mesh = articulation.part_mesh(part)
    gated = gate(mesh.vertices, mesh.faces)
    if not gated.solids or gated.sheets:
        return None
    solid = union(list(gated.solids))
    return solid - union(list(gated.cavities)) if gated.cavities else solid


def thickness_m(solid: Manifold | None) -> float:
    """Mean thickness of a solid that is all of sheets [m]; 0 of what encloses nothing."""
    return 0.0 if solid is None else 2.0 * float(solid.volume()) / float(solid.surface_area())


def overlap(a: Manifold, b: Manifold, pose: FloatArray) -> MeshOverlap:
    """Return how two solids intersect where their parts are.

    Args:
        a: a solid at rest.
        b: another.
        pose: motion of ``b`` as seen from ``a``, shape [4, 4].
    """
    moved = b.transform(np.array(pose[:3], order="C"))
    shared = a ^ moved
    if shared.status() != manifold3d.Error.NoError:
        return MeshOverlap(float("inf"), float("inf"))
    pieces = [piece for piece in shared.decompose() if piece.volume() > LEAST_VOLUME_M3]
    return MeshOverlap(
        sum(piece.volume() for piece in pieces), max(map(_thickness, pieces), default=0.0)
    )


def _thickness(piece: Manifold) -> float:
    """Least width of a piece, or three times its mean thickness if bent; the lesser [m]."""
    mean = thickness_m(piece)
    mesh = piece.hull().to_mesh64()
    vertices = mesh.vert_properties[:, :3]
    faces = mesh.tri_verts.astype(np.int64)
    normals = np.cross(
        vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]]
    )
    length = np.linalg.norm(normals, axis=1)
    kept = length > 1e-9 * length.max() if len(length) else length > 0
    heights = vertices @ (normals[kept] / length[kept, None]).T
    width = float((heights.max(axis=0) - heights.min(axis=0)).min()) if heights.size else 0.0
    return min(width, 3.0 * mean)
