"""Masses and inertias from the material a mesh encloses.

Everything is kept as moments of the mass distribution: mass, first moment, second moment ``C``, the
integral of ``x x^T``; in one matrix, so that those of bodies add up. The inertia tensor is
``trace(C) 1 - C`` about the centre of mass; as long as ``C`` is positive definite, it satisfies the
triangle inequality, so validity is one eigenvalue floor away.

Closed surfaces: exact polyhedral integrals (Mirtich 1996; here as sums over signed tetrahedra) over
the body that decomposition sees in them. Open surfaces: laminae of an assumed thickness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import manifold3d
import numpy as np

from ..asset import Hull, Inertial
from ..config import InertiaConfig
from ..errors import InvalidAsset
from ..geometry.triangles import doubled_normals
from ..mesh import FloatArray, IntArray, Mesh
from .decompose.solids import gate, thickness_m, triangles_of, union

#: Lighter bodies make constraint solvers ill-conditioned beside furniture of many kilograms [kg].
MIN_MASS_KG = 0.005
#: Smallest root of a principal second moment over mass [m]; engines in single precision lose less.
MIN_GYRATION_M = 0.001
#: A closed surface of less mean thickness is a sheet with two sides [m].
SHEET_THICKNESS_M = 1e-4
#: Nothing is made denser than steel to reach its usual mass [kg/m3].
STEEL = 7850.0
#: Share of the child's mass given to a link without geometry, and the radius of its sphere [m].
CARRIER_SHARE = 0.05
CARRIER_RADIUS_M = 0.02


#: Of a mass distribution about a fixed point, the integral of ``(x, 1) (x, 1)^T``, shape [4, 4]:
#: second moments [kg m2] above on the left, first ones [kg m] beside and below, the mass [kg] last.
Moments = FloatArray


def part_inertial(
    mesh: Mesh, hulls: Sequence[Hull], density: float, config: InertiaConfig
) -> Inertial:
    """Return what a part weighs, and how that is distributed.

    Closed components count with the volume they enclose, overlaps once, cavities (closed shells
    that face inwards inside another) not at all. Open sheets count with their area times
    ``config.shell_thickness_m``, faces that lie twice on the same corners once. The part never
    weighs more than its hulls would if they were filled.

    Args:
        mesh: of the part, object frame at rest [m].
        hulls: its collision geometry; may be empty.
        density: of the material [kg/m3].
        config: for the thickness of sheets.

    Returns:
        A valid inertial of at least :data:`MIN_MASS_KG`.

    Raises:
        InvalidAsset: no geometry at all, or a density that is not positive.
    """
    if not (np.isfinite(density) and density > 0.0):
        raise InvalidAsset(f"inertial: density is {density} kg/m3, want more than 0")
    if not len(mesh.faces) and not hulls:
        raise InvalidAsset(
            "inertial: the part has neither faces nor hulls; a carrier takes carrier_inertial"
        )
    center = mesh.bounds.mean(axis=0) if len(mesh.faces) else hulls[0].vertices.mean(axis=0)
    moments = _mesh_moments(mesh.vertices - center, mesh.faces, config.shell_thickness_m)
    if hulls:
        solids = [manifold3d.Manifold.hull_points(hull.vertices - center) for hull in hulls]
        filled = _solid_moments(*triangles_of(union(solids)))
        if not moments[3, 3] > 0.0:
            moments = filled
        elif moments[3, 3] > filled[3, 3] > 0.0:
            moments = moments * (filled[3, 3] / moments[3, 3])
    if not moments[3, 3] > 0.0:
        moments = np.diag([0.0, 0.0, 0.0, MIN_MASS_KG / density])
    return _inertial(moments * density, center)


def carrier_inertial(child: Inertial, origin: FloatArray) -> Inertial:
    """Return a small sphere for a link without geometry: light beside the child that hangs on it.

    Its centre is the ``origin`` of the joint between them [m], shape [3].
    """
    mass = max(CARRIER_SHARE * child.mass, MIN_MASS_KG)
    return Inertial(
        mass, np.asarray(origin, dtype=np.float64), np.eye(3) * 0.4 * mass * CARRIER_RADIUS_M**2
    )


def weighing(inertials: Sequence[Inertial], total: float, density: float) -> list[Inertial]:
    """Return links that together weigh ``total`` [kg], distributed as they are.

    They weigh less where their material, of some ``density`` [kg/m3], would become denser than
    steel.
    """
    factor = min(total / sum(each.mass for each in inertials), STEEL / density)
    factors = [max(factor, MIN_MASS_KG / each.mass) for each in inertials]
    return [
        replace(each, mass=by * each.mass, tensor=by * each.tensor)
        for each, by in zip(inertials, factors, strict=True)
    ]


def _inertial(moments: Moments, reference: FloatArray) -> Inertial:
    normed = moments / moments[3, 3]
    offset = normed[:3, 3]
    second = normed[:3, :3] - np.outer(offset, offset)
    mass = max(float(moments[3, 3]), MIN_MASS_KG)
    squares, axes = np.linalg.eigh((second + second.T) / 2.0)
    widened = (axes * np.maximum(squares, MIN_GYRATION_M**2)) @ axes.T
    tensor = mass * (np.trace(widened) * np.eye(3) - widened)
    return Inertial(mass, reference + offset, (tensor + tensor.T) / 2.0)


def _mesh_moments(vertices: FloatArray, faces: IntArray, thickness: float) -> Moments:
    """Return moments per unit of density: mass is a volume [m3]."""
    gated = gate(vertices, faces)
    total = np.zeros((4, 4))
    for sheet in gated.sheets:
        total += _sheet_moments(sheet.vertices, sheet.faces, thickness)
    thick = []
    for solid in gated.solids:
        if thickness_m(solid) < SHEET_THICKNESS_M:
            total += 0.5 * _sheet_moments(*triangles_of(solid), thickness)
        else:
            thick.append(solid)
    return total + _solid_moments(*triangles_of(replace(gated, solids=tuple(thick)).body))


def _moments(mass: float, first: FloatArray, second: FloatArray) -> Moments:
    return np.block([[second, first[:, None]], [first, mass]])


def _solid_moments(vertices: FloatArray, faces: IntArray) -> Moments:
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    det = np.einsum("ij,ij->i", a, np.cross(b, c))
    total = a + b + c
    second = sum((p * det[:, None]).T @ p for p in (a, b, c, total))
    return _moments(det.sum() / 6.0, (det @ total) / 24.0, np.asarray(second) / 120.0)


def _sheet_moments(vertices: FloatArray, faces: IntArray, thickness: float) -> Moments:
    corners = vertices[faces]
    cross = doubled_normals(corners)
    double = np.linalg.norm(cross, axis=1)
    volume = double / 2.0 * thickness
    normal = cross / double[:, None]
    a, b, c = corners.transpose(1, 0, 2)
    total = a + b + c
    second = sum((p * volume[:, None]).T @ p for p in (a, b, c, total)) / 12.0
    across = (normal * volume[:, None]).T @ normal * thickness**2 / 12.0
    return _moments(volume.sum(), (volume @ total) / 3.0, np.asarray(second + across))
