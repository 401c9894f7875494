"""How many of a sample of real objects become assets, by source, with and without repairs.

    python benchmarks/real_yield.py --data DIR --each 12                  the yield of every repair
    python benchmarks/real_yield.py --data DIR --repairs none geometry    with some switched off
    python benchmarks/real_yield.py --each 999 --output OUT               every object, and keep it
    python benchmarks/real_yield.py --read OUT/all                        of what was built before

``factory build --articulator annotated --sim all`` over objects drawn from each source, printed as
Markdown: registered, hulls, shares of joint ranges and of visible surfaces kept, wall-clock time,
and, with one worker, processor time with that of all processes that a build starts.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import statistics
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.config import REPAIR_KINDS, BuildConfig
from asset_factory.factory.jobs import run_builds
from asset_factory.factory.registry.report_file import read_report
from asset_factory.factory.runtime.layout import ASSETS, LOGS, REJECTED
from asset_factory.sim_checks import Status
from asset_factory.sim_checks.simulators.catalog import USUAL

#: Where the data usually lies: beside the repository.
DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
#: Beginnings of folders that are told apart; all else is ``others``.
SOURCES = ("partnet_mobility", "infinigen_sim", "scene_synthesizer")
#: Among a build's logs: the processor time of each object.
CORE_SECONDS = "core-seconds.jsonl"


@dataclass(frozen=True)
class Made:
    """What became of one object.

    Attributes:
        source: of it.
        reason: why it was rejected, or nothing.
        hulls: of the asset.
        range, coverage, worst: shares kept, 0 to 1.
        seconds: wall-clock time [s].
        core_s: processor time of all processes [s]; 0 where it is not known.
    """

    source: str
    reason: str
    hulls: int
    range: float
    coverage: float
    worst: float
    seconds: float
    core_s: float = 0.0


def main() -> int:
    """Draw, build and print; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA, help="folder of data")
    parser.add_argument("--each", type=int, default=12, help="objects of each source")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--list", type=Path, help="a file of inputs, one a line, instead")
    parser.add_argument("--read", type=Path, nargs="+", help="folders built into before, instead")
    parser.add_argument("--repairs", nargs="+", choices=REPAIR_KINDS, default=["all"])
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--output", type=Path, help="keep what is built, by kind of repair, here")
    options = parser.parse_args()
    if options.read:
        print_table("as built", [made for folder in options.read for made in as_built(folder)])
        return 0
    if not options.data.is_dir():
        print(f"{options.data}: no such folder; name the folder of real objects with --data")
        return 2

    inputs = drawn(options)
    for kinds in options.repairs:
        with kept_or_temporary(options.output, kinds) as folder:
            print_table(f"--repairs {kinds}", list(built(inputs, folder, kinds, options.workers)))
    return 0


@contextmanager
def kept_or_temporary(output: Path | None, kinds: str) -> Iterator[Path]:
    """The folder to build into: one of the user's that stays, or one that does not."""
    if output is not None:
        yield output / kinds
        return
    with tempfile.TemporaryDirectory(prefix="real-") as folder:
        yield Path(folder)


def drawn(options: argparse.Namespace) -> list[Path]:
    """Objects of each source, always the same for one seed."""
    if options.list:
        return [Path(line) for line in options.list.read_text().split()]
    by_source = defaultdict(list)
    with (options.data / "INVENTORY.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["path"].startswith("articulated/"):
                path = options.data / row["path"] / row["main_file"]
                by_source[source_of(path)].append(path)
    chooser = np.random.default_rng(options.seed)
    return [
        found[index]
        for _, found in sorted(by_source.items())
        for index in chooser.permutation(len(found))[: options.each]
    ]


def source_of(path: Path) -> str:
    """Which row of the table an object counts for."""
    folder = path.parent.parent.name
    return next((name for name in SOURCES if folder.startswith(name)), "others")


def built(inputs: Sequence[Path], output: Path, kinds: str, workers: int) -> Iterator[Made]:
    """Every object made and judged by every simulator, into a folder."""
    config = replace(BuildConfig(), articulator="annotated", simulators=USUAL)
    config = replace(config, repair=replace(config.repair, kinds=kinds))
    before = core_seconds()
    for result in run_builds(inputs, output, config, workers):
        made = made_of(output / result.entry.folder, result.seconds, Path(result.input))
        now = core_seconds()
        # A process that was killed takes its time with it: then it is not known.
        made = replace(made, core_s=max(0.0, now - before)) if workers == 1 else made
        yield made
        with (output / LOGS / CORE_SECONDS).open("a", encoding="utf-8") as file:
            file.write(json.dumps({"id": result.entry.id, "core_s": made.core_s}) + "\n")
        before = now
        words = f"{result.entry.status} {result.entry.reason} ({result.seconds:.0f} s)"
        print(f"{result.input}: {words}", file=sys.stderr, flush=True)


def core_seconds() -> float:
    """Processor time of this process, and of all that it ever started, so far [s].

    What has ended counts for its parent, what runs for itself.
    """
    spent = {}
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        process = int(stat.parent.name)
        parents[process] = int(fields[1])
        spent[process] = sum(map(int, fields[11:15]))
    ours = {os.getpid()}
    while True:
        more = {process for process, parent in parents.items() if parent in ours} - ours
        if not more:
            return sum(spent[process] for process in ours) / os.sysconf("SC_CLK_TCK")
        ours |= more


def as_built(output: Path) -> Iterator[Made]:
    """Everything that a build wrote into a folder, by its log."""
    spent = {event["id"]: event["core_s"] for event in _lines(output / LOGS / CORE_SECONDS)}
    for event in _lines(output / LOGS / "builds.jsonl"):
        if event["event"] == "built" and event["status"] != str(Status.UNJUDGED):
            place = ASSETS if event["status"] == str(Status.PASSED) else REJECTED
            made = made_of(output / place / event["id"], event["seconds"], Path(event["input"]))
            yield replace(made, core_s=spent.get(event["id"], 0.0))


def _lines(log: Path) -> list[dict[str, Any]]:
    text = log.read_text(encoding="utf-8") if log.exists() else ""
    return [json.loads(line) for line in text.splitlines()]


def made_of(folder: Path, seconds: float, source: Path) -> Made:
    """What a report says."""
    stored = read_report(folder)
    entry: Any = stored.entry
    kept = stored.report.measurements.get("kept", {})
    return Made(
        source_of(source),
        ""
        if stored.report.passed
        else (stored.report.errors[0].code if stored.report.errors else "?"),
        int(entry["hulls"]),
        float(kept.get("range", 1.0)),
        float(kept.get("coverage", 1.0)),
        float(kept.get("worst_coverage", 1.0)),
        seconds,
    )


def print_table(title: str, rows: Sequence[Made]) -> None:
    """One line for each source, and one for all."""
    print(f"\n{title}\n")
    print(
        "| source | registered | hulls, median / most | range | coverage, mean / worst | s "
        "| core-s |"
    )
    print("|---|---|---|---|---|---|---|")
    for name in (*sorted({row.source for row in rows}), "all"):
        chosen = [row for row in rows if name in (row.source, "all")]
        passed = [row for row in chosen if not row.reason]
        hulls = [row.hulls for row in passed] or [0]
        print(
            f"| {name} | {len(passed)} of {len(chosen)} "
            f"| {statistics.median(hulls):.0f} / {max(hulls)} "
            f"| {_mean([row.range for row in passed]):.2f} "
            f"| {_mean([row.coverage for row in passed]):.3f} / "
            f"{min((row.worst for row in passed), default=1.0):.2f} "
            f"| {_spread([row.seconds for row in chosen])} "
            f"| {_spread([row.core_s for row in chosen])} |"
        )
    rejected = Counter(row.reason for row in rows if row.reason)
    print("\nRejected: " + (", ".join(f"{n} `{code}`" for code, n in rejected.items()) or "none"))


def _spread(values: Sequence[float]) -> str:
    """The one in the middle, and that which a twentieth exceed."""
    times = sorted(values)
    late = times[min(len(times) - 1, int(0.95 * len(times)))]
    return f"{statistics.median(times):.0f}, p95 {late:.0f}" if late > 0.0 else "-"


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 1.0


if __name__ == "__main__":
    sys.exit(main())
