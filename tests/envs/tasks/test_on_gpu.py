"""Hundreds of environments in one scene, over mixed assets, where there is a GPU."""

import pytest
from making import make

torch = pytest.importorskip("torch", reason="torch is not installed")
if not torch.cuda.is_available():
    pytest.skip("no GPU here: torch sees no CUDA device", allow_module_level=True)

ENVS = 256


def test_every_environment_has_an_asset_and_steps(household):
    several = make(household, num_envs=ENVS, sim_backend="physx_cuda", render_backend="none")
    observations, _ = several.reset(seed=0)
    assert observations.shape[0] == ENVS
    assert len({asset.id for asset in several.unwrapped.assets}) > 1
    for _ in range(5):
        observations, rewards, *_ = several.step(several.action_space.sample())
    assert torch.isfinite(observations).all()
    assert rewards.shape == (ENVS,)
    several.close()
