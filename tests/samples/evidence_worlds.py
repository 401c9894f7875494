"""Small closed objects whose motions are known."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulate.evidence import Partition
from asset_factory.factory.articulation import Articulation, rotation_about
from asset_factory.factory.mesh import Material, Mesh
from asset_factory.factory.training.objects.parts import (
    assemble,
    carcass,
    cavity,
    drawer,
    drop_door,
    front,
    handle,
    knob,
    side_door,
)

WOOD = Material("wood")
STEEL = Material("steel", (0.5, 0.5, 0.5, 1.0))
X = (-0.3, 0.3)
Y = (0.0, 0.5)
Z = (0.0, 0.7)
WALL = 0.018


def cupboard(hinge: str = "left") -> Articulation:
    """A door over the front, its handle across from the hinge."""
    x = (X[0] + 0.002, X[1] - 0.002)
    face = -0.021
    panel = front(x, (face, -0.003), (0.002, 0.698), "slab", WOOD)
    grip = handle("bar", 0.24 if hinge == "left" else -0.24, face, 0.35, True, 0.15, STEEL)
    door = side_door("door", [*panel, *grip], x, face, (0.002, 0.698), hinge, 1.8)
    return assemble(carcass(X, Y, Z, WALL, WOOD), [door])


def chest() -> Articulation:
    """One wide, low drawer in a carcass."""
    z = (0.0, 0.25)
    face = -0.021
    inner = cavity(X, Y, z, WALL)
    panel = [
        *front((-0.298, 0.298), (face, -0.003), (0.002, 0.248), "slab", WOOD),
        *handle("bar", 0.0, face, 0.13, False, 0.2, STEEL),
    ]
    box_x = (inner[0][0] + 0.004, inner[0][1] - 0.004)
    return assemble(
        carcass(X, Y, z, WALL, WOOD),
        [drawer("drawer", panel, box_x, (-0.003, 0.45), (0.03, 0.2), WOOD)],
    )


def oven() -> Articulation:
    """A door that drops, and a knob above it."""
    x = (X[0] + 0.002, X[1] - 0.002)
    face = -0.021
    panel = front(x, (face, -0.003), (0.01, 0.55), "slab", WOOD)
    door = drop_door(
        "door",
        [*panel, *handle("bar", 0.0, face, 0.5, False, 0.4, STEEL)],
        x,
        face,
        0.01,
        float(np.radians(88)),
    )
    strip = front(x, (face, -0.003), (0.56, 0.698), "slab", WOOD)
    return assemble(
        [*carcass(X, Y, Z, WALL, WOOD), *strip],
        [door, knob("knob", 0.1, face, 0.63, 0.025, STEEL, WOOD)],
    )


def partition(articulation: Articulation, yaw: float = 0.0) -> Partition:
    """Its labels over its mesh, turned about z by ``yaw`` [rad]; joints are forgotten."""
    face_part = np.zeros(len(articulation.mesh.faces), dtype=np.int64)
    for index, part in enumerate(articulation.parts):
        face_part[part.faces] = index
    turned = articulation.mesh.vertices @ rotation_about(np.array([0.0, 0.0, 1.0]), yaw).T
    parents = np.array([-1, *(joint.parent for joint in articulation.joints)])
    return Partition(Mesh.from_triangles(turned, articulation.mesh.faces), face_part, parents)


def apart(first: np.ndarray, axis: np.ndarray, second: np.ndarray) -> float:
    """Distance [m] of a point from a line."""
    offset = first - second
    return float(np.linalg.norm(offset - axis * (axis @ offset)))
