"""One-piece skins with labelled patches: a box whose front or top opens."""

from pathlib import Path

import numpy as np
import trimesh

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.mesh import Mesh

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


def write_skin(articulation, folder: Path) -> Path:
    """A GLB (y up) and its ``pred.npz`` beside it; returns the GLB."""
    mesh = articulation.mesh
    up = mesh.vertices[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    path = folder / "skin.glb"
    trimesh.Trimesh(up, mesh.faces, process=False).export(path)
    count = len(articulation.parts)
    label = np.zeros(len(mesh.faces), dtype=np.int64)
    for index, part in enumerate(articulation.parts):
        label[part.faces] = index
    fields = {
        "face_part_ids": label,
        "motion_hierarchy": np.array([[each.parent, each.child] for each in articulation.joints]),
        "is_part_revolute": np.zeros(count, dtype=bool),
        "is_part_prismatic": np.zeros(count, dtype=bool),
        "revolute_plucker": np.zeros((count, 6)),
        "revolute_range": np.zeros((count, 2)),
        "prismatic_axis": np.zeros((count, 3)),
        "prismatic_range": np.zeros((count, 2)),
    }
    for joint in articulation.joints:
        axis = joint.axis[[0, 2, 1]] * [1.0, 1.0, -1.0]
        origin = joint.origin[[0, 2, 1]] * [1.0, 1.0, -1.0]
        limits = (joint.lower, joint.upper)
        if joint.turns:
            fields["is_part_revolute"][joint.child] = True
            fields["revolute_plucker"][joint.child] = [*axis, *np.cross(axis, origin)]
            fields["revolute_range"][joint.child] = limits
        else:
            fields["is_part_prismatic"][joint.child] = True
            fields["prismatic_axis"][joint.child] = axis
            fields["prismatic_range"][joint.child] = limits
    np.savez(folder / "pred.npz", **fields)
    (folder / "skin.toml").write_text('annotation = "pred.npz"\n')
    return path
