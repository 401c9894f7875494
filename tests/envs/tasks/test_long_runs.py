"""A thousand random steps of every task on every asset: finite and repeatable."""

import numpy as np
import pytest
from making import UNWARNED, make

from asset_factory.envs import TASKS

pytest.importorskip("mani_skill", reason="mani_skill is not installed")
pytestmark = [pytest.mark.full, *UNWARNED]

STEPS = 1000
IDS = [task.id for task in TASKS]


def long_run(env, asset):
    """Observation and reward of every step, the state half way, and what was seen there."""
    env.reset(seed=5, options={"asset": asset, "reconfigure": True})
    env.action_space.seed(5)
    rows = []
    for step in range(STEPS):
        observation, reward, *_ = env.step(env.action_space.sample())
        rows.append(np.append(observation.numpy().ravel(), float(reward)))
        if step == STEPS // 2:
            middle = env.unwrapped.get_state().clone()
            seen = env.unwrapped.get_obs().numpy().copy()
    return np.array(rows), middle, seen


@pytest.mark.parametrize(
    ("task", "robot"), [*((task, "panda") for task in IDS), ("OpenJoint-v1", "fetch")]
)
def test_a_thousand_steps_are_finite_the_same_again_and_can_be_gone_back_in(household, task, robot):
    env = make(household, task, robot_uids=robot)
    for asset in env.unwrapped._assets:
        rows, middle, seen = long_run(env, asset)
        assert np.isfinite(rows).all(), asset
        assert np.abs(rows).max() < 1e3, asset
        assert rows[:, -1].min() >= 0.0
        assert rows[:, -1].max() <= 1.0
        env.unwrapped.set_state(middle)
        assert np.allclose(env.unwrapped.get_state().numpy(), middle.numpy(), atol=1e-5), asset
        assert np.allclose(env.unwrapped.get_obs().numpy(), seen, atol=1e-4), asset
        again, *_ = long_run(env, asset)
        assert np.array_equal(rows, again), asset
    env.close()
