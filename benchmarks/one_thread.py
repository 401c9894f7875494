"""What one thread of linear algebra per child saves over one per processor; the files must agree.

    python benchmarks/one_thread.py --input MESHES

One JSON line: wall-clock seconds of ``factory build --workers 1`` with every simulator each way,
medians of rounds that take turns, and their ratio. Exit code 1 if any registered file differs.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from asset_factory.factory.runtime.layout import ASSETS
from asset_factory.sim_checks.processes.isolation import processors
from asset_factory.sim_checks.processes.threads import VARIABLES

INPUTS = Path(__file__).resolve().parents[1] / "examples" / "generated"
COMMAND = (sys.executable, "-m", "asset_factory.factory.cli", "build", "--sim", "all")


def seconds_of(inputs: Path, output: Path, threads: int | None) -> float:
    """Wall-clock time of one build [s]; ``None`` leaves the number of threads to the command."""
    unset = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    stated = {} if threads is None else dict.fromkeys(VARIABLES, str(threads))
    started = time.perf_counter()
    subprocess.run(
        [*COMMAND, "--input", str(inputs), "--output", str(output), "--workers", "1"],
        env=unset | stated,
        check=False,
        capture_output=True,
    )
    return time.perf_counter() - started


def files_of(output: Path) -> dict[str, bytes]:
    """Return every file of every registered asset by its path."""
    assets = output / ASSETS
    return {
        str(path.relative_to(assets)): path.read_bytes()
        for path in assets.rglob("*")
        if path.is_file()
    }


def main() -> int:
    """Build the same inputs each way, in turns."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--input", type=Path, default=INPUTS)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    times: dict[int | None, list[float]] = {None: [], processors(): []}
    registered = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(arguments.rounds):
            for threads, seconds in times.items():
                output = Path(folder) / f"{number}-{threads}"
                seconds.append(seconds_of(arguments.input, output, threads))
                registered.append(files_of(output))
    one, many = (statistics.median(seconds) for seconds in times.values())
    same = bool(registered[0]) and all(files == registered[0] for files in registered)
    line = {
        "benchmark": "one_thread",
        "processors": processors(),
        "one_thread_s": round(one, 2),
        "one_per_processor_s": round(many, 2),
        "ratio": round(one / many, 3),
        "files": len(registered[0]),
        "same_bytes": same,
    }
    print(json.dumps(line))
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
