"""Component features in closed form."""

import numpy as np

from asset_factory.factory.models.particulate.components import (
    COMPONENT_FEATURES,
    component_features,
)


def test_two_components_are_told_by_their_boxes_and_points_by_their_place_in_them():
    points = np.array([[-0.5, 0, 0], [0, 0, 0.2], [0.1, 0, 0], [0.5, 0.4, 0]])
    normals = np.tile([0.0, 0.0, -1.0], (4, 1))
    found = component_features(points, normals, np.array([7, 7, 3, 3]))
    assert found.shape == (4, COMPONENT_FEATURES)
    np.testing.assert_allclose(found[0, :9], [-0.5, 0, 0, 0, 0, 0.2, -0.25, 0, 0.1], atol=1e-6)
    np.testing.assert_allclose(found[2, 9:12], [0.2, 0.2, 0], atol=1e-6)
    np.testing.assert_allclose(found[:, 12:18], np.tile([0, 0, -1, 0, 0, 1], (4, 1)), atol=1e-6)
    np.testing.assert_allclose(found[:, 19], [-1, 1, -1, 1], atol=1e-6)
    np.testing.assert_allclose(found[:, 22:25], np.tile([1.0, 0.4, 0.2], (4, 1)), atol=1e-6)
    # A mesh of one piece says so.
    assert not found[:, 26].any()
    assert component_features(points, normals, np.zeros(4, dtype=np.int64))[:, 26].all()


def test_numbers_of_components_mean_nothing():
    rng = np.random.default_rng(1)
    points = rng.normal(size=(60, 3))
    normals = rng.normal(size=(60, 3))
    components = rng.integers(0, 5, 60)
    renamed = np.array([40, 2, 9, 17, 3])[components]
    found = component_features(points, normals, components)
    np.testing.assert_allclose(found, component_features(points, normals, renamed), rtol=1e-6)
