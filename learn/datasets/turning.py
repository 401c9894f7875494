"""A sampled object turned about the vertical."""

from dataclasses import replace

from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.geometry.posing import UP

from ..samples.sampled_object import SampledObject


def turned_sampled(sampled: SampledObject, yaw: float) -> SampledObject:
    """Turn an object and its joints about the vertical through the origin by ``yaw`` [rad]."""
    turn = rotation_about(UP, yaw).T
    return replace(
        sampled,
        points=sampled.points @ turn,
        normals=sampled.normals @ turn,
        axis=sampled.axis @ turn,
        origin=sampled.origin @ turn,
        slide_direction=sampled.slide_direction @ turn,
    )
