"""How far points lie outside hulls: closed forms, and the nearest point of every triangle."""

import numpy as np
import pytest
import trimesh
from box_world import box_hull
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.sim_checks.geometry.hull import convex_hull
from asset_factory.sim_checks.geometry.outside import distance_outside

CUBE = box_hull((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))
#: 20 mm thick at x = 0, an edge like a knife's at x = 0.4.
WEDGE = convex_hull(
    np.array(
        [[x, y, z * (0.4 - x) / 0.4] for x in (0.0, 0.4) for y in (0, 1) for z in (0.01, -0.01)]
    )
)


@pytest.mark.parametrize(
    ("point", "distance"),
    [
        ((0.2, -0.3, 0.4), 0.0),
        ((1.0, 0.5, 0.5), 0.0),
        ((1.5, 0.2, -0.7), 0.5),
        ((1.5, 1.5, -0.7), 0.5 * np.sqrt(2.0)),
        ((-1.5, 1.5, -1.5), 0.5 * np.sqrt(3.0)),
    ],
    ids=["inside", "face", "before a face", "beside an edge", "beyond a corner"],
)
def test_a_cube_s_distances_are_exact(point, distance):
    assert distance_outside(np.array([point]), [CUBE]) == pytest.approx([distance], abs=1e-15)


def test_beyond_a_knife_s_edge_the_distance_is_that_of_the_edge():
    point = np.array([[0.7, 0.5, 0.0]])
    # No face plane is nearly as far: each passes within 8 mm.
    assert (point @ WEDGE.normals.T - WEDGE.offsets).max() < 0.008
    assert distance_outside(point, [WEDGE]) == pytest.approx([0.3], abs=1e-12)


def test_of_several_hulls_the_nearest_counts():
    # The wedge's planes pass nearer to the point than the cube's, but the cube is nearer.
    cube = box_hull((0.7, 0.5, 0.12), (0.2, 0.2, 0.2))
    point = np.array([[0.7, 0.5, 0.0]])
    assert distance_outside(point, [WEDGE, cube]) == pytest.approx([0.02], abs=1e-12)
    assert distance_outside(point, [cube, WEDGE]) == pytest.approx([0.02], abs=1e-12)


def to_triangles(points, hull):
    """Distances to the nearest of a hull's triangles, of points outside it."""
    # Trimesh takes what is smaller than 1e-8 for nothing.
    corners = 1e5 * hull.vertices[hull.triangles]
    pairs = 1e5 * np.repeat(points, len(corners), axis=0)
    feet = trimesh.triangles.closest_point(np.tile(corners, (len(points), 1, 1)), pairs)
    return np.linalg.norm(feet - pairs, axis=1).reshape(len(points), -1).min(axis=1) / 1e5


@given(
    seed=st.integers(0, 2**32 - 1),
    corners=st.integers(4, 64),
    size=st.tuples(*[st.floats(1e-3, 1.0)] * 3),
    away=st.floats(0.0, 10.0),
)
@settings(deadline=None)
def test_no_triangle_is_nearer_and_one_is_as_near(seed, corners, size, away):
    generator = np.random.default_rng(seed)
    hulls = [
        convex_hull(away + (generator.normal(size=(corners, 3)) + shift) * size)
        for shift in generator.normal(scale=2.0, size=(3, 3))
    ]
    on = hulls[0].vertices[hulls[0].triangles].mean(axis=1)
    points = np.concatenate(
        [away + generator.normal(scale=3.0, size=(40, 3)) * size, on, on + 1e-4]
    )
    inside = [(points @ hull.normals.T <= hull.offsets).all(axis=1) for hull in hulls]
    expected = np.min([to_triangles(points, hull) for hull in hulls], axis=0)
    expected[np.any(inside, axis=0)] = 0.0
    assert distance_outside(points, hulls) == pytest.approx(expected, abs=1e-7)
