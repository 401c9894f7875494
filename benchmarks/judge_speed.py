"""One warm judge for many assets against one child process per call: seconds an asset by engine.

One JSON line: wall-clock seconds an asset each way and their ratio; how much simulators side by
side add; what one static examination takes, which a build saves for its last round; and each
simulator's own seconds for loading, link poses and all motion, in a child that is warm.
"""

from __future__ import annotations

import json
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from asset_factory.sim_checks.checks.agreement import pose_samples
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.judge import Judge, run_checks
from asset_factory.sim_checks.processes.isolation import WarmChild, processors
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.simulators.catalog import SIMULATORS, installed
from asset_factory.sim_checks.simulators.observe import observe

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "samples"))

from fault_corpus.realistic import made  # noqa: E402 - it lives with the tests

OBJECTS = (
    ("cabinet", 1),
    ("oven", 1),
    ("fridge", 1),
    ("microwave", 1),
    ("laptop", 1),
    ("cabinet", 2),
)


def seconds_each(judge: Callable[[Path], object], files: Sequence[Path]) -> float:
    """Median wall-clock time of one file [s]."""
    times = []
    for path in files:
        started = time.perf_counter()
        judge(path)
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def engine_seconds(name: str, files: Sequence[Path], config: CheckConfig) -> float:
    """Median time of one look at a file by one engine in a warm child [s]."""
    described = {path: read_description(path) for path in files}
    with WarmChild() as child:

        def look(path: Path) -> None:
            samples = pose_samples(described[path])
            child.call(
                observe, name, path, config.motion, samples, limits=config.child.limits
            ).unwrap()

        look(files[0])
        return seconds_each(look, files)


def main() -> None:
    """Judge the same files each way; the reports must not differ."""
    engines = tuple(name for name in SIMULATORS if installed(name))
    config = CheckConfig()
    with tempfile.TemporaryDirectory() as folder:
        files = [made(kind, seed, "urdf")(Path(folder) / str(seed)) for kind, seed in OBJECTS]
        cold = seconds_each(lambda path: run_checks(path, engines), files)
        with Judge() as judge:
            assert judge.check(files[0], engines) == run_checks(files[0], engines)
            warm = seconds_each(lambda path: judge.check(path, engines), files)
            static = seconds_each(judge.examine, files)
        with Judge(workers=processors()) as judge:
            judge.check(files[0], engines)
            together = seconds_each(lambda path: judge.check(path, engines), files)
        each = {name: round(engine_seconds(name, files, config), 3) for name in engines}
    line = {
        "benchmark": "judge_speed",
        "assets": len(files),
        "simulators": list(engines),
        "cold_s": round(cold, 3),
        "warm_s": round(warm, 3),
        "times_faster": round(cold / warm, 1),
        "processors": processors(),
        "warm_side_by_side_s": round(together, 3),
        "static_s": round(static, 3),
        "loading_and_motion_s": each,
    }
    print(json.dumps(line))


if __name__ == "__main__":
    main()
