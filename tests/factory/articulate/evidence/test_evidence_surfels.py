"""Surfels are even, a grid of them is hit through its walls, and frames follow a thing's edges."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box, cylinder

from asset_factory.factory.articulate.evidence.frames import distinct, own_frame
from asset_factory.factory.articulate.evidence.grid import grid_around
from asset_factory.factory.articulate.evidence.surfels import spread
from asset_factory.factory.articulate.geometric.scene import level_frame
from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.mesh import Material

PLAIN = Material("plain")
UP = np.array([0.0, 0.0, 1.0])
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


def test_some_of_few_are_all_and_nothing_without_area_has_any():
    assert len(spread(np.zeros((3, 3, 3)), 10)) == 0
    assert len(spread(np.zeros((0, 3, 3)), 10)) == 0
    found = spread(SQUARE, 20)
    assert found.some(100) is found
    assert len(found.some(7)) == 7


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


def triangles_of(mesh, rotation):
    return mesh.vertices[mesh.faces] @ rotation.T


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.1, 3.1))
def test_level_frame_finds_the_heading_of_the_walls(yaw):
    rotation = rotation_about(UP, yaw)
    frame = level_frame(triangles_of(box((0, 2), (0, 1), (0, 1), PLAIN), rotation))
    assert np.allclose(frame @ frame.T, np.eye(3))
    off = np.degrees(np.arccos(min(np.abs(frame @ rotation)[0].max(), 1.0)))
    assert off <= 0.51


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.1, 3.1), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_own_frame_of_a_plate_is_the_plates(angle, x, y):
    axis = np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    rotation = rotation_about(axis, angle)
    plate = triangles_of(box((0, 1), (0, 0.6), (0, 0.05), PLAIN), rotation)
    frame = own_frame(spread(plate, 512))
    np.testing.assert_allclose(np.abs(frame @ rotation).max(axis=1), 1.0, atol=1e-3)
    assert abs(frame[0] @ rotation[:, 2]) > 0.999


def test_own_frame_of_a_bar_starts_with_its_length():
    tilt = rotation_about(np.array([1.0, 0.0, 0.0]), 0.4)
    bar = triangles_of(cylinder(2, (0, 0), 0.05, (0, 1.0), PLAIN), tilt)
    assert abs(own_frame(spread(bar, 512))[0] @ tilt[:, 2]) > 0.999


def test_distinct_keeps_one_of_frames_that_differ_in_order_only():
    swapped = np.eye(3)[[1, 0, 2]] * [[-1], [1], [1]]
    assert len(distinct([np.eye(3), swapped, rotation_about(UP, 0.3)])) == 2
