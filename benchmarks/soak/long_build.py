"""One build of thousands of small cabinets: does it grow, leak or slow down?

python benchmarks/soak/long_build.py --assets 2000

One JSON line: assets per second in the first and the second half and their ratio (want about 1),
and the same of processor time, which does not mind what else the machine does; memory [MB], open
files and processes, as the median of the second and of the last tenth of the build; what is left
when it is over (want nothing).
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from job import build_command, started
from meshes import write_meshes
from outcome import leftovers, rows
from processes import family, left_over, open_files, processor_s, resident_bytes

SHARED_MEMORY = Path("/dev/shm")  # noqa: S108 - looked at, not written to
EVERY_S = 2.0


@dataclass(frozen=True)
class Look:
    """One look at a running build.

    Attributes:
        at: since it began [s].
        done: inputs that have their verdict.
        processor: time used by all that were seen so far [s].
        own_mb: memory of the job itself [MB].
        all_mb: of the job and all that it started, shared pages counted once per process [MB].
        own_files: that the job itself has open.
        all_files: that all of them have.
        processes: the job and all that it started.
    """

    at: float
    done: int
    processor: float
    own_mb: float
    all_mb: float
    own_files: int
    all_files: int
    processes: int


def look_at(job: int, output: Path, began: float, used: dict[int, float]) -> Look:
    """The build's state now; ``used`` holds the processor time of processes, also ended ones."""
    processes = family(job)
    used.update({each: max(used.get(each, 0.0), processor_s(each)) for each in processes})
    done = sum(
        len(os.listdir(output / name))
        for name in ("assets", "rejected")
        if (output / name).is_dir()
    )
    return Look(
        at=time.monotonic() - began,
        done=done,
        processor=sum(used.values()),
        own_mb=resident_bytes(job) / 1e6,
        all_mb=sum(map(resident_bytes, processes)) / 1e6,
        own_files=open_files(job),
        all_files=sum(map(open_files, processes)),
        processes=len(processes),
    )


def watched_build(command: list[str], output: Path, scratch: Path) -> tuple[int, list[Look]]:
    """Run a build to its end; its exit code, and looks at it on the way."""
    began = time.monotonic()
    used = dict[int, float]()
    looks = list[Look]()
    job = started(command, scratch)
    while job.poll() is None:
        time.sleep(EVERY_S)
        looks.append(look_at(job.pid, output, began, used))
    return job.returncode, [each for each in looks if each.processes > 1]


def tenth(looks: list[Look], number: int) -> dict[str, float]:
    """Medians over the looks of one tenth of the build, counted from 0."""
    chosen = looks[number * len(looks) // 10 : (number + 1) * len(looks) // 10]
    names = ("own_mb", "all_mb", "own_files", "all_files", "processes")
    return {
        name: round(statistics.median(getattr(each, name) for each in chosen)) for name in names
    }


def rates(looks: list[Look], low: int, high: int) -> tuple[float, float]:
    """Assets per second, and processor time per asset [s], between two counts of finished ones."""
    begin = next(each for each in looks if each.done >= low)
    end = next(each for each in looks if each.done >= high)
    count = end.done - begin.done
    return count / (end.at - begin.at), (end.processor - begin.processor) / count


def main() -> None:
    """Build, watch, tell."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--assets", type=int, default=2000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument(
        "--max-hours",
        type=float,
        default=24.0,
        help="begin none after so long, and judge by the rest",
    )
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        output = Path(name) / "out"
        scratch = Path(name) / "tmp"
        write_meshes(folder / "meshes", given.assets)
        before = set(os.listdir(SHARED_MEMORY))
        command = build_command(
            folder / "meshes", output, given.workers, "--max-hours", str(given.max_hours)
        )
        code, looks = watched_build(command, output, scratch)
        # The first assets wait for libraries to load.
        done = looks[-1].done
        first, first_s = rates(looks, done // 20, done // 2)
        second, second_s = rates(looks, done // 2, done - done // 20)
        verdicts = [row["status"] for row in rows(output)]
        numbers = {
            "assets": done,
            "exit_code": code,
            "verdicts": {status: verdicts.count(status) for status in sorted(set(verdicts))},
            "minutes": round(looks[-1].at / 60, 1),
            "first_half_per_s": round(first, 3),
            "second_half_per_s": round(second, 3),
            "second_over_first": round(second / first, 3),
            "first_half_processor_s": round(first_s, 3),
            "second_half_processor_s": round(second_s, 3),
            "second_tenth": tenth(looks, 1),
            "last_tenth": tenth(looks, 9),
            "left": {
                "processes": left_over(str(scratch)),
                "shared_memory": sorted(set(os.listdir(SHARED_MEMORY)) - before),
                "temporary": sorted(os.listdir(scratch)),
                "half_made": leftovers(output),
            },
        }
        print(json.dumps(numbers))


if __name__ == "__main__":
    main()
