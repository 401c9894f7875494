"""Objects that are drawn with something open: made closed, and left as they are drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind
from ..asset import Asset, PartBody
from ..geometry.posing import posed
from ..mesh import FloatArray
from ..part import Proposer


def close_seen(drawn: Articulation) -> Articulation:
    """Return an object with the hinges that the detector saw open closed, its new rest."""
    standing = [joint for joint in drawn.movable_joints if _stands_open(drawn, joint)]
    return posed(drawn, {joint.name: joint.lower for joint in standing}) if standing else drawn


def left_open(asset: Asset, drawn: Articulation) -> Asset:
    """Return an asset that was made closed with its rest as it is drawn; itself if that is closed.

    A hinge that lost the angle at which it stands open to a repair opens as far as it goes.
    """
    angles = {
        joint.name: -joint.lower for joint in drawn.movable_joints if _stands_open(drawn, joint)
    }
    made = asset.articulation
    values = {
        joint.name: min(angles[joint.name], joint.upper)
        for joint in made.movable_joints
        if joint.name in angles
    }
    if not values:
        return asset
    poses = made.poses(made.completed(values))
    rest = posed(made, values)
    # A panel is of the closed pose.
    parts = [
        replace(part, panel=part.panel if np.allclose(pose, np.eye(4)) else None)
        for part, pose in zip(rest.parts, poses, strict=True)
    ]
    bodies = [_moved(body, pose) for body, pose in zip(asset.bodies, poses, strict=True)]
    return replace(asset, articulation=replace(rest, parts=tuple(parts)), bodies=tuple(bodies))


def _stands_open(drawn: Articulation, joint: Joint) -> bool:
    """Tell whether the detector saw a part that stands open: of others the line is less sure."""
    seen = drawn.parts[joint.child].is_by(Proposer.DETECTOR)
    return seen and joint.kind is JointKind.REVOLUTE and joint.lower < 0.0


def _moved(body: PartBody, pose: FloatArray) -> PartBody:
    """Return the same body at a pose, shape [4, 4]."""
    rotation = pose[:3, :3]

    def at(points: FloatArray) -> FloatArray:
        return np.asarray(points @ rotation.T + pose[:3, 3])

    tensor = rotation @ body.inertial.tensor @ rotation.T
    center = at(body.inertial.center)
    handle = body.handle and replace(
        body.handle,
        point=at(body.handle.point),
        normal=rotation @ body.handle.normal,
        pull=rotation @ body.handle.pull,
    )
    return replace(
        body,
        hulls=tuple(replace(hull, vertices=at(hull.vertices)) for hull in body.hulls),
        inertial=replace(body.inertial, center=center, tensor=(tensor + tensor.T) / 2.0),
        handle=handle,
    )
