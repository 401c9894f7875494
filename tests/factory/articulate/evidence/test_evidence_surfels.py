"""Surfels: even, oriented, always the same."""

import numpy as np

from asset_factory.factory.articulate.evidence.surfels import spread

SQUARE = np.array([[[0, 0, 0], [2, 0, 0], [2, 1, 0]], [[0, 0, 0], [2, 1, 0], [0, 1, 0]]], float)


def test_surfels_lie_on_the_surface_and_look_across_it():
    found = spread(SQUARE, 200)
    assert len(found) == 200
    assert (found.points[:, 2] == 0).all()
    assert np.allclose(np.abs(found.normals), [0, 0, 1])
    assert (found.points.min(axis=0) >= 0).all()
    assert (found.points[:, :2] <= [2, 1]).all()


def test_every_tenth_of_the_area_gets_a_tenth_of_the_surfels():
    counts, _ = np.histogram(spread(SQUARE, 1000).points[:, 0], bins=10, range=(0, 2))
    assert counts.min() > 80
    assert counts.max() < 120


def test_nothing_without_area_has_surfels():
    assert len(spread(np.zeros((3, 3, 3)), 10)) == 0
    assert len(spread(np.zeros((0, 3, 3)), 10)) == 0


def test_some_of_few_are_all():
    found = spread(SQUARE, 20)
    assert found.some(100) is found
    assert len(found.some(7)) == 7
