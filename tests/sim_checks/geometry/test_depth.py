"""Penetration depth of convex polyhedra is exact."""

import numpy as np
import pytest
from box_world import box_hull, random_pose
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from asset_factory.sim_checks.geometry.depth import contact_region, overlap, overlap_along
from asset_factory.sim_checks.geometry.hull import convex_hull

UNIT = (1.0, 1.0, 1.0)


def by_minkowski_difference(a, b):
    """The depth another way: distance of the origin to the hull of all differences of corners."""
    difference = ConvexHull((a.vertices[:, None] - b.vertices[None]).reshape(-1, 3))
    return float((-difference.equations[:, 3]).min())


@pytest.mark.parametrize("depth", [1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.0, -1e-5, -1e-3, -0.1])
def test_depth_of_two_boxes_is_the_overlap_of_their_faces_and_a_gap_is_none(depth):
    found = overlap(box_hull((0, 0, 0), UNIT), box_hull((1.0 - depth, 0.1, 0.2), UNIT))
    assert found.depth == pytest.approx(depth, abs=1e-12)
    assert found.direction == pytest.approx([1.0, 0.0, 0.0])


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), corners=st.integers(4, 30), reach=st.floats(0.0, 2.5))
def test_depth_is_the_distance_out_of_the_minkowski_difference(seed, corners, reach):
    generator = np.random.default_rng(seed)
    a = convex_hull(generator.normal(size=(corners, 3)))
    b = convex_hull(generator.normal(size=(corners, 3)) + np.array([reach, 0.0, 0.0]))
    expected = by_minkowski_difference(a, b)
    found = overlap(a, b)
    if expected > 1e-9:
        assert found.depth == pytest.approx(expected, abs=1e-9)
    else:
        assert found.depth <= 1e-9
    assert overlap_along(a, b, found.direction[None])[0] == pytest.approx(found.depth, abs=1e-12)


def test_round_hulls_of_a_thousand_corners_are_still_exact():
    generator = np.random.default_rng(5)
    points = generator.normal(size=(1000, 3))
    ball = convex_hull(points / np.linalg.norm(points, axis=1)[:, None])
    other = ball.moved(np.array([[1, 0, 0, 1.7], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]))
    found = overlap(ball, other)
    assert 0.29 < found.depth < 0.3
    # No direction at all does better than the one found.
    tried = generator.normal(size=(2000, 3)) * 0.02 + found.direction
    tried /= np.linalg.norm(tried, axis=1)[:, None]
    assert overlap_along(ball, other, tried).min() >= found.depth - 1e-12


offsets = st.sampled_from([-1.1, -0.9, -0.3, 0.0, 0.1, 0.8, 0.9])


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    offset=st.tuples(offsets, offsets, offsets),
    size=st.sampled_from([0.15, 1.0]),
)
def test_contact_region_of_two_boxes_is_their_common_box_however_they_are_turned(
    seed, offset, size
):
    pose = random_pose(seed)
    hulls = (box_hull((0, 0, 0), UNIT), box_hull(offset, (size, size, size)))
    region = contact_region(*(hull.moved(pose) for hull in hulls))
    low = np.maximum(-0.5, np.array(offset) - size / 2)
    high = np.minimum(0.5, np.array(offset) + size / 2)
    if (low > high).any():
        assert len(region) == 0
        return
    corners = (region - pose[:3, 3]) @ pose[:3, :3]
    assert corners.min(axis=0) == pytest.approx(low, abs=1e-7)
    assert corners.max(axis=0) == pytest.approx(high, abs=1e-7)


def test_a_box_has_six_faces_and_twelve_edges():
    hull = box_hull((5.0, 6.0, 7.0), (0.1, 0.2, 0.3))
    assert (len(hull.normals), len(hull.edges), len(hull.vertices)) == (6, 12, 8)
    assert hull.volume == pytest.approx(0.006)
