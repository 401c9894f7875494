"""What Ray costs on one machine: the same calls by the local executor and by its own cluster.

One JSON line: seconds until the first answer, seconds from the first answer to the last, and how
these compare; what each call takes beside its own time, and how much more memory this process has
at the end than after a tenth of the calls (``--seconds 0 --calls 2000`` for these two).
``pack_ms`` is what the head takes to pack an input of one file of a megabyte, ``pack_many_ms`` one
of a description and a hundred meshes of ten kilobytes, for nodes that do not see them.
Calls wait instead of working, so that a busy machine disturbs both alike; an asset takes many times
as long as such a call.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from functools import partial
from pathlib import Path

from asset_factory.factory.jobs.executor import Call, Executor
from asset_factory.factory.jobs.local import LocalExecutor
from asset_factory.factory.jobs.ray.executor import RayExecutor
from asset_factory.factory.jobs.ray.inputs import pack_input
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


def packing(meshes: int, size: int) -> float:
    """Time to pack a description with so many meshes of a size [bytes], or one mesh alone [ms]."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number in range(meshes):
            (folder / f"{number}.stl").write_bytes(os.urandom(size))
        named = (f'<mesh filename="{number}.stl"/>' for number in range(meshes))
        (folder / "all.urdf").write_text(f"<robot>{''.join(named)}</robot>", encoding="utf-8")
        source = folder / ("all.urdf" if meshes > 1 else "0.stl")
        tries = []
        for _ in range(5):
            began = time.perf_counter()
            packed = pack_input(source, frozenset())
            tries.append(1e3 * (time.perf_counter() - began))
        assert len(packed.names) == (meshes + 1 if meshes > 1 else 1)
        return min(tries)


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
        "pack_ms": round(packing(1, 1_000_000), 1),
        "pack_many_ms": round(packing(100, 10_000), 1),
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
