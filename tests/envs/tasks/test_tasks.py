"""Every task: its spaces, its episodes, its state, and what it makes of random steps."""

from copy import deepcopy

import numpy as np
import pytest
from making import make, put, rollout
from openable_samples import HOUSEHOLD

from asset_factory.envs import TASKS


@pytest.fixture(scope="module", params=[task.id for task in TASKS])
def env(request, household):
    made = make(household, request.param)
    yield made
    made.close()


def test_observations_fit_their_space_over_every_asset(env):
    # Every task on one asset, and one of them on all.
    assets = list(env.unwrapped._assets)
    for asset in assets if env.unwrapped.spec.id == "OpenJoint-v1" else assets[:1]:
        observation, info = env.reset(seed=1, options={"asset": asset})
        assert env.unwrapped.asset_record.id == asset
        assert env.observation_space.contains(observation.numpy())
        assert env.unwrapped.single_observation_space.contains(observation[0].numpy())
        assert not bool(info["success"])


def test_a_seed_is_an_episode_without_a_nan(env):
    first = rollout(env, 7, 40)
    again = rollout(env, 7, 40)
    other = rollout(env, 8)
    assert np.isfinite(first).all()
    assert np.array_equal(first, again)
    assert not np.array_equal(first[: len(other)], other)


def test_a_state_can_be_gone_back_to(env):
    task = env.unwrapped
    env.reset(seed=2)
    env.step(np.full(env.action_space.shape, 0.2, dtype=np.float32))
    saved = deepcopy(task.get_state_dict())
    goal = float(task._goal_start[0, 0])
    before = task.get_obs().numpy()
    for _ in range(5):
        env.step(np.full(env.action_space.shape, -0.5, dtype=np.float32))
    task._goal_start += 0.1
    task.set_state_dict(saved)
    assert np.allclose(task.get_obs().numpy(), before, atol=1e-5)
    assert float(task._goal_start[0, 0]) == pytest.approx(goal)
    flat = task.get_state()
    env.reset(seed=9, options={"asset": task.asset_record.id})
    task.set_state(flat)
    assert np.allclose(task.get_state().numpy(), flat.numpy(), atol=1e-5)
    assert np.allclose(task.get_obs().numpy(), before, atol=1e-5)


def test_rewards_are_dense_between_nothing_and_one_and_highest_at_success(env):
    task = env.unwrapped
    env.reset(seed=3)
    joint = task.target
    goal = float(task._goal_start[0, 0])
    judged = put(env, joint.name, joint.lower + goal * (joint.upper - joint.lower))
    assert bool(judged["success"])
    assert float(task.compute_normalized_dense_reward(None, None, judged)) == 1.0
    assert float(task.compute_sparse_reward(None, None, judged)) == 1.0
    away = put(env, joint.name, joint.lower if goal > 0.5 else joint.upper)
    assert not bool(away["success"])
    assert 0.0 <= float(task.compute_normalized_dense_reward(None, None, away)) < 0.9


@pytest.mark.parametrize("robot", ["panda", "fetch"])
def test_nothing_moves_by_itself_and_no_robot_starts_in_the_way(household, robot):
    env = make(household, robot_uids=robot)
    still = np.zeros(env.action_space.shape, dtype=np.float32)
    for asset in HOUSEHOLD:
        env.reset(seed=0, options={"asset": asset})
        assert env.unwrapped.place.clearance > 0.0
        for _ in range(5):
            _, _, _, _, info = env.step(still)
        assert abs(float(info["open_fraction"])) < 0.02
    env.close()


@pytest.mark.full
@pytest.mark.parametrize(
    ("task", "robot"), [*((task.id, "panda") for task in TASKS), ("OpenJoint-v1", "fetch")]
)
def test_a_thousand_steps_are_finite_the_same_again_and_can_be_gone_back_in(household, task, robot):
    env = make(household, task, robot_uids=robot)
    for asset in env.unwrapped._assets:
        rows = rollout(env, 5, 1000, asset=asset, reconfigure=True)
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
        again = rollout(env, 5, 1000, asset=asset, reconfigure=True)
        assert np.array_equal(rows, again), asset
    env.close()
