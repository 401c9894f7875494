"""Environments as the tests make them, and what they do to them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("mani_skill", reason="mani_skill is not installed")

HEADLESS = {"obs_mode": "state", "sim_backend": "physx_cpu"}


def make(registry: Path, task: str = "OpenJoint-v1", **options: Any) -> Any:
    import gymnasium

    options = {**HEADLESS, **options}
    return gymnasium.make(f"asset_factory.envs:{task}", registry=registry, **options)


def put(env: Any, joint: str, value: float) -> dict[str, Any]:
    """Set one joint, at rest, and judge."""
    task = env.unwrapped
    values = task.asset.get_qpos().clone()
    values[:, [j.name for j in task.asset.active_joints].index(joint)] = value
    task.asset.set_qpos(values)
    task.asset.set_qvel(values * 0)
    return task.evaluate()


def rollout(env: Any, seed: int, steps: int = 3, **options: Any) -> Any:
    """Observations and rewards of an episode with fixed actions, one row per step."""
    rng = np.random.default_rng(0)
    observation, _ = env.reset(seed=seed, options=options)
    rows = [np.append(np.ravel(observation), 0.0)]
    for _ in range(steps):
        action = rng.uniform(-1.0, 1.0, size=env.action_space.shape).astype(np.float32)
        observation, reward, *_ = env.step(action)
        rows.append(np.append(np.ravel(observation), float(reward)))
    return np.array(rows)
