"""Where an asset's links and hulls are at given joint values: plain arrays, no simulator."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from asset_factory.sim_checks.description import Link
from asset_factory.sim_checks.geometry.kinematics import Tree, build_tree
from asset_factory.sim_checks.read.document import parse_document
from asset_factory.sim_checks.read.urdf import read_urdf

from .assets import FloatArray, OpenableJoint, RegisteredAsset

#: Stations along a joint's path at which its parts are looked at.
STATIONS = 7


def links_of(asset: RegisteredAsset) -> tuple[tuple[Link, ...], Tree]:
    """Return an asset's links, without their visuals, and the tree that poses them.

    They are read once from its URDF.
    """
    return _read_links(asset.urdf, asset.digest)


def carried_links(asset: RegisteredAsset, joint: OpenableJoint) -> frozenset[str]:
    """Return the links that a joint moves."""
    _, tree = links_of(asset)
    return tree.below(next(line for line in tree.order if line.name == joint.name))


def hull_boxes(
    asset: RegisteredAsset, values: Mapping[str, float], links: frozenset[str]
) -> FloatArray:
    """Return the box of every convex piece, the object on the ground [m], shape [hull_count, 2, 3].

    Args:
        asset: whose.
        values: of the joints [rad] or [m]; as for :meth:`.Tree.link_poses`.
        links: whose pieces.
    """
    found, tree = links_of(asset)
    poses = tree.link_poses(values)
    lift = np.array([0.0, 0.0, asset.manifest.ground_offset])
    boxes = [np.zeros((0, 2, 3))]
    for link in found:
        pose = poses[link.name]
        for hull in link.collisions if link.name in links else ():
            placed = hull.vertices @ pose[:3, :3].T + pose[:3, 3] + lift
            boxes.append(np.stack([placed.min(axis=0), placed.max(axis=0)])[None])
    return np.concatenate(boxes)


def handle_path(asset: RegisteredAsset, joint: OpenableJoint, shares: FloatArray) -> FloatArray:
    """Return the handle's path as the joint opens and all else is closed [m], shape [share, 3].

    The object stands on the ground.
    """
    _, tree = links_of(asset)
    points = []
    for values in opening_values(asset, joint, shares):
        pose = tree.link_poses(values)[joint.handle_link]
        points.append(pose[:3, :3] @ joint.point + pose[:3, 3])
    return np.asarray(np.array(points) + np.array([0.0, 0.0, asset.manifest.ground_offset]))


def closed_values(asset: RegisteredAsset) -> dict[str, float]:
    """Return the values of the closed object's joints that follow no other [rad] or [m]."""
    return {joint.name: asset.closed_value(joint.name) for joint in links_of(asset)[1].free}


def opening_values(
    asset: RegisteredAsset, joint: OpenableJoint, shares: FloatArray
) -> list[dict[str, float]]:
    """Return joint values [rad] or [m] of the closed object with ``joint`` open by each share."""
    closed = closed_values(asset)
    values = (joint.lower + float(share) * (joint.upper - joint.lower) for share in shares)
    return [{**closed, joint.name: value} for value in values]


def drop_visuals(robot: ElementTree.Element) -> None:
    """Take the visuals out of a URDF."""
    for link in robot.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)


@lru_cache(maxsize=256)
def _read_links(urdf: Path, digest: str) -> tuple[tuple[Link, ...], Tree]:
    """Return what :func:`links_of` does; cached by ``digest``."""
    robot = parse_document(urdf)
    drop_visuals(robot)
    description = read_urdf(urdf, robot)
    return description.links, build_tree(description)
