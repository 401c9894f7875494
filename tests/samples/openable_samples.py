"""A registry of small cabinets, exported for the tests of the tasks."""

from dataclasses import replace
from pathlib import Path

import export_samples
import numpy as np
from export_samples import box, boxes_asset

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Asset, Handle
from asset_factory.factory.export import export_bundle
from asset_factory.factory.intake.intake import Provenance
from asset_factory.factory.manufacture.targets.find import find_targets
from asset_factory.factory.mesh import Material

FRONT = np.array([0.0, -1.0, 0.0])
RED = Material("red", (0.8, 0.02, 0.02, 1.0))
#: Generated objects whose parts are convex pieces, so that no decomposition is waited for.
HOUSEHOLD = ("cabinet", "chest", "microwave", "laptop")


def cabinet(lower: float = 0.0) -> Asset:
    """A block with a hinged door and a drawer in front; ``lower`` below 0: input half open."""
    made = export_samples.cabinet((RED,) * 3)
    hinge, slide = made.articulation.joints
    joints = (hinge, replace(slide, lower=lower, upper=0.3 + lower))
    return replace(made, articulation=replace(made.articulation, joints=joints))


def oven() -> Asset:
    """A block on the floor, its door hinged at the bottom edge and leaning out to fall open."""
    meshes = [box([0.0, 0.0, 0.3], [0.6, 0.4, 0.6]), box([0.0, -0.24, 0.3], [0.56, 0.02, 0.6])]
    hinge = Joint("door", JointKind.REVOLUTE, 0, 1, [1, 0, 0], [0.0, -0.212, 0.0], 0.0, 1.5)
    return boxes_asset(meshes, (hinge,), {1: Handle([0.0, -0.25, 0.58], FRONT, FRONT)}, "oven")


def valve() -> Asset:
    """A wheel that turns without end."""
    meshes = [box([0.0, 0.0, 0.4], [0.3, 0.3, 0.8]), box([0.0, -0.2, 0.6], [0.2, 0.05, 0.05])]
    turn = Joint("wheel", JointKind.CONTINUOUS, 0, 1, FRONT, [0.0, -0.2, 0.6], -np.pi, np.pi)
    side = np.array([0.0, 0.0, 1.0])
    return boxes_asset(meshes, (turn,), {1: Handle([0.1, -0.2, 0.6], FRONT, side)}, "valve")


def train() -> Asset:
    """Two blocks on one track, one behind the other: siblings that can only meet."""
    meshes = [box([0.0, 0.0, 0.1], [0.2, 0.2, 0.2])]
    joints = []
    handles = {}
    for part, (name, y) in enumerate({"rear": -0.2, "front": -0.35}.items(), start=1):
        at = [0.0, y, 0.3]
        meshes.append(box(at, [0.1, 0.1, 0.1]))
        joints.append(Joint(name, JointKind.PRISMATIC, 0, part, FRONT, at, 0.0, 0.4))
        handles[part] = Handle([0.0, y - 0.05, 0.3], FRONT, FRONT)
    return boxes_asset(meshes, tuple(joints), handles, "train")


def fin(name: str, height: float = 0.6) -> Asset:
    """A block out of whose front a narrow fin is pulled."""
    at = [0.0, -0.26, height - 0.1]
    meshes = [box([0.0, 0.0, 0.5 * height], [0.4, 0.4, height]), box(at, [0.02, 0.1, 0.12])]
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, FRONT, at, 0.0, 0.15, friction=20.0)
    handle = Handle([0.0, -0.31, height - 0.1], FRONT, FRONT)
    asset = boxes_asset(meshes, (slide,), {1: handle}, name)
    targets = find_targets(asset.articulation, [body.hulls for body in asset.bodies])
    return replace(asset, targets=targets)


def write_registry(root: Path, *assets: Asset) -> Path:
    """``root/assets/<name>`` for each asset."""
    for asset in assets:
        told = Provenance(f"{asset.name}.glb", "0" * 64)
        export_bundle(asset, told, root / "assets" / asset.name)
    return root
