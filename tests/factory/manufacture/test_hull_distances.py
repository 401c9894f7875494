"""How far points lie outside the maker's hulls: closed forms, and the nearest of all triangles."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.factory.manufacture.decompose.convex import depth_below, hull_of
from asset_factory.factory.manufacture.decompose.outside import outside, uncovered

SIGNS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
CUBE = hull_of(SIGNS)
#: 20 mm thick at x = 0, an edge at x = 0.4.
WEDGE = hull_of(
    np.array([[x, y, z] for x, z in ((0.0, 0.01), (0.0, -0.01), (0.4, 0.0)) for y in (0.0, 1.0)])
)


@pytest.mark.parametrize(
    ("point", "distance"),
    [
        ((0.9, -0.3, 0.4), 0.0),
        ((1.5, 0.2, -0.7), 0.5),
        ((1.5, 1.5, -0.7), 0.5 * np.sqrt(2.0)),
        ((-1.5, 1.5, -1.5), 0.5 * np.sqrt(3.0)),
    ],
    ids=["inside", "before a face", "beside an edge", "beyond a corner"],
)
def test_a_cube_s_distances_are_exact(point, distance):
    assert outside([CUBE], np.array([point])) == pytest.approx([distance], abs=1e-15)


def test_beyond_a_knife_s_edge_the_distance_is_that_of_the_edge():
    point = np.array([[0.7, 0.5, 0.0]])
    assert -depth_below(WEDGE, point)[0] < 0.008
    assert outside([WEDGE], point) == pytest.approx([0.3], abs=1e-12)
    assert uncovered([WEDGE], point) == pytest.approx(0.3)


def test_without_hulls_everything_is_bare_and_without_points_nothing():
    assert outside([], np.zeros((2, 3))).tolist() == [np.inf, np.inf]
    assert len(outside([CUBE], np.zeros((0, 3)))) == 0
    assert uncovered([CUBE], np.zeros((0, 3))) == 0.0


def to_triangles(points, hull):
    # In units so small that trimesh takes no triangle for a point.
    corners = 1e5 * hull.vertices[hull.faces]
    pairs = 1e5 * np.repeat(points, len(corners), axis=0)
    feet = trimesh.triangles.closest_point(np.tile(corners, (len(points), 1, 1)), pairs)
    return np.linalg.norm(feet - pairs, axis=1).reshape(len(points), -1).min(axis=1) / 1e5


@given(
    seed=st.integers(0, 2**32 - 1),
    corners=st.integers(4, 64),
    size=st.tuples(*[st.floats(1e-3, 1.0)] * 3),
)
@settings(deadline=None)
def test_no_triangle_is_nearer_and_one_is_as_near(seed, corners, size):
    generator = np.random.default_rng(seed)
    shifts = generator.normal(scale=2.0, size=(3, 3))
    found = [hull_of((generator.normal(size=(corners, 3)) + shift) * size) for shift in shifts]
    hulls = [hull for hull in found if hull]
    points = np.concatenate(
        [
            generator.normal(scale=3.0, size=(1100, 3)) * size,
            *(hull.vertices[hull.faces].mean(axis=1) + 1e-4 for hull in hulls),
        ]
    )
    expected = np.full(len(points), np.inf)
    for hull in hulls:
        here = np.where(depth_below(hull, points) >= 0.0, 0.0, to_triangles(points, hull))
        expected = np.minimum(expected, here)
    assert outside(hulls, points) == pytest.approx(expected, abs=1e-7)
