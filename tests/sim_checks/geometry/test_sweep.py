"""The sweep along a joint is continuous: no pose is missed, and the worst place is found."""

import numpy as np
import pytest
from box_world import box_hull
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.sim_checks.geometry.collision import Collider, LookBudget
from asset_factory.sim_checks.geometry.depth import overlap
from asset_factory.sim_checks.geometry.hull import convex_hull
from asset_factory.sim_checks.geometry.path import JointAxis
from asset_factory.sim_checks.geometry.sweep import Candidate, Sweep, Tolerance

Z = np.array([0.0, 0.0, 1.0])
SMALL = box_hull((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
SLIDE = JointAxis(turning=False, origin=np.zeros(3), axis=np.array([1.0, 0.0, 0.0])).path(1.0)


def swept(path, moving, standing, steps=8):
    return Sweep(path, [Collider(moving)], [Collider(standing)], steps, LookBudget())


def worst(path, moving, standing, **tolerance):
    return swept(path, moving, standing).worst([Candidate(0, 0, 0.0)], Tolerance(**tolerance))


def test_no_search_ends_before_it_knows_on_which_side_of_the_limit_it_falls():
    """A door's back corner at x = w cos + t sin meets a jamb: 1 mm deep at a known angle."""
    width = 0.6
    thickness = 0.05
    jamb_at = 0.60005
    limit = 0.001
    door = box_hull((width / 2, thickness / 2, 0.0), (width, thickness, 1.0))
    jamb = box_hull((jamb_at + 0.05, 0.0, 0.0), (0.1, 0.1, 1.0))
    radius = np.hypot(width, thickness)
    top = np.arctan2(thickness, width)
    exact = top - np.arccos((jamb_at + limit) / radius)
    for beyond in np.linspace(2e-5, 8e-4, 40):
        within, past = (
            worst(JointAxis(True, np.zeros(3), -Z).path(at), door, jamb)
            for at in (exact - beyond, exact + beyond)
        )
        assert within.excess <= limit
        assert past.excess > limit


def test_a_parallel_slide_keeps_its_clearance_and_needs_few_looks():
    sweep = swept(SLIDE, SMALL, box_hull((0.5, 0.102, 0.0), (1.0, 0.1, 1.0)), 64)
    found = sweep.worst([Candidate(0, 0, 0.0)], Tolerance())
    assert found.excess == pytest.approx(-0.002, abs=2e-5)
    assert sweep.looks <= 2


def test_what_stays_wider_apart_than_the_floor_is_not_measured():
    assert worst(SLIDE, SMALL, box_hull((0.5, 0.2, 0.0), (1.0, 0.1, 0.1))) is None


def test_a_moving_hull_that_disappears_inside_another_is_found():
    tiny = box_hull((0, 0, 0), (0.01, 0.01, 0.01))
    found = worst(SLIDE, tiny, box_hull((0.5, 0, 0), (0.4, 0.4, 0.4)))
    assert found.depth == pytest.approx(0.205, rel=0.02)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), turning=st.booleans())
def test_no_sampled_pose_is_worse_than_the_bound_and_the_worst_is_real(seed, turning):
    generator = np.random.default_rng(seed)
    axis = generator.normal(size=3)
    axis /= np.linalg.norm(axis)
    line = JointAxis(turning, generator.normal(size=3), axis)
    path = line.path(generator.uniform(0.5, 6.0 if turning else 3.0))
    moving = convex_hull(generator.normal(size=(10, 3)) * 0.3)
    standing = convex_hull(generator.normal(size=(10, 3)) * 0.3 + generator.normal(size=3))
    found = worst(path, moving, standing, floor=0.1)
    mover = Collider(moving)
    stander = Collider(standing)
    depths = []
    for at in np.linspace(0.0, path.length, 60):
        mover.place(path.pose(at))
        depths.append(mover.stand(stander).depth)
    sampled = max(depths)
    if found is None:
        assert sampled <= -0.1
        return
    assert sampled <= found.bound + 1e-9
    assert found.bound <= found.excess + max(2e-5, 0.02 * abs(found.excess)) + 1e-12
    real = overlap(moving.moved(path.pose(found.at)), standing).depth
    assert found.depth == pytest.approx(real, abs=1e-9) if real > 0.0 else found.depth <= 0.0


@given(
    turning=st.booleans(),
    length=st.floats(0.05, 6.0),
    where=st.lists(st.tuples(*[st.floats(-1.0, 1.0)] * 3), min_size=2, max_size=6),
    floor=st.floats(0.0, 0.05),
)
@settings(max_examples=60, deadline=None)
def test_no_hull_that_comes_near_is_left_out(turning, length, where, floor):
    path = JointAxis(turning, np.array([0.1, -0.2, 0.0]), Z).path(length)
    moving = [Collider(box_hull(at, (0.3, 0.1, 0.2))) for at in where[::2]]
    standing = [Collider(box_hull(at, (0.1, 0.4, 0.2))) for at in where[1::2]]
    sweep = Sweep(path, moving, standing, 16, LookBudget())
    near = sweep.near(floor)
    for row in range(len(moving)):
        for at in np.linspace(0.0, length, 37):
            low, high = sweep.place(row, float(at)).bounds
            for column, other in enumerate(standing):
                apart = np.maximum(low - other.bounds[1], other.bounds[0] - high).max()
                assert near[row, column] or apart >= floor
