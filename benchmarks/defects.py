"""Defects side by side: what ``factory check``, simcheck and simready-validate catch of them.

Ours, planted by the fault corpus in objects of its own; simcheck's 17 kinds, planted by its command
``mutate`` in assets of a build and in published objects; and those of its kinds that USD can state,
planted in the assets' USD files. Caught is a defect for which a checker states an error that it
does not state of the same file without it. Prints what each missed, and writes
``results/defects.toml``.

    factory build --input examples/meshes examples/generated examples/stated --formats usd \
        --output OUT
    python benchmarks/defects.py OUT WORK --simcheck PROGRAM --simready PROGRAM

A run that was ended goes on where it was, with the same WORK folder; ``--no-ask`` counts what is
there.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from itertools import chain, islice
from pathlib import Path

import usd_defects
from checkers import Answer, Checker, Unasked, checkers
from confusion_table import exhibits
from published import inventory
from real_yield import DATA
from results_file import renew

HULLS = Path("meshes", "collision")
COLUMNS = (
    "defects",
    "checker",
    "caught",
    "caught or warned of",
    "rejected without",
    "core-s a file",
)


@dataclass(frozen=True)
class Case:
    """One file, what is wrong with it (empty where nothing is), and the same without it."""

    path: Path
    defect: str
    sound: Path | None = None


def main() -> int:
    """Plant, ask, print and write; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="output folder of factory build --formats usd")
    parser.add_argument("work", type=Path, help="folder of planted files and of answers")
    parser.add_argument("--simcheck", type=Path, help="its program")
    parser.add_argument("--simready", type=Path, help="the program simready-validate")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of published objects")
    parser.add_argument("--assets", type=int, default=6, help="assets, those of the fewest hulls")
    parser.add_argument("--real", type=int, default=20, help="published objects")
    parser.add_argument("--kinds", type=int, default=2, help="defects planted in each of those")
    parser.add_argument("--only", help="ask this checker alone, and write no table")
    parser.add_argument("--no-ask", action="store_true", help="count the answers that are there")
    asked = parser.parse_args()
    work = asked.work.absolute()
    rows = []
    with checkers(asked.simcheck, asked.simready, ask=not asked.no_ask) as found:
        for title, cases in groups(asked, work):
            for checker in found:
                if asked.only in (None, checker.name):
                    rows += table_row(title, cases, checker, work / "answers")
    if asked.only is None:
        renew("defects", COLUMNS, rows)
    return 0


def groups(asked: argparse.Namespace, work: Path) -> Iterator[tuple[str, list[Case]]]:
    """Yield every group of cases with its title, planted when it is asked for."""
    (work / "answers").mkdir(parents=True, exist_ok=True)
    sources = [each for each in (asked.output / "assets").iterdir() if each.is_dir()]
    sources.sort(key=lambda each: (len(os.listdir(each / HULLS)), each.name))
    assets = [copied(each / "asset.urdf", work / "assets") for each in sources[: asked.assets]]
    usd = [each.with_suffix(".usd") for each in assets if each.with_suffix(".usd").is_file()]
    if asked.simcheck is not None:
        every = chain(*(in_urdf(each, asked.simcheck, None) for each in assets))
        yield f"simcheck's 17 kinds, in {len(assets)} assets", list(every)
    if usd:
        planted = [Case(made, defect, file) for file in usd for defect, made in in_usd(file)]
        yield f"kinds that USD can state, in {len(usd)} assets as USD", planted
    yield f"our own kinds, {len(corpus(work))} objects of boxes and demo kinds", corpus(work)
    if asked.simcheck is not None:
        urdfs = (each.path for each in inventory(asked.data) if each.path.suffix == ".urdf")
        real = [copied(each, work / "real") for each in islice(urdfs, asked.real)]
        some = (
            in_urdf(file, asked.simcheck, range(number * asked.kinds, (number + 1) * asked.kinds))
            for number, file in enumerate(real)
        )
        title = f"{asked.kinds} of simcheck's kinds in turn, in {len(real)} published objects"
        yield title, list(chain(*some))


def copied(file: Path, to: Path) -> Path:
    """Return a description's copy, with the folder that it lies in."""
    place = to / file.parent.name
    if not place.is_dir():
        part = place.with_suffix(".part")
        shutil.rmtree(part, ignore_errors=True)
        shutil.copytree(file.parent, part)
        part.rename(place)
    return place / file.name


def corpus(work: Path) -> list[Case]:
    """Write all of the fault corpus that must be rejected, or must pass."""
    found = []
    for number, exhibit in enumerate(exhibits()):
        if exhibit.rejected or exhibit.code is None:
            place = work / "corpus" / f"{number:03}"
            name = place / "name"
            if not name.is_file():
                shutil.rmtree(place, ignore_errors=True)
                place.mkdir(parents=True)
                name.write_text(exhibit.build(place).relative_to(place).as_posix())
            defect = exhibit.name if exhibit.rejected else ""
            found.append(Case(place / name.read_text(), defect))
    return found


def in_usd(file: Path) -> Iterator[tuple[str, Path]]:
    """Yield a USD file, and copies with a defect each."""
    yield "", file
    for defect in usd_defects.DEFECTS:
        made = file.with_name(f"asset__{defect}.usd")
        if not made.is_file():
            usd_defects.plant(file, defect, made)
        yield defect, made


def in_urdf(file: Path, program: Path, numbers: range | None) -> Iterator[Case]:
    """Yield a URDF, and copies in its folder with one of simcheck's defects each.

    Args:
        file: the URDF.
        program: simcheck's.
        numbers: of the defects, counted round; ``None`` for all.
    """
    defects = kinds_of(program)
    yield Case(file, "")
    for number in range(len(defects)) if numbers is None else numbers:
        defect = defects[number % len(defects)]
        made = file.with_name(f"{file.stem}__{defect}.urdf")
        if not made.is_file():
            command = [program, "mutate", file, "--defect", defect, "-o", file.parent]
            subprocess.run(command, check=False, capture_output=True)
        if made.is_file():
            yield Case(made, defect, file)


@cache
def kinds_of(program: Path) -> tuple[str, ...]:
    """Return the defects that simcheck plants."""
    listed = subprocess.run(
        [program, "mutate", "--list"], check=True, capture_output=True, text=True
    )
    return tuple(line.split()[0] for line in listed.stdout.splitlines() if line.strip())


def table_row(
    title: str, cases: Sequence[Case], checker: Checker, folder: Path
) -> Iterator[tuple[str, ...]]:
    """Ask a checker of all cases; print what it missed; yield its row, or none if it reads none."""
    seen: dict[Path, Answer] = {}
    for number, case in enumerate(cases, 1):
        print(f"{checker.name}: {number} of {len(cases)}, {title}", file=sys.stderr, flush=True)
        with suppress(Unasked):
            answer = checker.answer(case.path, folder)
            if answer is not None:
                seen[case.path] = answer
    asked = [case for case in cases if {case.path, case.sound} - {None} <= set(seen)]
    broken = [case for case in asked if case.defect]
    sound = [case for case in asked if not case.defect]
    if not asked:
        return
    missed = [case for case in broken if not news(case, seen, warnings=False)]
    silent = [case for case in missed if not news(case, seen, warnings=True)]
    alarms = [case for case in sound if seen[case.path].errors]
    print(f"\n{title}: {checker.name}")
    for case in missed:
        told = "silent on" if case in silent else "warns of"
        print(f"  {told} {case.defect} {case.path}: {sorted(news(case, seen, warnings=True))}")
    for case in alarms:
        print(f"  rejects {case.path}: {sorted(seen[case.path].errors)[:3]}")
    for case in asked:
        if not seen[case.path].report:
            print(f"  no answer of {case.path}")
    yield (
        title,
        f"`{checker.name}`",
        f"{len(broken) - len(missed)} of {len(broken)}",
        f"{len(broken) - len(silent)} of {len(broken)}",
        f"{len(alarms)} of {len(sound)}",
        f"{statistics.median(each.core_s for each in seen.values()):.1f}",
    )


def news(case: Case, seen: dict[Path, Answer], *, warnings: bool) -> frozenset[str]:
    """Return the errors, and warnings if asked, that the same file without the defect has not."""
    before = seen.get(case.sound) if case.sound is not None else None
    errors = seen[case.path].errors - (before.errors if before else frozenset())
    if not warnings:
        return errors
    known = before.errors | before.warnings if before else frozenset()
    return (seen[case.path].errors | seen[case.path].warnings) - known


if __name__ == "__main__":
    sys.exit(main())
