"""Several environments as processes do what each would do alone."""

import numpy as np
import pytest
from making import HEADLESS, UNWARNED, make

from asset_factory.envs import make_processes

pytest.importorskip("mani_skill", reason="mani_skill is not installed")
pytestmark = UNWARNED


def test_each_process_behaves_as_a_single_environment_with_its_seed(household):
    import gymnasium

    several = make_processes("SetJoint-v1", 2, registry=household, **HEADLESS)
    assert isinstance(several, gymnasium.vector.VectorEnv)
    together, _ = several.reset(seed=5)
    action = np.full(several.action_space.shape, 0.3, dtype=np.float32)
    steps = [several.step(action)[:2] for _ in range(3)]
    several.close()
    single = make(household, "SetJoint-v1")
    for index in range(2):
        observation, _ = single.reset(seed=5 + index)
        assert np.array_equal(observation[0].numpy(), together[index])
        for observations, rewards in steps:
            observation, reward, *_ = single.step(action[index])
            assert np.allclose(observation[0].numpy(), observations[index], atol=1e-6)
            assert float(reward) == pytest.approx(float(rewards[index]), abs=1e-6)
    single.close()
