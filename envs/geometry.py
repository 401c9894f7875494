"""Where an asset's links and hulls are at given joint values: plain arrays, no simulator."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np
from defusedxml.ElementTree import parse
from scipy.spatial.transform import Rotation

from asset_factory.factory.articulation import JointKind

from .assets import FloatArray, OpenableJoint, RegisteredAsset

#: Stations along a joint's path at which its parts are looked at.
STATIONS = 7


def closed_values(asset: RegisteredAsset) -> dict[str, float]:
    """Return the value of every movable joint of the closed object [rad] or [m]."""
    return {name: asset.closed_value(name) for name in asset.manifest.movable}


def displacements(asset: RegisteredAsset, values: Mapping[str, float]) -> dict[str, FloatArray]:
    """Return by link its transform from all joints at 0 to where it is now, shape [4, 4]."""
    moved: dict[str, FloatArray] = {}
    for joint in asset.manifest.joints:
        motion = np.eye(4)
        axis = np.asarray(joint.axis)
        value = values.get(joint.name, 0.0)
        if joint.kind is JointKind.PRISMATIC:
            motion[:3, 3] = value * axis
        elif joint.movable:
            origin = np.asarray(joint.origin)
            motion[:3, :3] = Rotation.from_rotvec(value * axis).as_matrix()
            motion[:3, 3] = origin - motion[:3, :3] @ origin
        parent = moved.setdefault(joint.parent, np.eye(4))
        moved[joint.child] = parent @ motion
    return moved


def carried_links(asset: RegisteredAsset, link: str) -> frozenset[str]:
    """Return ``link`` and everything it carries."""
    carried = {link}
    for joint in asset.manifest.joints:
        if joint.parent in carried:
            carried.add(joint.child)
    return frozenset(carried)


def hull_boxes(
    asset: RegisteredAsset, values: Mapping[str, float], links: frozenset[str] | None = None
) -> FloatArray:
    """Return the box of every convex piece, the object on the ground [m], shape [hull_count, 2, 3].

    Args:
        asset: whose; its hulls are read once from its URDF.
        values: of the joints [rad] or [m]; those left out are at 0.
        links: only these.
    """
    origins = {joint.child: np.asarray(joint.origin) for joint in asset.manifest.joints}
    moved = displacements(asset, values)
    lift = np.array([0.0, 0.0, asset.manifest.ground_offset])
    boxes = [np.zeros((0, 2, 3))]
    for link, hulls in _hulls(asset.urdf, asset.digest).items():
        if links is not None and link not in links:
            continue
        pose = moved.get(link, np.eye(4))
        for corners in hulls:
            placed = (corners + origins.get(link, 0.0)) @ pose[:3, :3].T + pose[:3, 3] + lift
            boxes.append(np.stack([placed.min(axis=0), placed.max(axis=0)])[None])
    return np.concatenate(boxes)


def handle_path(asset: RegisteredAsset, joint: OpenableJoint, shares: FloatArray) -> FloatArray:
    """Return the handle's path as the joint opens and all else is closed [m], shape [share, 3].

    The object stands on the ground.
    """
    points = []
    for values in opening_values(asset, joint, shares):
        pose = displacements(asset, values)[joint.handle_link]
        points.append(pose[:3, :3] @ joint.rest_point + pose[:3, 3])
    return np.asarray(np.array(points) + np.array([0.0, 0.0, asset.manifest.ground_offset]))


def opening_values(
    asset: RegisteredAsset, joint: OpenableJoint, shares: FloatArray
) -> list[dict[str, float]]:
    """Return joint values [rad] or [m] of the closed object with ``joint`` open by each share."""
    closed = closed_values(asset)
    values = (joint.lower + float(share) * (joint.upper - joint.lower) for share in shares)
    return [{**closed, joint.name: value} for value in values]


@lru_cache(maxsize=256)
def _hulls(urdf: Path, digest: str) -> dict[str, tuple[FloatArray, ...]]:
    """Return corners of every collision mesh in its link's frame, by link; cached by ``digest``."""
    robot = parse(urdf).getroot()
    found = {}
    for link in robot.iter("link"):
        files = [mesh.get("filename", "") for mesh in link.iterfind("collision/geometry/mesh")]
        found[link.get("name", "")] = tuple(_corners(urdf.parent / name) for name in files)
    return found


def _corners(path: Path) -> FloatArray:
    lines = path.read_text(encoding="utf-8").splitlines()
    return np.array([line.split()[1:4] for line in lines if line.startswith("v ")], dtype=float)
