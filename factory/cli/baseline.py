"""Findings that are known: a file of them, so that only new ones fail."""

from __future__ import annotations

import json
from collections.abc import Hashable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from asset_factory.sim_checks import Finding, Report, Severity

from ..errors import ConfigError
from ..runtime.store import write_json

#: Of the file's form.
VERSION = 1
_MAX_BYTES = 64_000_000


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
        raise ConfigError(
            f"{path}: no baseline ({why}); --write-baseline {path} writes one"
        ) from error


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
    return (
        file,
        finding.code,
        finding.simulator,
        tuple(sorted(finding.parts)),
        tuple(sorted(finding.named_joints)),
    )
