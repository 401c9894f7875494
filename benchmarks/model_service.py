"""What one shared network costs and saves: a worker's time and memory, and batches of clouds.

Prints JSON lines: a worker of its own network against one that asks a service; the time of one
question either way and how far the answers differ; and clouds answered one by one against a batch
of them.
"""

from __future__ import annotations

import json
import os
import time
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.articulate.particulate import load_articulator
from asset_factory.factory.config import AutoConfig, ParticulateConfig
from asset_factory.factory.models.particulate.prediction import Prediction
from asset_factory.factory.models.particulate.sampling import Cloud
from asset_factory.factory.models.service import Address, ModelService, asking
from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

QUESTIONS = 8
LIMITS = Limits(wall_s=600.0)


def clouds(count: int, points: int, context_points: int) -> list[tuple[Cloud, Cloud]]:
    """Boxes of points without meaning, as large as those of an asset."""
    return [
        (_cloud(points, number), _cloud(context_points, number + count)) for number in range(count)
    ]


def _cloud(count: int, seed: int) -> Cloud:
    rng = np.random.default_rng(seed)
    numbers = rng.integers(0, 4, count)
    points, normals = rng.uniform(-0.5, 0.5, (2, count, 3)).astype(np.float32)
    return Cloud(points, normals, numbers, numbers > 0, numbers)


def worker(questions: list[tuple[Cloud, Cloud]], address: Address | None = None) -> dict[str, Any]:
    """One worker's questions, to a service if there is one; in a process of its own."""
    began = time.monotonic()
    before = _resident()
    with asking(address):
        network = load_articulator(ParticulateConfig()).network
    answers = [network(*questions[0])]
    first = time.monotonic() - began
    began = time.monotonic()
    answers += [network(*each) for each in questions[1:]]
    each = (time.monotonic() - began) / max(1, len(questions) - 1)
    arrays = [
        getattr(answer, name)
        for answer in answers
        for name in _NAMES
        if getattr(answer, name) is not None
    ]
    return {"first_s": first, "each_s": each, "grown_mib": _resident() - before, "arrays": arrays}


_NAMES = tuple(each.name for each in fields(Prediction))


def _resident() -> float:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20


def batches(questions: list[tuple[Cloud, Cloud]]) -> dict[str, Any]:
    """Time per cloud of the network as it answers, and of its plain form with 1 and more clouds."""
    import torch

    from asset_factory.factory.models.particulate.loading import load_network

    torch.set_num_threads(1)
    learned = load_network(ParticulateConfig())
    network = learned.model._network
    features = learned.model.shape.features
    began = time.monotonic()
    for each in questions:
        learned(*each)
    told = {"streamed_s": (time.monotonic() - began) / len(questions)}
    points, normals = (
        torch.tensor(np.stack([getattr(one, k) for one, _ in questions]))
        for k in ("points", "normals")
    )
    looks = torch.zeros(*points.shape[:2], features)
    with torch.inference_mode():
        for size in (1, 2, 4):
            began = time.monotonic()
            for start in range(0, len(questions), size):
                rows = slice(start, start + size)
                hidden, queries = network(points[rows], normals[rows], looks[rows])
                network.mask_logits(hidden, queries)
            told[f"batches_of_{size}_s"] = (time.monotonic() - began) / len(questions)
    return told


def main() -> None:
    """Measure and print."""
    auto = AutoConfig()
    questions = clouds(QUESTIONS, auto.points, auto.context_points)
    own = run_isolated(worker, questions, limits=LIMITS).unwrap()
    with ModelService(ParticulateConfig()) as service:
        _warm(service.address, questions[:1])
        asked = run_isolated(worker, questions, service.address, limits=LIMITS).unwrap()
        statm = Path(f"/proc/{service.pid}/statm").read_text().split()
        resident = int(statm[1]) * os.sysconf("SC_PAGESIZE") / 2**20
    same = all(
        np.array_equal(one, other)
        for one, other in zip(own.pop("arrays"), asked.pop("arrays"), strict=True)
    )
    print(json.dumps({"claim": "worker with its own network", **_rounded(own)}))
    print(
        json.dumps(
            {
                "claim": "worker that asks",
                **_rounded(asked),
                "service_mib": round(resident),
                "same_bits": same,
            }
        )
    )
    print(
        json.dumps(
            {
                "claim": "clouds at once",
                **_rounded(run_isolated(batches, questions, limits=LIMITS).unwrap()),
            }
        )
    )


def _warm(address: Address, questions: list[tuple[Cloud, Cloud]]) -> None:
    run_isolated(worker, questions, address, limits=LIMITS).unwrap()


def _rounded(numbers: dict[str, Any]) -> dict[str, float]:
    return {name: round(number, 3) for name, number in numbers.items()}


if __name__ == "__main__":
    main()
