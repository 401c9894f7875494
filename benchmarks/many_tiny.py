"""Whether a job's memory is flat over many tiny assets, and what it costs beside the building.

python benchmarks/many_tiny.py --assets 20000

The job, its probes, claims, registry and log, and worker processes are the real ones; what a worker
makes of an input takes no time and has one file. A JSON line at each tenth: assets registered,
memory of the job's process and of all its processes together [MB], and milliseconds an asset so
far; the last line tells how much memory each asset took from the first tenth on [bytes], beside
what the list of inputs took before anything was built.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests" / "samples"), str(ROOT / "benchmarks" / "soak")]

from job_samples import job, pretend, write_inputs  # noqa: E402 - the samples live with the tests
from processes import family, resident_bytes  # noqa: E402 - beside the soak tests

from asset_factory.factory.jobs import LocalExecutor  # noqa: E402 - after the paths
from asset_factory.factory.jobs import job as job_module  # noqa: E402

MB = 1e6


def measured(count: int, workers: int, folder: Path) -> None:
    """Build so many, and print."""
    inputs = write_inputs(folder / "in", count)
    before = resident_bytes(os.getpid())
    began = time.perf_counter()
    first = 0
    listed = 0
    marks = {max(1, count * tenth // 10) for tenth in range(1, 11)}
    results = job(inputs, folder / "out", executor=LocalExecutor(workers)).run()
    for number, result in enumerate(results, start=1):
        assert result.attempts == 1, result
        listed = listed or resident_bytes(os.getpid())
        if number in marks:
            own = resident_bytes(os.getpid())
            first = first or own
            told = {
                "assets": number,
                "job_mb": round(own / MB, 1),
                "all_processes_mb": round(sum(map(resident_bytes, family(os.getpid()))) / MB, 1),
                "ms_an_asset": round(1e3 * (time.perf_counter() - began) / number, 1),
            }
            print(json.dumps(told), flush=True)
    last = resident_bytes(os.getpid())
    told = {
        "bytes_an_asset_built": round((last - first) / max(1, 0.9 * count)),
        "bytes_an_input_listed": round((listed - before) / count),
        "load": round(os.getloadavg()[0], 1),
    }
    print(json.dumps(told))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--assets", type=int, default=20_000)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    job_module.build_here = pretend
    with tempfile.TemporaryDirectory() as folder:
        measured(given.assets, given.workers, Path(folder))


if __name__ == "__main__":
    main()
