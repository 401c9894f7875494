"""A thousand random steps of every task on every asset: finite and repeatable."""

import numpy as np
import pytest
from making import UNWARNED, make, rollout

from asset_factory.envs import TASKS

pytest.importorskip("mani_skill", reason="mani_skill is not installed")
pytestmark = [pytest.mark.full, *UNWARNED]

STEPS = 1000
IDS = [task.id for task in TASKS]


@pytest.mark.parametrize(
    ("task", "robot"), [*((task, "panda") for task in IDS), ("OpenJoint-v1", "fetch")]
)
def test_a_thousand_steps_are_finite_the_same_again_and_can_be_gone_back_in(household, task, robot):
    env = make(household, task, robot_uids=robot)
    for asset in env.unwrapped._assets:
        rows = rollout(env, 5, STEPS, asset=asset, reconfigure=True)
        assert np.isfinite(rows).all(), asset
        assert np.abs(rows).max() < 1e3, asset
        assert rows[:, -1].min() >= 0.0
        assert rows[:, -1].max() <= 1.0
        state = env.unwrapped.get_state().clone()
        seen = env.unwrapped.get_obs().numpy().copy()
        env.reset(seed=6, options={"asset": asset})
        env.unwrapped.set_state(state)
        assert np.allclose(env.unwrapped.get_state().numpy(), state.numpy(), atol=1e-5), asset
        assert np.allclose(env.unwrapped.get_obs().numpy(), seen, atol=1e-4), asset
        again = rollout(env, 5, STEPS, asset=asset, reconfigure=True)
        assert np.array_equal(rows, again), asset
    env.close()
