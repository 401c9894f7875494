"""What Ray costs on one machine: the same calls by the local executor and by its own cluster.

One JSON line: seconds until the first answer, seconds from the first answer to the last, and how
these compare. Calls wait instead of working, so that a busy machine disturbs both alike; an asset
takes many times as long as such a call.
"""

from __future__ import annotations

import argparse
import json
import time

from asset_factory.factory.jobs.executor import Call, Executor
from asset_factory.factory.jobs.local import LocalExecutor
from asset_factory.factory.jobs.ray.executor import RayExecutor
from asset_factory.sim_checks.processes.isolation import Limits

LIMITS = Limits(wall_s=300.0)


def wait(seconds: float) -> None:
    """A call that waits, as one does that reads or simulates elsewhere."""
    time.sleep(seconds)


def timed(executor: Executor, count: int, seconds: float) -> tuple[float, float]:
    """Seconds until the first answer, and from there to the last."""
    began = time.monotonic()
    answers = executor.run(
        wait, (Call(str(number), {"seconds": seconds}) for number in range(count)), LIMITS
    )
    next(answers)[1].unwrap()
    first = time.monotonic()
    for _, outcome in answers:
        outcome.unwrap()
        last = time.monotonic()
    return first - began, last - first


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
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
