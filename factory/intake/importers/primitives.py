"""Boxes, cylinders, spheres, capsules and ellipsoids as closed triangle meshes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from asset_factory.sim_checks.read import primitives

from ...mesh import FloatArray, Material, Mesh

SECTIONS = 32
RINGS = 16


def box(size: npt.ArrayLike, material: Material) -> Mesh:
    """Return an axis-aligned box of side lengths ``size`` [m], shape [3], centred at the origin."""
    vertices, faces = primitives.box(np.asarray(size, dtype=np.float64))
    return Mesh.from_triangles(vertices, faces, material)


def cylinder(radius: float, length: float, material: Material) -> Mesh:
    """Return a cylinder along z of ``radius`` and ``length`` [m], centred at the origin."""
    half = length / 2.0
    return _revolved(
        np.array([[0.0, -half], [radius, -half], [radius, half], [0.0, half]]), material
    )


def ellipsoid(radii: npt.ArrayLike, material: Material) -> Mesh:
    """Return an ellipsoid of semi-axes ``radii`` [m], shape [3], centred at the origin."""
    angles = np.linspace(-np.pi / 2.0, np.pi / 2.0, RINGS + 1)
    unit = _revolved(np.stack([np.cos(angles), np.sin(angles)], axis=1), material)
    return Mesh.from_triangles(
        unit.vertices * np.asarray(radii, dtype=np.float64), unit.faces, material
    )


def capsule(radius: float, length: float, material: Material) -> Mesh:
    """Return a cylinder along z of ``radius``, ``length`` [m] with half spheres as ends, at 0."""
    angles = np.linspace(-np.pi / 2.0, 0.0, RINGS // 2 + 1)
    low = np.stack([radius * np.cos(angles), radius * np.sin(angles) - length / 2.0], axis=1)
    return _revolved(np.concatenate([low, low[::-1] * [1.0, -1.0]]), material)


def _revolved(profile: FloatArray, material: Material) -> Mesh:
    """Turn a profile of (radius, height) [m], from the bottom pole to the top pole, about z."""
    vertices, faces = primitives.lathe(profile, SECTIONS)
    # Files written before have the poles last, and the rings before them.
    faces = (faces - 2) % len(vertices)
    faces[-SECTIONS:] = np.roll(faces[-SECTIONS:], -1, axis=1)
    return Mesh.from_triangles(np.roll(vertices, -2, axis=0), faces, material)
