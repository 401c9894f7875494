"""One-piece skins with labelled patches: a box whose front or top opens."""

from dataclasses import replace

import numpy as np
import trimesh

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.mesh import Mesh, concatenate

SIZE = np.array([0.6, 0.5, 0.8])
#: Length of the triangles' sides [m].
FINE = 0.02


def box_skin(size=SIZE, fine=FINE):
    """Vertices and faces of a closed box that stands on the ground, in small triangles."""
    box = trimesh.creation.box(size)
    box.apply_translation([0, 0, size[2] / 2.0])
    vertices, faces = trimesh.remesh.subdivide_to_size(box.vertices, box.faces, fine)
    merged = trimesh.Trimesh(vertices, faces)
    merged.merge_vertices()
    return np.asarray(merged.vertices), np.asarray(merged.faces)


def labelled(vertices, faces, patches, joints):
    """An articulation whose parts are patches: each says which face centres are its own."""
    middles = vertices[faces].mean(axis=1)
    label = np.zeros(len(faces), dtype=int)
    for index, patch in enumerate(patches, start=1):
        label[patch(middles)] = index
    names = ("body", *(f"panel_{index}" for index in range(1, len(patches) + 1)))
    parts = tuple(Part(name, np.flatnonzero(label == i)) for i, name in enumerate(names))
    mesh = Mesh.from_triangles(vertices, faces)
    return located(Articulation(mesh, parts, tuple(joints), "test"))


def with_more(given, part, vertices, faces):
    """The same with more faces of one of its parts."""
    own = np.append(given.parts[part].faces, len(given.mesh.faces) + np.arange(len(faces)))
    parts = list(given.parts)
    parts[part] = replace(parts[part], faces=own)
    mesh = concatenate([given.mesh, Mesh.from_triangles(vertices, faces)])
    return replace(given, mesh=mesh, parts=tuple(parts))


def front(low, high):
    """Face centres of the front within a rectangle (x, z)."""
    return lambda at: (
        (at[:, 1] < -SIZE[1] / 2.0 + 1e-6)
        & (at[:, 0] > low[0])
        & (at[:, 0] < high[0])
        & (at[:, 2] > low[1])
        & (at[:, 2] < high[1])
    )


def cupboard():
    """A box with a door within its front, hinged on the left."""
    patch = front((-0.2, 0.1), (0.2, 0.7))
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, -1], [-0.2, -0.25, 0.4], 0.0, 1.5)
    return labelled(*box_skin(), [patch], [hinge])


def chest():
    """A box with two drawers, one above the other."""
    patches = [front((-0.24, 0.06), (0.24, 0.4)), front((-0.24, 0.4), (0.24, 0.74))]
    way = ([0, -1, 0], [0, -0.25, 0.4], 0.0, 0.3)
    slides = [Joint(f"slide_{i}", JointKind.PRISMATIC, 0, i, *way) for i in (1, 2)]
    return labelled(*box_skin(), patches, slides)


def bin_with_lid():
    """A box whose upper eighth is a lid, hinged at the back."""
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [-1, 0, 0], [0, 0.25, 0.7], 0.0, 1.5)
    return labelled(*box_skin(), [lambda at: at[:, 2] > 0.7], [hinge])
