"""How far points lie outside hulls, the checks' and the maker's: closed forms, and triangles."""

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from asset_factory.factory.manufacture.decompose.convex import hull_of
from asset_factory.factory.manufacture.decompose.outside import outside, uncovered
from asset_factory.sim_checks.geometry.hull import convex_hull, distance_outside

CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
#: 20 mm thick at x = 0, an edge like a knife's at x = 0.4.
WEDGE = np.array([[x, y, z] for x, z in ((0, 0.01), (0, -0.01), (0.4, 0)) for y in (0, 1)])


def by_checks(points, *bodies):
    return distance_outside(points, [convex_hull(body) for body in bodies])


def by_maker(points, *bodies):
    return outside([hull_of(body) for body in bodies], points)


either = pytest.mark.parametrize("measure", [by_checks, by_maker])


@either
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
def test_a_cube_s_distances_are_exact(measure, point, distance):
    assert measure(np.array([point]), CUBE) == pytest.approx([distance], abs=1e-15)


@either
def test_beyond_a_knife_s_edge_the_distance_is_that_of_the_edge(measure):
    # No face plane is nearly as far: each passes within 8 mm.
    assert measure(np.array([[0.7, 0.5, 0.0]]), WEDGE) == pytest.approx([0.3], abs=1e-12)


@either
def test_of_several_hulls_the_nearest_counts(measure):
    # The wedge's planes pass nearer to the point than the cube's, but the cube is nearer.
    cube = 0.1 * CUBE + [0.7, 0.5, 0.12]
    point = np.array([[0.7, 0.5, 0.0]])
    assert measure(point, WEDGE, cube) == pytest.approx([0.02], abs=1e-12)
    assert measure(point, cube, WEDGE) == pytest.approx([0.02], abs=1e-12)


def test_without_hulls_everything_is_bare_and_without_points_nothing():
    assert outside([], np.zeros((2, 3))).tolist() == [np.inf, np.inf]
    assert len(by_maker(np.zeros((0, 3)), CUBE)) == 0
    assert uncovered([hull_of(CUBE)], np.zeros((0, 3))) == 0.0
    assert uncovered([hull_of(WEDGE)], np.array([[0.7, 0.5, 0.0]])) == pytest.approx(0.3)


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
@settings(max_examples=30, deadline=None)
def test_no_triangle_is_nearer_and_one_is_as_near(seed, corners, size, away):
    generator = np.random.default_rng(seed)
    shifts = generator.normal(scale=2.0, size=(3, 3))
    drawn = [away + (generator.normal(size=(corners, 3)) + shift) * size for shift in shifts]
    # The maker has no hulls of what is next to flat.
    bodies = [body for body in drawn if hull_of(body)]
    assume(bodies)
    hulls = [convex_hull(body) for body in bodies]
    on = hulls[0].vertices[hulls[0].triangles].mean(axis=1)
    far = away + generator.normal(scale=3.0, size=(1100, 3)) * size
    points = np.concatenate([far, on, on + 1e-4])
    inside = [(points @ hull.normals.T <= hull.offsets).all(axis=1) for hull in hulls]
    expected = np.min([to_triangles(points, hull) for hull in hulls], axis=0)
    expected[np.any(inside, axis=0)] = 0.0
    for measure in (by_checks, by_maker):
        assert measure(points, *bodies) == pytest.approx(expected, abs=1e-7)
