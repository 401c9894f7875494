"""How far the parts' own solids overlap, before any decomposition: a repair must not hide it."""

from __future__ import annotations

import manifold3d
import numpy as np
from manifold3d import Manifold

from ...articulation import Articulation
from ...geometry.triangles import doubled_normals
from ...mesh import FloatArray
from ..decompose.convex import thickness
from ..decompose.solids import LEAST_VOLUME_M3, gate, thickness_m, triangles_of


def part_solid(articulation: Articulation, part: int) -> Manifold | None:
    """Return one part as one solid, without its cavities; ``None`` if it encloses nothing."""
    if not len(articulation.parts[part].faces):
        return None
    mesh = articulation.part_mesh(part)
    gated = gate(mesh.vertices, mesh.faces)
    return gated.body if gated.solids and not gated.sheets else None


def overlap_m(a: Manifold, b: Manifold, pose: FloatArray) -> float:
    """Return the thickness of the thickest piece of two solids' intersection [m].

    An upper estimate, exact for slabs. ``pose`` is the motion of ``b`` as seen from ``a``, [4, 4].
    """
    shared = a ^ b.transform(np.array(pose[:3], order="C"))
    if shared.status() != manifold3d.Error.NoError:
        return float("inf")
    pieces = [piece for piece in shared.decompose() if piece.volume() > LEAST_VOLUME_M3]
    return max(map(_thickness, pieces), default=0.0)


def _thickness(piece: Manifold) -> float:
    """Return a piece's least width, or three times its mean thickness if it is bent [m]."""
    mean = thickness_m(piece)
    vertices, faces = triangles_of(piece.hull())
    normals = doubled_normals(vertices[faces])
    length = np.linalg.norm(normals, axis=1)
    kept = length > 1e-9 * length.max() if len(length) else length > 0
    width = thickness(vertices, normals[kept] / length[kept, None]) if kept.any() else 0.0
    return min(width, 3.0 * mean)
