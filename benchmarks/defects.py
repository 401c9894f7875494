"""Defects side by side: what ``factory check`` and the PyPI package ``simcheck`` catch of them.

Ours, planted by the fault corpus in URDFs of its own objects, and simcheck's, planted by its
command ``mutate`` in copies of assets; beside them the same things without a defect. A checker
catches what it rejects: a warning is no catch. Prints a table, one JSON line, and what each missed.

python benchmarks/defects.py OUT --simcheck VENV/bin/simcheck
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from confusion_table import exhibits

#: Assets that simcheck's defects are planted in, those of the fewest hulls, and where those lie.
ASSETS = 6
HULLS = Path("meshes", "collision")
WORKERS = os.cpu_count() or 1


@dataclass(frozen=True)
class Case:
    """One file, and what is wrong with it: empty where nothing is."""

    path: Path
    origin: str
    defect: str


@dataclass(frozen=True)
class Checked:
    """Which files a checker rejected, and its wall-clock seconds a file."""

    rejected: frozenset[Path]
    seconds: float


def ours(cases: Sequence[Case], folder: Path) -> Checked:
    """Ask ``factory check`` with three simulators, in one call."""
    report = folder / "ours.json"
    command = [sys.executable, "-m", "asset_factory.factory.cli", "check"]
    command += [*(str(each.path) for each in cases), "--sim", "all", "--json", str(report)]
    seconds = timed([*command, "--workers", str(WORKERS)], folder)
    passed = [each["passed"] for each in json.loads(report.read_text())]
    rejected = {each.path for each, well in zip(cases, passed, strict=True) if not well}
    return Checked(frozenset(rejected), seconds / len(cases))


def simcheck(program: Path) -> Callable[[Sequence[Case], Path], Checked]:
    """Return how to ask simcheck, with the engines it finds, in one call."""

    def ask(cases: Sequence[Case], folder: Path) -> Checked:
        report = folder / "simcheck.json"
        command = [str(program), "check", *(str(each.path) for each in cases)]
        command += ["-j", str(WORKERS), "--no-config", "--json", str(report)]
        seconds = timed(command, folder)
        told = json.loads(report.read_text())
        rejected = {folder / each["asset"] for each in told if each["verdict"] == "FAIL"}
        return Checked(frozenset(rejected), seconds / len(cases))

    return ask


def timed(command: Sequence[str], folder: Path) -> float:
    """Run a checker, whatever its exit code; return its wall-clock seconds."""
    started = time.perf_counter()
    subprocess.run(command, cwd=folder, check=False, stdout=subprocess.DEVNULL)
    return time.perf_counter() - started


def corpus(folder: Path) -> list[Case]:
    """Write every URDF of the fault corpus that must be rejected, or must pass."""
    found = []
    for number, exhibit in enumerate(exhibits()):
        if exhibit.name.endswith(".urdf") and (exhibit.rejected or exhibit.code is None):
            place = folder / f"{number:03}"
            place.mkdir()
            path = exhibit.build(place)
            found.append(Case(path, "corpus", exhibit.name if exhibit.code else ""))
    return found


def planted(output: Path, program: Path, folder: Path) -> list[Case]:
    """Copy assets of an output folder and let simcheck plant each of its defects in a copy."""
    listed = subprocess.run(
        [program, "mutate", "--list"], check=True, capture_output=True, text=True
    )
    defects = [line.split()[0] for line in listed.stdout.splitlines() if line.strip()]
    found = []
    sources = sorted((output / "assets").iterdir(), key=lambda each: len(os.listdir(each / HULLS)))
    for source in sources[:ASSETS]:
        for defect in ("", *defects):
            place = folder / f"{source.name}_{defect or 'sound'}"
            shutil.copytree(source, place)
            path = place / "asset.urdf"
            if defect:
                command = [program, "mutate", path, "--defect", defect, "-o", place]
                subprocess.run(command, check=False, capture_output=True)
                path = place / f"asset__{defect}.urdf"
            if path.is_file():
                found.append(Case(path, source.name, defect))
    return found


def told(cases: Sequence[Case], checked: Checked) -> tuple[str, str, str, list[str]]:
    """Return what a checker caught, its false alarms, its seconds, and what it got wrong."""
    broken = [each for each in cases if each.defect]
    sound = [each for each in cases if not each.defect]
    missed = [each for each in broken if each.path not in checked.rejected]
    alarms = [each for each in sound if each.path in checked.rejected]
    wrong = [f"missed {each.origin} {each.defect}" for each in missed]
    wrong += [f"false alarm {each.origin} {each.path.name}" for each in alarms]
    return (
        f"{len(broken) - len(missed)} of {len(broken)}",
        f"{len(alarms)} of {len(sound)}",
        f"{checked.seconds:.1f}",
        wrong,
    )


def main() -> None:
    """Plant, ask both, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="output folder of factory build")
    parser.add_argument("--simcheck", type=Path, required=True, help="its program")
    asked = parser.parse_args()
    program = asked.simcheck.absolute()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for kinds, place in (("simcheck's", "planted"), ("ours", "corpus")):
            (folder / place).mkdir()
            cases = (
                planted(asked.output, program, folder / place)
                if place == "planted"
                else corpus(folder / place)
            )
            for checker, ask in (("factory check", ours), ("simcheck", simcheck(program))):
                *figures, wrong = told(cases, ask(cases, folder))
                rows.append((kinds, checker, *figures))
                print(f"| {' | '.join(rows[-1])} |", *wrong, sep="\n  ", flush=True)
    head = ("defects", "checker", "caught", "false alarms", "seconds a file")
    print("", f"| {' | '.join(head)} |", f"|{'---|' * len(head)}", sep="\n")
    print(*(f"| {' | '.join(row)} |" for row in rows), sep="\n")
    print(json.dumps({"benchmark": "defects", "columns": head, "rows": rows}))


if __name__ == "__main__":
    main()
