"""Reports of ``factory check`` in the forms that other tools read, and findings that are known."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import quote
from xml.etree import ElementTree as ET

import asset_factory
from asset_factory.sim_checks import Finding, Report, Severity, Status
from asset_factory.sim_checks.grouping import group_findings

from ..errors import ConfigError
from ..reasons import meaning_of
from ..report.nightly.formats import counted
from ..runtime.store import write_json
from ..runtime.terminal import one_line, printable

#: Where each code is explained, in the project's documentation.
PAGE = "docs/reasons.md"
SARIF = "https://json.schemastore.org/sarif-2.1.0.json"
Checked = Sequence[tuple[str, Report]]
#: Of the form of a baseline, and the most that is read of one [bytes].
VERSION = 1
_MAX_BYTES = 64_000_000


def page_of(code: str) -> str:
    """Return where a code is explained."""
    return f"{PAGE}#{code}"


def as_sarif(checked: Checked) -> str:
    """Return SARIF 2.1.0, which code hosts show beside the lines: one result for each finding."""
    # A code may warn at one place and reject at another: its rule has the graver meaning.
    said = {
        each.code: meaning_of(severity, each.code) or each.code
        for severity in reversed(Severity)
        for _, report in checked
        for each in report.findings
        if each.severity is severity
    }
    rules = [
        {
            "id": code,
            "shortDescription": {"text": meaning},
            "help": {"text": page_of(code), "markdown": f"[{code}]({page_of(code)})"},
        }
        for code, meaning in sorted(said.items())
    ]
    results = []
    for file, report in checked:
        lines = _lines(file)
        results += [_sarif_result(file, each, lines) for each in report.findings]
    driver = {"name": "factory check", "version": asset_factory.__version__, "rules": rules}
    run = {"tool": {"driver": driver}, "columnKind": "utf16CodeUnits", "results": results}
    return json.dumps({"$schema": SARIF, "version": "2.1.0", "runs": [run]}, indent=2)


def _sarif_result(file: str, finding: Finding, lines: Sequence[str]) -> dict[str, Any]:
    place = {
        "physicalLocation": {
            "artifactLocation": {"uri": quote(file)},
            "region": {"startLine": _line(finding, lines)},
        },
        "logicalLocations": [{"name": name, "kind": "member"} for name in _names(finding)],
    }
    known_by = "/".join((finding.code, finding.simulator or "", *sorted(_names(finding))))
    return {
        "ruleId": finding.code,
        "level": str(finding.severity),
        "message": {"text": _told(finding)},
        "locations": [place],
        "partialFingerprints": {"place/v1": known_by},
    }


def as_junit(checked: Checked) -> str:
    """Return JUnit's XML: a suite for each file, a case for each code; warnings are its output."""
    root = ET.Element("testsuites", name="factory check")
    for file, report in checked:
        suite = ET.SubElement(root, "testsuite", name=printable(file))
        groups = group_findings(report.findings)
        failed = 0
        for group in groups:
            case = ET.SubElement(suite, "testcase", classname=printable(file), name=group[0].code)
            text = printable("\n".join(_told(each) for each in group))
            if group[0].severity is Severity.ERROR:
                failed += 1
                failure = ET.SubElement(case, "failure", message=one_line(_told(group[0])))
                failure.text = f"{text}\n{page_of(group[0].code)}"
            else:
                ET.SubElement(case, "system-out").text = text
        if not failed:
            ET.SubElement(suite, "testcase", classname=printable(file), name="passed")
        suite.set("tests", str(len(suite)))
        suite.set("failures", str(failed))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True)


def as_markdown(checked: Checked) -> str:
    """Return a table for each file that has findings, and the totals."""
    lines = [f"**{total(checked)}**"]
    for file, report in checked:
        lines += ["", f"### {report.status}: {_cell(file)}", ""]
        if report.findings:
            lines += ["| | code | times | the worst |", "|---|---|---|---|"]
        for group in group_findings(report.findings):
            code = group[0].code
            linked = f"[{code}]({page_of(code)})"
            worst = _cell(_told(group[0]))
            lines.append(f"| {group[0].severity} | {linked} | {len(group)} | {worst} |")
    return "\n".join(lines)


def as_github(checked: Checked) -> str:
    """Return workflow commands of GitHub: one annotation for each code of a file, errors first.

    GitHub shows ten errors and ten warnings of a step.
    """
    words = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}
    told = []
    for file, report in checked:
        lines = _lines(file)
        for group in group_findings(report.findings):
            worst = group[0]
            many = f" ({len(group)} of them, the worst)" if len(group) > 1 else ""
            place = f"file={_property(file)},line={_line(worst, lines)}"
            text = _data(f"{_told(worst)}{many}; {page_of(worst.code)}")
            title = f"title={_property(worst.code)}"
            order = list(Severity).index(worst.severity)
            told.append((order, f"::{words[worst.severity]} {place},{title}::{text}"))
    ordered = [text for _, text in sorted(told, key=lambda each: each[0])]
    return "\n".join([*ordered, total(checked)])


def total(checked: Checked, told: Sequence[Finding] | None = None) -> str:
    """Return one line: how many files became what, and how many findings are told."""
    statuses = [report.status for _, report in checked]
    if told is None:
        told = [each for _, report in checked for each in report.findings]
    findings = [each.severity for each in told]
    words = {Status.UNJUDGED: "could not be validated"}
    files = ", ".join(f"{statuses.count(each)} {words.get(each, each)}" for each in Status)
    found = ", ".join(counted(findings.count(each), each) for each in Severity)
    return f"{counted(len(checked), 'file')}: {files}; {found}"


def _told(finding: Finding) -> str:
    where = f"[{finding.simulator}] " if finding.simulator else ""
    return f"{where}{finding.message}"


def _names(finding: Finding) -> tuple[str, ...]:
    """Return the joints and links that a finding is about."""
    return (*finding.named_joints, *finding.parts)


def _lines(file: str) -> tuple[str, ...]:
    """Return the lines of a text file; of a binary one nothing that names are found in."""
    return tuple(Path(file).read_text(encoding="utf-8", errors="replace").splitlines())


def _line(finding: Finding, lines: Sequence[str]) -> int:
    """Return the line that first names what a finding is about; 1 where none does."""
    for name in _names(finding):
        said = re.compile(rf"""\bname\s*=\s*["']{re.escape(name)}["']""")
        for number, line in enumerate(lines, 1):
            if said.search(line):
                return number
    return 1


def _data(text: str) -> str:
    """Return a text as workflow commands escape it: a name in a file may hold another command."""
    return printable(text).replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")


def _cell(text: str) -> str:
    """Return a text as a table's cell: no markup, no line breaks."""
    return re.sub(r"([\\`*_\[\]<>|#])", r"\\\1", one_line(text))


#: How reports may be printed at the end; ``text`` and ``json`` are the command's own.
FORMATS: Mapping[str, Callable[[Checked], str]] = {
    "sarif": as_sarif,
    "junit": as_junit,
    "markdown": as_markdown,
    "github": as_github,
}


def write_baseline(path: Path, checked: Sequence[tuple[str, Report]]) -> None:
    """Write every error and warning as known, without figures: those vary between versions."""
    known = {
        _place(file, finding): _plain(file, finding)
        for file, report in checked
        for finding in report.findings
        if finding.severity is not Severity.NOTE
    }
    findings = [known[key] for key in sorted(known, key=str)]
    write_json(path, {"version": VERSION, "findings": findings})


def read_baseline(path: Path) -> frozenset[Hashable]:
    """Return what is known, for :func:`without_known`. Raises ConfigError if it cannot be read."""
    try:
        with path.open("rb") as file:
            data = json.loads(file.read(_MAX_BYTES))
        if data["version"] != VERSION:
            raise ValueError(f"version {data['version']!r}, want {VERSION}")
        return frozenset(
            (each["file"], each["code"], each["simulator"], *map(tuple, each["at"]))
            for each in data["findings"]
        )
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        why = error.strerror if isinstance(error, OSError) else "not written by factory check"
        advice = f"--write-baseline {path} writes one"
        raise ConfigError(f"{path}: no baseline ({why}); {advice}") from error


def without_known(file: str, report: Report, known: frozenset[Hashable]) -> Report:
    """Return a report with the findings that are new: of another code, or at another place."""
    new = (each for each in report.findings if _place(file, each) not in known)
    return replace(report, findings=tuple(new))


def _plain(file: str, finding: Finding) -> dict[str, Any]:
    """Return a finding's place as JSON data."""
    _, code, simulator, *at = _place(file, finding)
    return {"file": file, "code": code, "simulator": simulator, "at": [list(each) for each in at]}


def _place(file: str, finding: Finding) -> tuple[Any, ...]:
    """Return what a finding is known by: its file, code and simulator, and its links and joints."""
    at = (tuple(sorted(names)) for names in (finding.parts, finding.named_joints))
    return file, finding.code, finding.simulator, *at
