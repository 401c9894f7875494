"""What a second worker brings, and what a job costs besides the building.

python benchmarks/soak/scaling.py --assets 60 --rounds 3

One JSON line: seconds that one and two workers took for the same real builds, round by round in
turn; the median of one over twice the other (want 0.9, on two free processors); processor time an
asset with one and with two, which does not mind what else the machine does; the same of calls that
only compute, the most that this machine gives now, and of calls that only wait; then the figures of
``benchmarks/build_overhead.py``.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from job import build_command
from long_build import watched_build
from meshes import write_meshes

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from build_overhead import compute, overhead, speed_up

#: Assets that are not counted: their workers wait for libraries to load.
WARM = 10


@dataclass(frozen=True)
class Run:
    """One build.

    Attributes:
        seconds: from the first assets to the last [s].
        processor: time used by all its processes that lived for a moment [s].
    """

    seconds: float
    processor: float


def build(meshes: Path, output: Path, workers: int) -> Run:
    """Build everything; how long it took once the workers were warm."""
    code, looks = watched_build(
        build_command(meshes, output, workers), output, output.parent / "tmp"
    )
    assert code == 0, f"exit code {code}"
    lines = [
        json.loads(line) for line in (output / "logs" / "builds.jsonl").read_text().splitlines()
    ]
    ended = [moment(line["time"]) for line in lines if line["event"] == "built"]
    return Run(ended[-1] - ended[WARM - 1], looks[-1].processor)


def moment(text: str) -> float:
    """A point in time [s]."""
    return datetime.fromisoformat(text).timestamp()


def main() -> None:
    """In turn one worker and two; then the overhead."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--assets", type=int, default=60)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument(
        "--overhead", type=int, default=1000, help="assets of which the overhead is measured"
    )
    given = parser.parse_args()
    runs: dict[int, list[Run]] = {1: [], 2: []}
    with tempfile.TemporaryDirectory() as name:
        write_meshes(Path(name) / "meshes", given.assets)
        for number in range(given.rounds):
            for workers, into in runs.items():
                into.append(
                    build(Path(name) / "meshes", Path(name) / f"{workers}_{number}", workers)
                )
    seconds = {
        workers: statistics.median(run.seconds for run in of) for workers, of in runs.items()
    }
    print(
        json.dumps(
            {
                "built": given.assets - WARM,
                "one_worker_s": [round(run.seconds, 1) for run in runs[1]],
                "two_workers_s": [round(run.seconds, 1) for run in runs[2]],
                "efficiency": round(seconds[1] / seconds[2] / 2.0, 3),
                "processor_s_an_asset": {
                    workers: round(statistics.median(run.processor for run in of) / given.assets, 3)
                    for workers, of in runs.items()
                },
                "two_workers_computing": round(speed_up(compute), 3),
                "two_workers_waiting": round(speed_up(time.sleep), 3),
                **{name: round(value, 3) for name, value in overhead(given.overhead).items()},
                "load": round(os.getloadavg()[0], 1),
            }
        )
    )


if __name__ == "__main__":
    main()
