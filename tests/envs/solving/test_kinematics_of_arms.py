"""Joint values bring a hand where it is asked to be, whatever tree it is on."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from asset_factory.envs.solving.kinematics import Chain, pose_error, reach


def arm(links, seed):
    """Joints about random axes, 0.3 m apart, the last one sliding."""
    rng = np.random.default_rng(seed)
    before = np.tile(np.eye(4), (links + 1, 1, 1))
    after = np.tile(np.eye(4), (links + 1, 1, 1))
    before[1:, :3, :3] = Rotation.random(links, random_state=seed).as_matrix()
    before[1:, :3, 3] = 0.3 * rng.normal(size=(links, 3)) / np.sqrt(3)
    after[1:, :3, 3] = 0.05
    limits = np.tile([-2.5, 2.5], (links, 1))
    limits[-1] = [0.0, 0.4]
    slides = (False,) * links + (True,)
    parents = (-1, *range(links))
    return Chain(parents, before, after, parents, slides, limits)


@pytest.mark.parametrize("seed", range(4))
def test_the_jacobian_is_the_derivative_of_the_pose(seed):
    chain = arm(6, seed)
    values = np.random.default_rng(seed).uniform(0.0, 0.4, size=(1, 6))
    poses = chain.forward(values, np.eye(4))
    jacobian = chain.jacobian(poses, 6, range(6))[0]
    for column in range(6):
        moved = values.copy()
        moved[0, column] += 1e-6
        there = chain.forward(moved, np.eye(4))[:, 6]
        error = pose_error(poses[:, 6], there)[0]
        assert error / 1e-6 == pytest.approx(jacobian[:, column], abs=1e-4)


def test_a_hand_gets_where_the_arm_can_bring_it():
    chain = arm(8, 3)
    rng = np.random.default_rng(0)
    lower, upper = chain.limits.T
    there = lower + (upper - lower) * rng.uniform(0.2, 0.8, size=(40, 8))
    goals = chain.forward(there, np.eye(4))[:, 8]
    starts = np.clip(there + 0.3 * rng.normal(size=there.shape), lower, upper)
    found, off = reach(chain, 8, np.eye(4), goals, starts, range(8), 60)
    assert (off[:, 0] < 1e-3).mean() > 0.9
    assert (found >= lower).all()
    assert (found <= upper).all()
    best = int(np.argmin(off.sum(axis=1)))
    assert chain.forward(found[[best]], np.eye(4))[0, 8] == pytest.approx(goals[best], abs=1e-3)


def test_joints_that_are_not_free_stay():
    start = np.full((1, 6), 0.2)
    found, _ = reach(arm(6, 1), 6, np.eye(4), np.eye(4)[None], start, (1, 2, 4), 10)
    assert found[0, [0, 3, 5]] == pytest.approx([0.2, 0.2, 0.2])
