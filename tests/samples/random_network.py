"""A network that knows nothing and is sure of it: random smooth labels, trees and motions."""

import numpy as np

from asset_factory.factory.models.particulate.prediction import Prediction
from asset_factory.factory.models.particulate.sampling import Cloud

PARTS = 16


def cloud_of(count, seed=0):
    """Points that are on nothing, of three components."""
    rng = np.random.default_rng(seed)
    numbers = rng.integers(0, 3, count)
    points, normals = rng.uniform(-0.5, 0.5, (2, count, 3)).astype(np.float32)
    return Cloud(points, normals, numbers, numbers > 0, numbers)


def random_network(cloud, context, least_confidence=0.0):
    """The same answer for the same points."""
    points = cloud.points
    assert np.isfinite(points).all()
    assert np.isfinite(cloud.normals).all()
    assert np.abs(points).max() <= 0.5 + 1e-9
    assert np.abs(context.points).max() <= 0.5 + 1e-9
    rng = np.random.default_rng(11)
    mask = np.sin(points @ rng.normal(size=(3, PARTS)) * 6.0 + rng.uniform(0, 6, PARTS)) * 4.0
    return Prediction(
        mask_logits=mask,
        hierarchy_logits=rng.normal(size=(PARTS, PARTS)) * 3,
        motion_logits=rng.normal(size=(PARTS, 4)) * 3,
        revolute_direction=rng.normal(size=(PARTS, 3)),
        revolute_range=rng.normal(size=(PARTS, 2)),
        prismatic_direction=rng.normal(size=(PARTS, 3)),
        prismatic_range=rng.normal(size=(PARTS, 2)) * 0.3,
        closest_points=points * 0.1,
    )
