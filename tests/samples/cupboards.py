"""A back wall with a door or a drawer front before it: square sheets of 1 m, finely divided."""

from dataclasses import replace

import numpy as np
from plain_solids import parted

from asset_factory.factory.articulation import Joint, JointKind, Part
from asset_factory.factory.mesh import Mesh

DIVISIONS = 40


def sheet(y):
    """A square of 1 m in the plane of that y, its lower left corner over the z axis."""
    steps = np.linspace(0.0, 1.0, DIVISIONS + 1)
    x, z = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
    vertices = np.stack([x, np.full_like(x, y), z], axis=1)
    corner = (np.arange(DIVISIONS)[:, None] * (DIVISIONS + 1) + np.arange(DIVISIONS)).ravel()
    right = corner + DIVISIONS + 1
    halves = ([corner, right, right + 1], [corner, right + 1, corner + 1])
    return vertices, np.concatenate([np.stack(half, axis=1) for half in halves])


def cupboard(joint):
    """The wall is 1 m behind the front; ``joint`` holds the front."""
    sheets = {"wall": sheet(1.0), "front": sheet(0.0)}
    return parted({name: [Mesh.from_triangles(*each)] for name, each in sheets.items()}, joint)


def hinge(x=0.0, upper=1.5, sign=-1.0, lower=0.0, kind=JointKind.REVOLUTE):
    """Upright, at that x; with the sign -1 a door hinged on the left opens towards -Y."""
    axis = np.array([0.0, 0.0, sign])
    return Joint("joint", kind, 0, 1, axis, np.array([x, 0.0, 0.0]), lower, upper)


def rail(upper=0.5):
    """Slides towards -Y."""
    return Joint("joint", JointKind.PRISMATIC, 0, 1, [0, -1, 0], np.zeros(3), 0.0, upper)


def turning_drawer():
    """The front slides in a carrier that turns."""
    whole = cupboard(hinge())
    wall, front = whole.parts
    parts = (wall, Part("carrier", np.zeros(0, int)), front)
    slide = Joint("slide", JointKind.PRISMATIC, 1, 2, [0, -1, 0], np.zeros(3), 0.0, 0.3)
    return replace(whole, parts=parts, joints=(*whole.joints, slide))


def stuck():
    """Holds the front where it is."""
    return Joint("joint", JointKind.FIXED, 0, 1, np.array([0.0, 0.0, 1.0]), np.zeros(3))


def in_one_piece(articulation):
    """The same mesh as a single part."""
    whole = Part("base", np.arange(len(articulation.mesh.faces)))
    return replace(articulation, parts=(whole,), joints=(), articulator="naive")
