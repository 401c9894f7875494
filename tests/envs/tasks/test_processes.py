"""Several environments as processes do what each would do alone."""

import numpy as np
import pytest
from making import HEADLESS, make

from asset_factory.envs import TASKS, make_processes

LONG = [pytest.param(task.id, 3, 100, marks=pytest.mark.full) for task in TASKS]


@pytest.mark.parametrize(("task", "count", "steps"), [("SetJoint-v1", 2, 3), *LONG])
def test_each_process_behaves_as_a_single_environment_with_its_seed(household, task, count, steps):
    import gymnasium

    several = make_processes(task, count, registry=household, **HEADLESS)
    assert isinstance(several, gymnasium.vector.VectorEnv)
    together, _ = several.reset(seed=5)
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1.0, 1.0, (steps, *several.action_space.shape)).astype(np.float32)
    seen = [several.step(action)[:2] for action in actions]
    several.close()
    for index in range(count):
        single = make(household, task)
        observation, _ = single.reset(seed=5 + index)
        assert np.array_equal(observation[0].numpy(), together[index])
        for action, (observations, rewards) in zip(actions, seen, strict=True):
            observation, reward, terminated, *_ = single.step(action[index])
            assert np.allclose(observation[0].numpy(), observations[index], atol=1e-6)
            assert float(reward) == pytest.approx(float(rewards[index]), abs=1e-6)
            if bool(terminated):
                break
        single.close()
