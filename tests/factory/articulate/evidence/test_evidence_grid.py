"""Through a wall is a hit; along it, away from it and beside it is not."""

import numpy as np
import pytest

from asset_factory.factory.articulate.evidence.grid import grid_around
from asset_factory.factory.articulate.evidence.surfels import spread

CORNERS = np.array([[0, 0.507, 0], [1, 0.507, 0], [1, 0.507, 1], [0, 0.507, 1]])
WALL = CORNERS[[[0, 1, 2], [0, 2, 3]]]


@pytest.fixture(scope="module")
def wall():
    return grid_around(spread(WALL, 20000), np.zeros(3), np.ones(3))


@pytest.mark.parametrize(
    ("point", "heading", "travelled", "hit"),
    [
        ((0.5, 0.511, 0.5), (0, 1, 0), 0.2, True),
        ((0.5, 0.503, 0.5), (0, -1, 0), 0.2, True),
        ((0.5, 0.511, 0.5), (1, 0, 0), 0.2, False),
        ((0.5, 0.8, 0.5), (0, 1, 0), 0.5, False),
        ((0.5, 0.511, 0.5), (0, 1, 0), 0.005, False),
        ((0.5, 1.5, 0.5), (0, 1, 0), 1.0, False),
    ],
    ids=["through", "back through", "along", "far beyond", "touching at rest", "outside"],
)
def test_what_counts_as_a_hit(wall, point, heading, travelled, hit):
    found = wall.hits(*(np.array([each], dtype=float) for each in (point, heading, travelled)))
    assert found.tolist() == [hit]


def test_filled_cells_are_those_of_the_wall(wall):
    points = np.array([[[0.3, 0.507, 0.7], [0.3, 0.3, 0.7]], [[-1, 0.507, 0.5], [0.9, 0.507, 0.1]]])
    assert wall.filled(points).tolist() == [[True, False], [False, True]]
