"""Small closed objects whose motions are known."""

import numpy as np
from plain_solids import moved

from asset_factory.factory.articulate.evidence import Partition
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.posing import face_parts, turned
from asset_factory.factory.mesh import Material
from asset_factory.learn.objects.kit.assembly import Assembly
from asset_factory.learn.objects.kit.axes import FRONT, facing_front
from asset_factory.learn.objects.kit.boards import carcass, tray
from asset_factory.learn.objects.kit.controls import ControlPanel
from asset_factory.learn.objects.kit.pulls import Pull, add_pull
from asset_factory.learn.objects.kit.shapes import box
from asset_factory.learn.objects.kit.spans import within

WOOD = Material("wood")
STEEL = Material("steel", (0.5, 0.5, 0.5, 1.0))
X = (-0.3, 0.3)
Y = (0.0, 0.5)
Z = (0.0, 0.7)
WALL = 0.018
FACE = -0.021
FRONT_X = within(X, 0.002)
FRONT_Y = (FACE, -0.003)


def _cabinet(z: tuple[float, float]) -> Assembly:
    a = Assembly(np.random.default_rng(0))
    a.body(WOOD).add(*carcass(X, Y, z, WALL, 0.03))
    return a


def _bar(length: float) -> Pull:
    return Pull("bar", length, 0.041, 0.012, STEEL)


def _placed(made: Articulation) -> Articulation:
    """With its back at ``Y[1]``, as it was described."""
    motion = np.eye(4)
    motion[1, 3] = Y[1] - made.mesh.bounds[1, 1]
    return moved(made, motion)


def cupboard(hinge: str = "left") -> Articulation:
    """A door over the front, its handle across from the hinge."""
    a = _cabinet(Z)
    door = a.swung("door", hinge, FRONT_X, (0.002, 0.698), FACE, 1.8)
    door.add(box(FRONT_X, FRONT_Y, (0.002, 0.698)))
    at = (0.24 if hinge == "left" else -0.24, 0.35)
    add_pull(door, _bar(0.15), at, facing_front(FACE), 1.0, True)
    return _placed(a.articulation())


def chest() -> Articulation:
    """One wide, low drawer in a carcass."""
    a = _cabinet((0.0, 0.25))
    drawer = a.slider("drawer", FRONT, (0.0, -0.003, 0.115), 0.362)
    drawer.add(box(FRONT_X, FRONT_Y, (0.002, 0.248)))
    add_pull(drawer, _bar(0.2), (0.0, 0.13), facing_front(FACE), 1.0)
    drawer.add(*tray(within(X, WALL + 0.004), (-0.003, 0.44), (0.03, 0.2), 0.012, front=False))
    return _placed(a.articulation())


def oven() -> Articulation:
    """A door that drops, and a knob above it."""
    a = _cabinet(Z)
    door = a.swung("door", "bottom", FRONT_X, (0.01, 0.55), FACE, float(np.radians(88)))
    door.add(box(FRONT_X, FRONT_Y, (0.01, 0.55)))
    add_pull(door, _bar(0.4), (0.0, 0.5), facing_front(FACE), 1.0)
    a.root.add(box(FRONT_X, FRONT_Y, (0.56, 0.698)))
    ControlPanel(a, facing_front(FACE), STEEL, WOOD).knob("knob", (0.1, 0.63), 0.025)
    return _placed(a.articulation())


def partition(articulation: Articulation, yaw: float = 0.0) -> Partition:
    """Its labels over its mesh, turned about z by ``yaw`` [rad]; joints are forgotten."""
    parents = np.array([-1, *(joint.parent for joint in articulation.joints)])
    return Partition(turned(articulation, yaw).mesh, face_parts(articulation), parents)


def apart(first: np.ndarray, axis: np.ndarray, second: np.ndarray) -> float:
    """Distance [m] of a point from a line."""
    offset = first - second
    return float(np.linalg.norm(offset - axis * (axis @ offset)))
