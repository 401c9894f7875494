"""Whether hulls meet, and how far apart they are when not."""

from __future__ import annotations

import numpy as np
import pytest
from box_world import box_hull

from asset_factory.sim_checks.collision import Collider
from asset_factory.sim_checks.depth import overlap
from asset_factory.sim_checks.hull import convex_hull

UNIT = (1.0, 1.0, 1.0)


def shifted(x: float) -> np.ndarray:
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


@pytest.mark.parametrize("gap", [1e-5, 1e-4, 1e-3, 0.1])
def test_distance_of_two_boxes(gap: float) -> None:
    first, second = Collider(box_hull((0, 0, 0), UNIT)), Collider(box_hull((0, 0, 0), UNIT))
    second.place(shifted(1.0 + gap))
    assert first.stand(second).depth == pytest.approx(-gap, rel=1e-3, abs=1e-8)


def test_distance_between_corners_is_along_the_diagonal() -> None:
    first, second = Collider(box_hull((0, 0, 0), UNIT)), Collider(box_hull((2, 2, 2), UNIT))
    found = first.stand(second)
    assert found.depth == pytest.approx(-np.sqrt(3.0), rel=1e-4)
    assert found.direction == pytest.approx(np.full(3, 3**-0.5), rel=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_touching_boxes_anywhere_neither_crash_nor_overlap(seed: int) -> None:
    generator = np.random.default_rng(seed)
    size = generator.uniform(0.01, 1.0, size=3)
    first, second = Collider(box_hull((0, 0, 0), size)), Collider(box_hull((size[0], 0, 0), size))
    assert first.stand(second).depth == pytest.approx(0.0, abs=1e-9)


def test_a_hull_inside_another_is_found() -> None:
    outer, inner = Collider(box_hull((0, 0, 0), UNIT)), Collider(box_hull((0, 0, 0), (0.1, 0.1, 0.1)))
    assert outer.stand(inner).depth == pytest.approx(0.55)


def test_moving_a_collider_in_place_is_the_same_as_building_it_there() -> None:
    generator = np.random.default_rng(2)
    points, others = generator.normal(size=(20, 3)), generator.normal(size=(20, 3))
    first, second = Collider(convex_hull(points)), Collider(convex_hull(others))
    for x in (0.0, 1.5, 3.0, 6.0):
        second.place(shifted(x))
        expected = overlap(convex_hull(points), convex_hull(others + np.array([x, 0.0, 0.0]))).depth
        found = first.stand(second).depth
        assert found == pytest.approx(expected, abs=1e-9) if expected > 0 else found < 0
