"""Many environments at once on a GPU, over a registry of mixed assets: steps a second, and memory.

python benchmarks/parallel_envs.py REGISTRY --envs 1 16 64 256

A JSON line for each number of environments: environment steps a second with random actions and
state observations, memory of the GPU that all its users hold [MB], and how many hulls the assets
that were drawn have. What PhysX does not take on a GPU is left out of a registry that ``factory
registry export --where "gpu_ready = yes"`` wrote. Without a GPU it says so, with exit code 2.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from pathlib import Path

from asset_factory.factory.registry import Registry

WARM_STEPS = 10


def measured(registry: Path, envs: int, steps: int) -> dict[str, object]:
    """Step so many environments so often."""
    import gymnasium
    import torch

    environment = gymnasium.make(
        "asset_factory.envs:OpenJoint-v1",
        registry=registry,
        num_envs=envs,
        sim_backend="physx_cuda",
        obs_mode="state",
        render_backend="none",
    )
    environment.reset(seed=0)
    for _ in range(WARM_STEPS):
        environment.step(environment.action_space.sample())
    torch.cuda.synchronize()
    started = time.perf_counter()
    for _ in range(steps):
        environment.step(environment.action_space.sample())
    torch.cuda.synchronize()
    seconds = time.perf_counter() - started
    free, whole = torch.cuda.mem_get_info()
    rows = {entry.id: entry.hulls for entry in Registry(registry).entries()}
    hulls = [rows[asset.id] for asset in environment.unwrapped.assets]
    environment.close()
    return {
        "envs": envs,
        "env_steps_per_s": round(envs * steps / seconds),
        "gpu_mb": round((whole - free) / 1e6),
        "hulls_median": statistics.median(hulls),
        "hulls_most": max(hulls),
        "device": torch.cuda.get_device_name(),
    }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("registry", type=Path)
    parser.add_argument("--envs", type=int, nargs="+", default=[1, 16, 64, 256])
    parser.add_argument("--steps", type=int, default=100)
    given = parser.parse_args()
    import torch

    if not torch.cuda.is_available():
        print("no GPU here: torch sees no CUDA device", file=sys.stderr)
        return 2
    for envs in given.envs:
        print(json.dumps(measured(given.registry, envs, given.steps)), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
