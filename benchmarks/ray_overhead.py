"""What Ray costs on one machine: the same calls by the local executor and by its own cluster.

One JSON line: seconds until the first answer, seconds from the first answer to the last, and how
these compare; what each call takes beside its own time, and how much more memory this process has
at the end than after a tenth of the calls (``--seconds 0 --calls 2000`` for these two).
Calls wait instead of working, so that a busy machine disturbs both alike; an asset takes many times
as long as such a call.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from functools import partial
from pathlib import Path

from asset_factory.factory.jobs.executor import Call, Executor
from asset_factory.factory.jobs.local import LocalExecutor
from asset_factory.factory.jobs.ray.executor import RayExecutor
from asset_factory.sim_checks.processes.isolation import Limits

LIMITS = Limits(wall_s=300.0)


def resident() -> float:
    """Memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def timed(executor: Executor, count: int, seconds: float) -> tuple[float, float, float]:
    """Seconds until the first answer, from there to the last, and memory that it grew by [MB]."""
    began = time.monotonic()
    answers = executor.run(
        partial(time.sleep, seconds), (Call(str(number), {}) for number in range(count)), LIMITS
    )
    next(answers)[1].unwrap()
    first = time.monotonic()
    settled = 0.0
    for number, (_, outcome) in enumerate(answers):
        outcome.unwrap()
        last = time.monotonic()
        if number == count // 10:
            settled = resident()
    return first - began, last - first, resident() - settled


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--calls", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    local = timed(LocalExecutor(given.workers), given.calls, given.seconds)
    ray = timed(RayExecutor(given.workers), given.calls, given.seconds)
    told = {
        "claim": "Ray within 10 % of local workers",
        "calls": given.calls,
        "seconds_each": given.seconds,
        "local_start_s": round(local[0] - given.seconds, 2),
        "ray_start_s": round(ray[0] - given.seconds, 2),
        "local_s": round(local[1], 2),
        "ray_s": round(ray[1], 2),
        "ratio": round(ray[1] / local[1], 3),
        "ray_beside_ms": round(
            1000.0 * (ray[1] / (given.calls - 1) - given.seconds / given.workers), 2
        ),
        "ray_grew_mb": round(ray[2], 1),
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
