"""Convex hulls: exact while small, thinned within bounds when large, none from nothing."""

import numpy as np
import pytest

from asset_factory.sim_checks.geometry.hull import (
    MOST_CORNERS,
    FlatHull,
    convex_hull,
    farthest_along,
)
from asset_factory.sim_checks.geometry.placing import spread_directions as ball
from asset_factory.sim_checks.read.primitives import box


def test_a_hull_of_few_corners_is_exact():
    points = ball(MOST_CORNERS)
    hull = convex_hull(points)
    assert hull.corners == len(hull.vertices) == MOST_CORNERS
    assert (points @ hull.normals.T - hull.offsets).max() <= 1e-12


@pytest.mark.parametrize("stretch", [(1.0, 1.0, 1.0), (1.0, 0.1, 0.02)])
def test_a_hull_of_many_corners_is_thinned_and_loses_little(stretch):
    points = ball(20_000) * stretch
    hull = convex_hull(points)
    assert hull.corners == 20_000
    assert len(hull.vertices) <= MOST_CORNERS
    bounds = np.array([points.min(axis=0), points.max(axis=0)])
    assert hull.bounds == pytest.approx(bounds, abs=1e-12)
    assert 0.996 < hull.volume / (4.0 / 3.0 * np.pi * np.prod(stretch)) < 1.0
    whole = ball(20_000)
    thinned = hull.vertices / stretch
    directions = whole[::7]
    assert (farthest_along(whole, directions) - farthest_along(thinned, directions)).max() < 0.005


def test_the_same_points_give_the_same_hull_again_and_others_another():
    points = ball(10_000)
    assert convex_hull(points).vertices.tobytes() == convex_hull(points.copy()).vertices.tobytes()
    assert convex_hull(2.0 * points).volume == pytest.approx(8.0 * convex_hull(points).volume)


def test_points_within_do_not_count_as_corners():
    assert convex_hull(np.vstack([box(np.array([3.0, 3.0, 3.0]))[0], ball(10_000)])).corners == 8


@pytest.mark.parametrize(
    "points",
    [
        np.zeros((3, 3)),
        ball(100) * [1.0, 1.0, 0.0],
        ball(100) * 1e-200,
        np.full((8, 3), np.nan),
        ball(100) * np.array([1.0, np.inf, 1.0]),
    ],
    ids=["few", "flat", "nothing", "nan", "infinite"],
)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_what_spans_no_volume_is_said_to(points):
    with pytest.raises(FlatHull):
        convex_hull(points)
