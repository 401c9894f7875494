"""Boxes and cylinders as meshes of one material."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import trimesh

from asset_factory.factory.articulation import Articulation, Joint, Part
from asset_factory.factory.asset import Hull
from asset_factory.factory.mesh import Material, Mesh, concatenate
from asset_factory.factory.models.particulate.surface import Surface
from asset_factory.learn.objects.kit import boards, shapes
from asset_factory.learn.objects.kit.spans import upto

Span = tuple[float, float]


def mesh_of(form: shapes.Form, material: Material) -> Mesh:
    """A form as a mesh."""
    look = np.zeros(len(form.faces), dtype=np.int64)
    return Mesh(form.vertices, form.faces, None, None, look, (material,))


def box(x: Span, y: Span, z: Span, material: Material) -> Mesh:
    """An axis-aligned box given by its spans [m]."""
    return mesh_of(shapes.box(x, y, z), material)


def sized_box(
    size: Sequence[float], at: Sequence[float] = (0.0, 0.0, 0.0)
) -> tuple[np.ndarray, np.ndarray]:
    """The vertices and faces of a box of that size about a point [m]."""
    made = trimesh.creation.box(size)
    return np.asarray(made.vertices) + at, np.asarray(made.faces)


def sized_hull(size: Sequence[float], at: Sequence[float] = (0.0, 0.0, 0.0)) -> Hull:
    """The same box as a hull."""
    return Hull(*sized_box(size, at))


def box_between(
    low: Sequence[float], high: Sequence[float], material: Material | None = None
) -> Mesh:
    """A box of eight vertices and twelve faces between two corners [m]."""
    made = trimesh.creation.box(bounds=[low, high])
    return Mesh.from_triangles(made.vertices, made.faces, material)


def signed_volume(mesh: Any) -> float:
    """The volume of vertices and faces [m3]: positive where the faces look outwards."""
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def surface_of(*meshes: trimesh.Trimesh) -> Surface:
    """Some meshes as one surface, of which a network is shown points."""
    mesh = trimesh.util.concatenate(meshes)
    return Surface.of(np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64))


def carcass(width: float, depth: float, height: float) -> list[Mesh]:
    """Five boards of 20 mm around an inside that is open to the front, -Y [m]."""
    made = boards.carcass(*upto(width, depth, height), 0.02, 0.02)
    return [box_between(each.vertices.min(axis=0), each.vertices.max(axis=0)) for each in made]


def cylinder(
    axis: int, center: Span, radius: float, span: Span, material: Material, sides: int = 20
) -> Mesh:
    """A cylinder; ``center`` in the next two axes in cyclic order [m]."""
    flat = (center[1], center[0]) if axis == 1 else center
    return mesh_of(shapes.cylinder(axis, flat, radius, span, sides), material)


def parted(named: dict[str, Sequence[Mesh]], *joints: Joint) -> Articulation:
    """An object whose parts are some meshes each."""
    ends = np.cumsum([sum(len(mesh.faces) for mesh in own) for own in named.values()])
    faces = np.split(np.arange(ends[-1]), ends[:-1])
    parts = tuple(Part(name, own) for name, own in zip(named, faces, strict=True))
    mesh = concatenate([mesh for own in named.values() for mesh in own])
    return Articulation(mesh, parts, joints, "test")


def moved(whole: Articulation, matrix: np.ndarray) -> Articulation:
    """The whole object moved, scaled or mirrored by a matrix, shape [4, 4].

    A mirror image turns the other way, so that it opens as before.
    """
    linear = matrix[:3, :3]
    sign = np.sign(np.linalg.det(linear))
    scale = np.cbrt(abs(np.linalg.det(linear)))

    def there(joint: Joint) -> Joint:
        axis = linear @ joint.axis / scale * (sign if joint.turns else 1.0)
        length = 1.0 if joint.turns else scale
        limits = {"lower": joint.lower * length, "upper": joint.upper * length}
        return replace(joint, axis=axis, origin=linear @ joint.origin + matrix[:3, 3], **limits)

    joints = tuple(there(joint) for joint in whole.joints)
    return replace(whole, mesh=whole.mesh.transformed(matrix), joints=joints)
