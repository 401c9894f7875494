"""What a job costs besides the building, over as many assets as asked for (default 1000).

One JSON line: milliseconds an asset when building takes no time, for scheduler, cache and registry,
how many of them the processor worked, and how the disk was waited for; seconds of the same job
again, in this process and as a command; milliseconds between two calls of one warm worker; and what
two workers do in the time that one needs, over two, for calls that wait and for calls that compute.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from asset_factory.factory.jobs import Call, LocalExecutor
from asset_factory.factory.jobs import job as job_module
from asset_factory.sim_checks.processes.isolation import Limits, processors

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "samples"))

from job_samples import job, pretend, write_inputs  # noqa: E402 - the samples live with the tests

LIMITS = Limits(wall_s=120.0)
CALLS = 24
CALL_S = 0.25
COMMAND = (
    sys.executable,
    "-m",
    "asset_factory.factory.cli",
    "build",
    "--articulator",
    "rigid",
    "--sim",
    "",
)


def compute(seconds: float) -> None:
    """Use the processor for so long."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def seconds_of(workers: int, function: object, count: int, seconds: float) -> float:
    """Wall-clock time of some calls, workers being warm [s]."""
    calls = [Call(str(number), {"seconds": seconds}) for number in range(count)]
    warm = [Call(f"warm-{number}", {"seconds": 0.2}) for number in range(4 * workers)]
    started = 0.0
    for number, _ in enumerate(LocalExecutor(workers).run(function, [*warm, *calls], LIMITS)):  # type: ignore[arg-type]
        if number == len(warm) - 1:
            started = time.perf_counter()
    return time.perf_counter() - started


def speed_up(function: object) -> float:
    """How much faster two workers are than one, over two."""
    one, two = (seconds_of(workers, function, CALLS, CALL_S) for workers in (1, 2))
    return one / two / 2.0


@contextmanager
def syncing() -> Iterator[list[float]]:
    """Within this, how long each wait for the disk took [s]."""
    waits: list[float] = []
    fsync = os.fsync

    def timed(descriptor: int) -> None:
        started = time.perf_counter()
        fsync(descriptor)
        waits.append(time.perf_counter() - started)

    os.fsync = timed
    try:
        yield waits
    finally:
        os.fsync = fsync


def processor_of_children() -> float:
    """Processor time of all processes that were started and are over [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def overhead(count: int) -> dict[str, float]:
    """Of so many assets that take no time to build, and of doing nothing about them again."""
    job_module.build_here = pretend
    with tempfile.TemporaryDirectory() as folder:
        inputs = write_inputs(Path(folder) / "in", count)
        output = Path(folder) / "out"
        started = time.perf_counter()
        worked = time.process_time()
        with syncing() as waits:
            assert all(result.attempts for result in job(inputs, output).run())
        first = time.perf_counter() - started
        worked = time.process_time() - worked
        started = time.perf_counter()
        assert all(result.known for result in job(inputs, output).run())
        again = time.perf_counter() - started
        started = time.perf_counter()
        before = processor_of_children()
        arguments = ("--input", str(Path(folder) / "in"), "--output", str(output))
        subprocess.run([*COMMAND, *arguments], check=True, capture_output=True)
        command = time.perf_counter() - started
        used = processor_of_children() - before
        summary = json.loads((output / "summary.json").read_text())
        assert summary["known"] == count
    return {
        "assets": count,
        "ms_an_asset": 1000.0 * first / count,
        "processor_ms_an_asset": 1000.0 * worked / count,
        # Files of an asset are synced side by side.
        "syncs_an_asset": len(waits) / count,
        "ms_a_sync": 1000.0 * sum(waits) / max(1, len(waits)),
        "again_s": again,
        "again_as_a_command_s": command,
        "again_as_a_command_processor_s": used,
    }


def main() -> None:
    """Build what takes no time to build; then again; then ask workers what takes some."""
    numbers = {
        **overhead(int(sys.argv[1]) if len(sys.argv) > 1 else 1000),
        "ms_a_call": 1000.0 * seconds_of(1, time.sleep, 200, 0.0) / 200,
        "two_workers_waiting": speed_up(time.sleep),
        "two_workers_computing": speed_up(compute),
    }
    rounded = {name: round(value, 3) for name, value in numbers.items()}
    print(json.dumps({**rounded, "processors": processors(), "load": round(os.getloadavg()[0], 1)}))


if __name__ == "__main__":
    main()
