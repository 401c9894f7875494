"""Where the network runs: on a GPU that is there and computes, else on the CPU."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

AUTO = "auto"
#: Longest that a device is tried [s].
TRIAL_S = 120.0
#: Without one of these (CUDA, WSL, Jetson, ROCm) there is no GPU to import torch for.
GPU_FILES = ("/dev/nvidiactl", "/dev/dxg", "/dev/nvhost-gpu", "/dev/kfd")


def device_for(name: str) -> str:
    """Return a device as torch names it; of ``auto``, a GPU that runs the network, else the CPU."""
    return name if name != AUTO else next(filter(works, ("cuda", "mps", "cpu")))


@cache
def works(device: str) -> bool:
    """Tell whether the network runs on a device of this machine.

    A GPU is tried in a child process: importing torch takes seconds, and a driver may abort.
    """
    if device == "cpu":
        return True
    if sys.platform != "darwin" and not any(Path(each).exists() for each in GPU_FILES):
        return False
    return bool(run_isolated(runs_on, device, limits=Limits(wall_s=TRIAL_S)).value)


def runs_on(device: str) -> bool:
    """Tell whether torch has a device and computes what networks are made of on it."""
    import torch

    there = {"cuda": torch.cuda.is_available, "mps": torch.backends.mps.is_available}
    if not there[device.split(":", 1)[0]]():
        return False
    layer = torch.nn.TransformerEncoderLayer(d_model=32, nhead=4).to(device).eval()
    return bool(torch.isfinite(layer(torch.ones(8, 1, 32, device=device))).all().cpu())
