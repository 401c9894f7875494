"""Real objects, built from nothing, against what became of them before.

    python benchmarks/real_objects.py --data DIR           exit code 1 where anything differs
    python benchmarks/real_objects.py --data DIR --write   state anew what becomes of them

``real_objects.csv`` names the objects, and for each its verdict, reason, parts, joints, hulls,
worst clearance [mm] and repairs with every simulator. It changes only on purpose, in a commit that
says why. An input that could not be judged fails the run whatever the table says.
"""

from __future__ import annotations

import argparse
import csv
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.jobs import run_builds
from asset_factory.factory.registry import Entry
from asset_factory.factory.registry.report_file import read_report
from asset_factory.sim_checks import Status
from asset_factory.sim_checks.measurements import penetrations
from asset_factory.sim_checks.simulators.catalog import USUAL

TABLE = Path(__file__).with_suffix(".csv")
#: Where the data usually lies: beside the repository.
DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


@dataclass(frozen=True)
class Outcome:
    """What became of one object.

    Attributes:
        input: path within the folder of data.
        articulator: that was asked.
        status, reason, parts, joints, hulls: as in the registry.
        clearance_mm: smallest gap between two parts' hulls, at rest and along every joint [mm];
            negative where they overlap, empty where nothing comes near.
        repairs: the first word of each.
    """

    input: str
    articulator: str
    status: str
    reason: str
    parts: str
    joints: str
    hulls: str
    clearance_mm: str
    repairs: str


def main() -> int:
    """Build and compare, or build and state; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA, help="folder of data")
    parser.add_argument("--write", action="store_true", help="state anew what becomes of them")
    parser.add_argument("--only", default="", help="objects whose path holds this")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    if not options.data.is_dir():
        print(f"{options.data}: no such folder; name the folder of real objects with --data")
        return 2

    stated = read_table()
    chosen = [row for row in stated if options.only in row.input]
    began = time.monotonic()
    found = {}
    for row in built(chosen, options):
        found[row.input, row.articulator] = row
        if options.write:
            # After each, so that an interrupted run has not run for nothing.
            write_table([found.get((each.input, each.articulator), each) for each in stated])
    print(f"{len(found)} objects in {time.monotonic() - began:.0f} s", file=sys.stderr)

    if options.write:
        return 0
    differences = [line for row in chosen for line in compared(row, found)]
    print("\n".join(differences) or "as stated")
    return 1 if differences else 0


def built(rows: Sequence[Outcome], options: argparse.Namespace) -> Iterator[Outcome]:
    """Build the objects of some rows from nothing, with every simulator."""
    for articulator in dict.fromkeys(row.articulator for row in rows):
        config = replace(BuildConfig(), articulator=articulator, simulators=USUAL)
        names = {
            str(options.data / row.input): row for row in rows if row.articulator == articulator
        }
        with tempfile.TemporaryDirectory(prefix="real-") as folder:
            output = Path(folder)
            inputs = [Path(name) for name in names]
            for result in run_builds(inputs, output, config, options.workers):
                row = names[result.input]
                outcome = outcome_of(row, result.entry, output)
                words = f"{outcome.status} {outcome.reason} ({result.seconds:.0f} s)"
                print(f"{row.input}: {words}", file=sys.stderr, flush=True)
                yield outcome


def outcome_of(row: Outcome, entry: Entry, output: Path) -> Outcome:
    """What a registry says of an object that was just built into it."""
    stored = read_report(output / entry.folder)
    gaps = [
        -contact.depth_mm
        for measured in penetrations(stored.report.measurements)
        for contact in measured.contacts
    ]
    return replace(
        row,
        status=str(entry.status),
        reason=entry.reason,
        parts=str(entry.parts),
        joints=str(entry.joints),
        hulls=str(entry.hulls),
        clearance_mm=f"{min(gaps):.2f}" if gaps else "",
        repairs=" ".join(repair.sentence.split()[0] for repair in stored.repairs),
    )


def compared(row: Outcome, found: dict[tuple[str, str], Outcome]) -> Iterator[str]:
    """A line for everything that is not as stated."""
    now = found.get((row.input, row.articulator))
    if now is None:
        yield f"{row.input}: gave no result"
        return
    if now.status == Status.UNJUDGED:
        yield f"{row.input}: could not be judged ({now.reason})"
    told = asdict(now)
    for name, was in asdict(row).items():
        if told[name] != was:
            yield f"{row.input} ({row.articulator}): {name} is {told[name]!r}, was {was!r}"


def read_table() -> list[Outcome]:
    """Every row, in order."""
    with TABLE.open(newline="", encoding="utf-8") as file:
        return [Outcome(**row) for row in csv.DictReader(file)]


def write_table(rows: Sequence[Outcome]) -> None:
    """All of them, anew."""
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [each.name for each in fields(Outcome)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)


if __name__ == "__main__":
    sys.exit(main())
