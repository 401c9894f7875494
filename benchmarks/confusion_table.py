"""Whom the judge catches: the fault corpus against the static checks and each simulator.

A Markdown table and one JSON line: faults rejected, faults that pass, sound things rejected.
"""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "samples"))

from fault_corpus.collection import (  # noqa: E402 - it lives with the tests
    ALL,
    blind_spots,
    broken,
    good,
)
from fault_corpus.exhibits import DETECTORS, ENGINES, Exhibit  # noqa: E402

from asset_factory.sim_checks import Finding, Report, Severity  # noqa: E402
from asset_factory.sim_checks.judge import Judge  # noqa: E402

#: How a finding's code is written down in the judge's own source.
CODES = r'(?:Finding|DescriptionError|found|error|warning|yield \w+)\(\s*"([a-z_]+)"'
#: No file can bring these about: they tell of the machine.
NOT_OF_A_FILE = {"simulator_missing", "simulator_timeout", "check_timeout", "check_crashed"}


@dataclass(frozen=True)
class Row:
    """One exhibit and what came of it.

    Attributes:
        exhibit: what was shown.
        kind: ``error``, ``warning`` or ``sound``: what the verdict ought to be.
        cells: detector -> ``own``, ``other: ...``, ``missed``, ``alarm: ...``, ``-`` or ``not
            asked``.
        passed: the verdict of the judge as a whole; ``None`` where it raised.
    """

    exhibit: Exhibit
    kind: str
    cells: dict[str, str]
    passed: bool | None

    @property
    def outcome(self) -> str:
        """What the verdict is worth."""
        if self.passed is None:
            return "NO VERDICT"
        if self.kind == "error":
            return "FALSE PASS" if self.passed else "rejected"
        return "passed" if self.passed else "FALSE ALARM"


def exhibits() -> list[Exhibit]:
    """Everything: broken, sound, blind spots."""
    return [*broken(), *good(ALL), *blind_spots()]


def shown(exhibit: Exhibit, judge: Judge) -> Row:
    """Judge one exhibit in a folder of its own."""
    kind = "sound" if exhibit.code is None else "error" if exhibit.rejected else "warning"
    with tempfile.TemporaryDirectory() as folder:
        path = exhibit.build(Path(folder))
        try:
            report = judge.check(path, ENGINES)
        except Exception as error:  # noqa: BLE001 - a judge that raises has lost its case, and the others go on
            return Row(
                exhibit, kind, dict.fromkeys(DETECTORS, f"raised {type(error).__name__}"), None
            )
    return Row(
        exhibit, kind, {name: cell(exhibit, report, name) for name in DETECTORS}, report.passed
    )


def cell(exhibit: Exhibit, report: Report, detector: str) -> str:
    """What one detector said."""
    whose = None if detector == "static" else detector
    said = [finding for finding in report.findings if finding.simulator == whose]
    codes = {finding.code for finding in said}
    hard = hard_codes(said)
    if exhibit.code is None:
        return f"alarm: {hard}" if hard else asked(report, detector, codes)
    if codes & {exhibit.code, *exhibit.engines.values()}:
        return "own"
    if hard:
        return f"other: {hard}"
    return "missed" if exhibit.expected(detector) else asked(report, detector, codes)


def hard_codes(findings: Sequence[Finding]) -> str:
    """The codes of the hard ones, each once."""
    return ", ".join(
        dict.fromkeys(finding.code for finding in findings if finding.severity is Severity.ERROR)
    )


def asked(report: Report, detector: str, codes: set[str]) -> str:
    """A dash for a detector that looked and was silent."""
    unread = detector != "static" and detector not in report.measurements
    return "not asked" if unread or "format_not_loaded" in codes else "-"


def table(rows: Sequence[Row]) -> str:
    """Markdown."""
    lines = [
        f"| exhibit | fault | {' | '.join(DETECTORS)} | verdict |",
        f"|{'---|' * (len(DETECTORS) + 3)}",
    ]
    for row in rows:
        fault = "sound" if row.exhibit.code is None else f"`{row.exhibit.code}`"
        fault += " (warning)" if row.kind == "warning" else ""
        lines.append(
            f"| {row.exhibit.name} | {fault} | {' | '.join(row.cells.values())} | {row.outcome} |"
        )
    return "\n".join(lines)


def summary(rows: Sequence[Row]) -> str:
    """Markdown: how often each detector caught, missed or raised a false alarm."""
    words = ("own", "other", "missed", "alarm", "-", "not asked", "raised")
    lines = [f"| | {' | '.join(words)} |", f"|---|{'---|' * len(words)}"]
    for name in DETECTORS:
        counts = Counter(re.match(r"not asked|-|\w+", row.cells[name])[0] for row in rows)  # type: ignore[index]
        lines.append(f"| {name} | {' | '.join(str(counts[word]) for word in words)} |")
    return "\n".join(lines)


def unshown(rows: Sequence[Row]) -> list[str]:
    """Codes that stand in the judge's source and that no exhibit is about."""
    source = "\n".join(path.read_text() for path in sorted((ROOT / "sim_checks").rglob("*.py")))
    about = {code for row in rows for code in (row.exhibit.code, *row.exhibit.engines.values())}
    return sorted(set(re.findall(CODES, source)) - about - NOT_OF_A_FILE)


def main() -> None:
    """Show everything."""
    # MuJoCo logs into the working directory.
    with tempfile.TemporaryDirectory() as folder, Judge() as judge:
        os.chdir(folder)
        rows = [shown(exhibit, judge) for exhibit in exhibits()]
        os.chdir(ROOT)
    outcomes = Counter(row.outcome for row in rows if row.kind != "warning")
    soft = [row for row in rows if row.kind == "warning"]
    line = {
        "benchmark": "confusion_table",
        "faults": sum(row.kind == "error" for row in rows),
        "rejected": outcomes["rejected"],
        "rejected_by_own_code": sum(
            row.kind == "error" and "own" in row.cells.values() for row in rows
        ),
        "false_passes": [row.exhibit.name for row in rows if row.outcome == "FALSE PASS"],
        "no_verdict": [row.exhibit.name for row in rows if row.outcome == "NO VERDICT"],
        "warnings": len(soft),
        "warnings_told": sum("own" in row.cells.values() for row in soft),
        "sound": sum(row.kind == "sound" for row in rows),
        "false_alarms": [row.exhibit.name for row in rows if row.outcome == "FALSE ALARM"],
        "missed": [
            f"{row.exhibit.name}: {name}"
            for row in rows
            for name in DETECTORS
            if row.cells[name] == "missed"
        ],
        "codes_without_exhibit": unshown(rows),
    }
    print(table(rows), summary(rows), json.dumps(line), sep="\n\n")


if __name__ == "__main__":
    main()
