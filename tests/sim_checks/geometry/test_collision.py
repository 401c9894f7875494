"""Whether hulls meet, and how far apart they are when not."""

import numpy as np
import pytest
from box_world import box_hull
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from asset_factory.sim_checks.geometry.collision import Collider
from asset_factory.sim_checks.geometry.depth import overlap_along, widest_gap
from asset_factory.sim_checks.geometry.hull import convex_hull
from asset_factory.sim_checks.geometry.kinematics import rotation_about
from asset_factory.sim_checks.read.primitives import box, ellipsoid


@pytest.mark.parametrize("seed", range(5))
def test_touching_boxes_anywhere_neither_crash_nor_overlap(seed):
    size = np.random.default_rng(seed).uniform(0.01, 1.0, size=3)
    first, second = (Collider(box_hull((x, 0, 0), size)) for x in (0, size[0]))
    assert first.stand(second).depth == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("angle", [0.05, 0.7, 1.5])
@pytest.mark.parametrize("gap", [1e-4, 1e-2])
def test_long_crossed_rods_are_as_far_apart_as_they_are(angle, gap):
    """Two rods of 3 m on edge, crossed in any pose: a direction off by 1e-4 costs 0.3 mm."""
    across = ((0.01, 0), (-0.01, 0), (0, 0.01), (0, -0.01))
    half = np.array([[x, y, z] for x in (-1.5, 1.5) for y, z in across])
    turned = rotation_about(np.array([0.0, 0.0, 1.0]), angle)
    for seed in range(5):
        axis, place = np.random.default_rng(seed).normal(size=(2, 3))
        view = rotation_about(axis / np.linalg.norm(axis), 1.0 + seed)
        below = convex_hull(half @ view.T + place)
        above = convex_hull((half @ turned.T + [0.0, 0.0, 0.02 + gap]) @ view.T + place)
        found = Collider(below).stand(Collider(above))
        assert -found.depth == pytest.approx(gap, rel=2e-5, abs=1e-9)
        assert -found.depth <= gap + 1e-9


def test_a_ball_before_a_slab_is_as_far_away_as_it_is_where_fcl_points_elsewhere():
    whole, turn = (Rotation.random(random_state=np.random.default_rng(seed)) for seed in (8, 1))
    ball = turn.apply(ellipsoid(np.full(3, 0.03125))[0])
    ball[:, 2] += 0.5 + 0.03125 + 0.001334
    slab, _ = box(np.array([4.0, 4.0, 1.0]))
    first, second = (Collider(convex_hull(whole.apply(points))) for points in (slab, ball))
    assert first.stand(second).depth == pytest.approx(0.5 - ball[:, 2].min(), rel=1e-6)


def test_hulls_that_share_one_corner_have_no_gap():
    corners, _ = box(np.ones(3))
    diagonal = np.full(3, 3.0**-0.5)
    found = widest_gap(convex_hull(corners - 0.5), convex_hull(corners + 0.5), diagonal)
    assert (found.depth, *found.direction) == pytest.approx((0.0, *diagonal), abs=1e-12)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_widest_gap_is_the_distance(seed):
    """No point is nearer to the other hull than the gap; no nearby direction separates more."""
    generator = np.random.default_rng(seed)
    a = convex_hull(generator.normal(size=(12, 3)))
    b = convex_hull(generator.normal(size=(12, 3)) + np.array([8.0, 0.0, 0.0]))
    along_x = np.array([1.0, 0.0, 0.0])
    assume(overlap_along(a, b, along_x[None])[0] < 0.0)
    found = widest_gap(a, b, along_x)
    weights = generator.dirichlet(np.full(len(a.vertices), 0.2), 500) @ a.vertices
    others = generator.dirichlet(np.full(len(b.vertices), 0.2), 500) @ b.vertices
    assert np.linalg.norm(weights - others, axis=1).min() >= -found.depth - 1e-9
    tried = found.direction + 0.01 * generator.normal(size=(200, 3))
    tried /= np.linalg.norm(tried, axis=1)[:, None]
    assert overlap_along(a, b, tried).min() >= found.depth - 1e-9
