"""One build of thousands of small cabinets: does it grow, leak or slow down?

python benchmarks/soak/long_build.py --assets 2000

One JSON line: assets per second in the first and the second half and their ratio (want about 1); memory [MB], open
files and processes, as the median of the second and of the last tenth of the build; what is left when it is over (want
nothing).
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time
from contextlib import suppress
from dataclasses import astuple, dataclass
from pathlib import Path

from kill_build import build_command, children, processes_of
from meshes import write_meshes
from outcome import leftovers, rows

SHARED_MEMORY = Path("/dev/shm")  # noqa: S108 - looked at, not written to
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")
EVERY_S = 2.0


@dataclass(frozen=True)
class Look:
    """One look at a running build.

    Attributes:
        at: since it began [s].
        done: inputs that have their verdict.
        memory: resident, of the job and all that it started, shared pages counted once per process [MB].
        files: that the job itself has open.
        processes: the job and all that it started.
    """

    at: float
    done: int
    memory: float
    files: int
    processes: int


def look_at(job: int, output: Path, began: float) -> Look:
    """What the build is and has now."""
    processes, open_files, memory = family(job), 0, 0
    with suppress(OSError):
        open_files = len(list(Path(f"/proc/{job}/fd").iterdir()))
    for process in processes:
        with suppress(OSError):
            memory += int(Path(f"/proc/{process}/statm").read_text().split()[1]) * PAGE_BYTES
    done = sum(len(os.listdir(output / name)) for name in ("assets", "rejected") if (output / name).is_dir())
    return Look(time.monotonic() - began, done, memory / 1e6, open_files, len(processes))


def family(job: int) -> list[int]:
    """A process and all its descendants."""
    return [job, *(each for child in children(job) for each in family(child))]


def watched_build(command: list[str], output: Path) -> tuple[int, list[Look]]:
    """Run a build to its end; its exit code, and looks at it on the way."""
    began, looks = time.monotonic(), []
    job = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while job.poll() is None:
        time.sleep(EVERY_S)
        looks.append(look_at(job.pid, output, began))
    return job.returncode, [each for each in looks if each.processes > 1]


def tenth(looks: list[Look], number: int) -> dict[str, float]:
    """Medians over the looks of one tenth of the build, counted from 0."""
    chosen = looks[number * len(looks) // 10 : (number + 1) * len(looks) // 10]
    _, _, memory, files, processes = map(statistics.median, zip(*map(astuple, chosen), strict=True))
    return {"memory_mb": round(memory), "files": files, "processes": processes}


def rate(looks: list[Look], low: int, high: int) -> float:
    """Assets per second between two counts of finished ones."""
    begin = next(each for each in looks if each.done >= low)
    end = next(each for each in looks if each.done >= high)
    return (end.done - begin.done) / (end.at - begin.at)


def main() -> None:
    """Build, watch, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assets", type=int, default=2000)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder, output = Path(name), Path(name) / "out"
        write_meshes(folder / "meshes", given.assets)
        semaphores = len(os.listdir(SHARED_MEMORY))
        code, looks = watched_build(build_command(folder / "meshes", output, given.workers), output)
        # The first assets wait for libraries to load.
        edge = given.assets // 20
        first = rate(looks, edge, given.assets // 2)
        second = rate(looks, given.assets // 2, given.assets - edge)
        left = {
            "processes": processes_of(str(output)),
            "shared_memory": len(os.listdir(SHARED_MEMORY)) - semaphores,
            "half_made": len(leftovers(output)),
        }
        verdicts = [row["status"] for row in rows(output)]
        print(
            json.dumps(
                {
                    "assets": given.assets,
                    "exit_code": code,
                    "verdicts": {status: verdicts.count(status) for status in sorted(set(verdicts))},
                    "minutes": round(looks[-1].at / 60, 1),
                    "first_half_per_s": round(first, 3),
                    "second_half_per_s": round(second, 3),
                    "second_over_first": round(second / first, 3),
                    "second_tenth": tenth(looks, 1),
                    "last_tenth": tenth(looks, 9),
                    "left": left,
                }
            )
        )


if __name__ == "__main__":
    main()
