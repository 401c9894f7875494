"""Pieces are stretched to the surface, and not into what must stay free or is air."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.solids.box import Box
from asset_factory.factory.manufacture.solids.lattice import Lattice
from asset_factory.factory.manufacture.solids.matter import PATH, Matter
from asset_factory.factory.manufacture.solids.reach import FAR_M, reaching

LOW = np.full(3, 0.2)
HIGH = np.full(3, 0.8)


@pytest.fixture
def matter():
    """A block of 0.6 m in a room of 1 m, seen on all of its surface."""
    cells = Lattice.over(np.array([[0.0] * 3, [1.0] * 3]), 25, [[0.2, 0.8]] * 3)
    solid = np.zeros(cells.shape, dtype=bool)
    solid[cells.span(Box(LOW, HIGH))] = True
    grid = np.array(np.meshgrid(*[np.linspace(0.2, 0.8, 31)] * 3)).reshape(3, -1).T
    seen = grid[((np.abs(grid - 0.5) > 0.2999).any(axis=1))]
    return Matter(cells, solid, solid, np.zeros(cells.shape, dtype=np.uint8), seen)


def test_a_piece_that_falls_short_reaches_what_is_seen(matter):
    short = Box(LOW, np.array([0.8, 0.8, 0.75])).hull()
    (reached,) = reaching(matter, [short])
    assert depth_below(reached, matter.sparse).min() >= -FAR_M
    assert reached.volume == pytest.approx(0.6**3, rel=0.02)


def test_pieces_that_cover_all_stay_as_they_are(matter):
    whole = Box(LOW, HIGH).hull()
    (reached,) = reaching(matter, [whole])
    assert reached is whole
    assert reaching(matter, ()) == ()


def test_what_must_stay_free_is_not_filled(matter):
    free = matter.free.copy()
    free[matter.lattice.span(Box(np.array([0.2, 0.2, 0.7]), np.array([0.8, 0.8, 0.76])))] = PATH
    short = Box(LOW, np.array([0.8, 0.8, 0.7])).hull()
    (reached,) = reaching(replace(matter, free=free), [short])
    assert reached.vertices[:, 2].max() < 0.71


def test_air_is_not_filled_to_reach_a_spike(matter):
    spike = np.concatenate([matter.points, [[0.5, 0.5, 0.99]]])
    whole = Box(LOW, HIGH).hull()
    (reached,) = reaching(replace(matter, points=spike), [whole])
    assert reached.vertices[:, 2].max() == pytest.approx(0.8)
