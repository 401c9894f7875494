"""The board: published descriptions as they are, against what ``factory build`` makes of them.

Of each file what ours, simcheck and simready-validate say, as it is and rebuilt with
``--articulator annotated``: a table by source in ``results/board.toml``, and ``docs/board.html``.

    python benchmarks/board.py WORK --simcheck PROGRAM --simready PROGRAM             a sample
    python benchmarks/board.py WORK --list FILE --page board.html                     your own files

One JSON file an answer in WORK/answers: a run that was ended goes on where it was, and
``--no-ask`` draws what is there. FILE has a line for each file, or the path, source and license
apart by tabs.
"""

from __future__ import annotations

import argparse
import datetime
import json
import statistics
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from checkers import OURS, Answer, Ask, Checker, Unasked, checkers, kept, run_to_end, unasked
from published import Published, inventory, listed
from real_yield import DATA
from results_file import renew

from asset_factory.factory.report.pages import BASE_CSS, environment, trusted
from asset_factory.sim_checks.measurements import penetrations

ROOT = Path(__file__).resolve().parents[1]
COLUMNS = (
    "source",
    "license",
    "files",
    "pass as published",
    "mm, as published",
    "engines disagree",
    "the most frequent errors",
    "simcheck passes",
    "rebuilt: registered",
    "mm, rebuilt",
    "simcheck passes them",
)
#: What becomes of a file that nobody rebuilds.
NOT_BUILT = "not built"
#: What is in one another by less than this is not told [mm].
FINEST_MM = 0.05


@dataclass(frozen=True)
class Row:
    """One file and every answer on it, by checker.

    Attributes:
        file: as published.
        before: of the file as it is.
        status: what became of it in a build: ``passed``, or the reason why it was rejected.
        after: of what was built, the USD file's by ``simready-validate``.
    """

    file: Published
    before: Mapping[str, Answer]
    status: str
    after: Mapping[str, Answer]


def main() -> int:
    """Ask, build, ask again, draw; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("work", type=Path, help="folder of answers and of what is built")
    parser.add_argument("--data", type=Path, default=DATA, help="folder with INVENTORY.csv")
    parser.add_argument("--count", type=int, default=32, help="files, one of each source in turn")
    parser.add_argument("--list", type=Path, help="a list of files instead")
    parser.add_argument("--simcheck", type=Path, help="its program")
    parser.add_argument("--simready", type=Path, help="the program simready-validate")
    parser.add_argument("--page", type=Path, default=ROOT / "docs" / "board.html")
    parser.add_argument("--no-build", action="store_true", help="rebuild no more files")
    parser.add_argument("--no-ask", action="store_true", help="draw the answers that are there")
    asked = parser.parse_args()
    work = asked.work.absolute()
    (work / "answers").mkdir(parents=True, exist_ok=True)
    files = listed(asked.list) if asked.list else islice(inventory(asked.data), asked.count)
    rows = []
    with checkers(asked.simcheck, asked.simready, ask=not asked.no_ask) as found:
        build = unasked if asked.no_ask or asked.no_build else building(work / "built")
        for number, file in enumerate(files, 1):
            print(f"{number}: {file.path}", file=sys.stderr, flush=True)
            with suppress(Unasked):
                rows.append(row_of(file, found, work, build))
    table = [table_row(title, of) for title, of in by_source(rows)]
    asked.page.write_text(page(rows, table), encoding="utf-8")
    if asked.list is None:
        renew("board", COLUMNS, table)
    else:
        print(*(" | ".join(each) for each in (COLUMNS, *table)), sep="\n")
    return 0


def row_of(file: Published, found: Sequence[Checker], work: Path, build: Ask) -> Row:
    """Ask every checker of a file and of what is made of it."""
    answers = work / "answers"
    before = asked_of(found, file.path, answers)
    try:
        built = kept("factory build", file.path, answers, build)["report"]
        if not built:
            return Row(file, before, "no answer in time", {})
        if built["status"] != "passed":
            return Row(file, before, built["reason"], {})
        folder = work / "built" / built["place"]
        urdf, usd = (folder / f"asset.{suffix}" for suffix in ("urdf", "usd"))
        after = {**asked_of(found, usd, answers), **asked_of(found, urdf, answers)}
    except Unasked:
        return Row(file, before, NOT_BUILT, {})
    return Row(file, before, "passed", after)


def asked_of(found: Sequence[Checker], file: Path, answers: Path) -> dict[str, Answer]:
    """Return the answers of those who read a file, by their names."""
    said = {each.name: each.answer(file, answers) for each in found}
    return {name: answer for name, answer in said.items() if answer is not None}


def building(output: Path) -> Ask:
    """Return how to rebuild a file from its meshes and joints, into a folder of its own."""

    def ask(file: Path, _: Path) -> Mapping[str, Any]:
        place = output / f"{file.parent.parent.name}_{file.parent.name}"
        place.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-m", "asset_factory.factory.cli", "build", "--workers", "1"]
        command += ["--articulator", "annotated", "--sim", "all", "--formats", "usd"]
        run_to_end([*command, "--input", str(file), "--output", str(place)], place)
        summary = place / "summary.json"
        if not summary.is_file():
            return {}
        row = json.loads(summary.read_text())["assets"][0]
        return {
            "status": row["status"],
            "reason": row["reason"],
            "place": f"{place.name}/assets/{row['id']}",
        }

    return ask


def by_source(rows: Sequence[Row]) -> Iterator[tuple[str, list[Row]]]:
    """Yield the rows of each source by its name, and all of them."""
    groups = defaultdict(list)
    for row in rows:
        groups[row.file.source].append(row)
    yield from sorted(groups.items())
    yield "all", list(rows)


def table_row(source: str, rows: Sequence[Row]) -> tuple[str, ...]:
    """Return what the table says of a source."""
    built = [row for row in rows if row.status == "passed"]
    ours = [row.before[OURS] for row in rows]
    codes = Counter(code for answer in ours for code in codes_of(answer))
    licenses = sorted({row.file.license for row in rows}) if source != "all" else []
    return (
        source,
        ", ".join(filter(None, licenses)),
        str(len(rows)),
        str(sum(not answer.errors for answer in ours)),
        middle_mm(ours),
        str(sum(bool(answer.report.get("disagreements")) for answer in ours)),
        ", ".join(f"`{code}` {count}" for code, count in ranked(codes)[:3]),
        passing([row.before for row in rows], "simcheck"),
        f"{len(built)} of {sum(row.status != NOT_BUILT for row in rows)}",
        middle_mm([row.after[OURS] for row in built]),
        passing([row.after for row in built], "simcheck"),
    )


def ranked(codes: Counter[str]) -> list[tuple[str, int]]:
    """Return codes with their counts, the most frequent first."""
    return sorted(codes.items(), key=lambda each: (-each[1], each[0]))


def codes_of(answer: Answer) -> set[str]:
    """Return the codes of the errors."""
    return {each.split()[0] for each in answer.errors}


def passing(answers: Sequence[Mapping[str, Answer]], checker: str) -> str:
    """Return how many files a checker passes, of those on which it has an answer."""
    told = [each[checker] for each in answers if each.get(checker) and each[checker].report]
    return f"{sum(not each.errors for each in told)} of {len(told)}" if told else "not asked"


def deepest(answer: Answer) -> float:
    """Return how deep parts are in one another, at rest or along a joint [mm]."""
    measured = penetrations({"": answer.report.get("measurements", {})})
    return max(
        (
            each.depth_mm
            for of in measured
            for each in of.contacts
            if each.kind == "plain" and each.depth_mm > FINEST_MM
        ),
        default=0.0,
    )


def middle_mm(answers: Sequence[Answer]) -> str:
    """Return the median and the most of the deepest penetrations [mm]."""
    depths = list(map(deepest, answers))
    return f"{statistics.median(depths):.1f} / {max(depths):.1f}" if depths else ""


def overlooked(rows: Sequence[Row], checker: str, of: str) -> Counter[str]:
    """Count codes of one checker's errors on files as published in which the other has none."""
    return Counter(
        code
        for row in rows
        if checker in row.before and of in row.before
        if row.before[of].report and not row.before[of].errors
        for code in codes_of(row.before[checker])
    )


def page(rows: Sequence[Row], table: Sequence[Sequence[str]]) -> str:
    """Return the page: one file that asks the network nothing and runs no script."""
    template = Path(__file__).with_name("board.html.j2").read_text(encoding="utf-8")
    css = trusted(BASE_CSS.read_text(encoding="utf-8"))
    return (
        environment("asset_factory.factory.report", codes_of=codes_of, deepest=deepest)
        .from_string(template)
        .render(
            alone={"css": css, "digest": "'none'"},
            rows=sorted(rows, key=lambda row: (row.file.source, row.file.path)),
            head=COLUMNS,
            table=table,
            date=datetime.datetime.now(datetime.UTC).date().isoformat(),
            ours=OURS,
            NOT_BUILT=NOT_BUILT,
            missed={
                (OURS, "simcheck"): ranked(overlooked(rows, OURS, "simcheck")),
                ("simcheck", OURS): ranked(overlooked(rows, "simcheck", OURS)),
            },
        )
    )


if __name__ == "__main__":
    sys.exit(main())
