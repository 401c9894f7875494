"""Small objects whose best places to hold are known by construction."""

from collections.abc import Sequence

import numpy as np
from plain_solids import box, cylinder, parted

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.asset import Asset, Hull, Inertial, PartBody, Target
from asset_factory.factory.manufacture.targets.find import find_targets
from asset_factory.factory.manufacture.targets.handles import find_handle
from asset_factory.factory.mesh import Material, Mesh

PLAIN = Material("plain")
FRONT = np.array([0.0, -1.0, 0.0])
BODY = box((0.0, 0.4), (0.0, 0.4), (0.0, 0.6), PLAIN)
#: A front that covers the whole body, 3 mm before it.
PANEL = box((0.0, 0.4), (-0.02, -0.003), (0.0, 0.6), PLAIN)
#: 12 mm thick, 30 mm before the panel, 160 mm high, its front at y = -0.062; on two posts.
BAR = [
    box((0.350, 0.362), (-0.062, -0.050), (0.22, 0.38), PLAIN),
    box((0.352, 0.360), (-0.050, -0.020), (0.23, 0.24), PLAIN),
    box((0.352, 0.360), (-0.050, -0.020), (0.36, 0.37), PLAIN),
]
KNOB = [
    cylinder(1, (0.3, 0.2), 0.006, (-0.038, -0.02), PLAIN, 16),
    cylinder(1, (0.3, 0.2), 0.015, (-0.050, -0.038), PLAIN, 32),
]

HINGE = Joint(
    "j", JointKind.REVOLUTE, 0, 1, np.array([0.0, 0.0, -1.0]), np.array([0.0, -0.02, 0.3]), 0.0, 1.6
)
SLIDE = Joint("j", JointKind.PRISMATIC, 0, 1, FRONT, np.array([0.2, -0.02, 0.3]), 0.0, 0.3)


def world(
    moving: Sequence[Mesh], joint: Joint = HINGE, still: Sequence[Mesh] = (BODY,)
) -> Articulation:
    """A body and one part that moves."""
    return parted({"body": still, "front": moving}, joint)


def targets_of(articulation: Articulation) -> tuple[Target, ...]:
    return find_targets(articulation, [()] * len(articulation.parts))


def asset_of(articulation: Articulation) -> Asset:
    """An asset whose parts are each one hull."""
    bodies = []
    for part in range(len(articulation.parts)):
        mesh = articulation.part_mesh(part)
        inertial = Inertial(1.0, mesh.bounds.mean(axis=0), np.eye(3) * 0.01)
        hull = Hull(mesh.vertices, mesh.faces)
        bodies.append(PartBody((hull,), inertial, find_handle(articulation, part), "exact"))
    return Asset("test", articulation, tuple(bodies), targets_of(articulation))


def best(articulation: Articulation) -> Target:
    return targets_of(articulation)[0]
