"""Checkers of descriptions, each asked of one file at a time and its answer kept as one JSON file.

Ours (``factory check`` with three simulators), and the PyPI packages ``simcheck`` (MuJoCo and
PyBullet) and ``simready-validate`` (USD). A run that was ended goes on where it was.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from real_yield import core_seconds

from asset_factory.factory.presets import load_config
from asset_factory.sim_checks.judge import Judge
from asset_factory.sim_checks.simulators.catalog import USUAL

#: Seconds after which a checker is taken to have no answer.
LIMIT_S = 600.0
#: The profile of SimReady that fits a piece of furniture.
PROFILE = "Robotics-Prop"
OURS = "factory check"


@dataclass(frozen=True)
class Answer:
    """What a checker says of one file.

    Attributes:
        errors, warnings: each a code and the link or joint that it names.
        core_s: processor time of the checker and its children [s].
        report: all that it wrote; empty where it had no answer in time or crashed.
    """

    errors: frozenset[str]
    warnings: frozenset[str]
    core_s: float
    report: Mapping[str, Any]


#: Writes a checker's report on a file into a folder; returns it as JSON data.
Ask = Callable[[Path, Path], Mapping[str, Any]]
#: Returns what a report holds of a severity, ``error`` or ``warning``.
Said = Callable[[Mapping[str, Any], str], Iterator[str]]


@dataclass(frozen=True)
class Checker:
    """One checker, and the suffixes of the files that it reads."""

    name: str
    reads: tuple[str, ...]
    ask: Ask
    said: Said

    def answer(self, file: Path, folder: Path) -> Answer | None:
        """Return what it says of a file, from ``folder`` where that is known already."""
        if file.suffix not in self.reads:
            return None
        data = kept(self.name, file, folder, self.ask)
        report = data["report"]
        errors, warnings = (
            frozenset(self.said(report, each) if report else ()) for each in ("error", "warning")
        )
        return Answer(errors, warnings, data["core_s"], report)


def kept(name: str, file: Path, folder: Path, ask: Ask) -> dict[str, Any]:
    """Return what is known of a file by a name, asked for once and kept as one JSON file."""
    key = hashlib.sha256(f"{name} {file}".encode()).hexdigest()[:16]
    path = folder / f"{key}.json"
    if not path.is_file():
        before = core_seconds()
        with tempfile.TemporaryDirectory() as place:
            data = {"by": name, "file": str(file), "report": ask(file.absolute(), Path(place))}
        data["core_s"] = round(max(0.0, core_seconds() - before), 2)
        whole = path.with_suffix(".part")
        whole.write_text(json.dumps(data))
        whole.replace(path)
    found: dict[str, Any] = json.loads(path.read_text())
    return found


class Unasked(LookupError):
    """An answer is not there yet, and nobody shall be asked for it."""


def unasked(file: Path, folder: Path) -> Mapping[str, Any]:
    """Raise Unasked instead of asking."""
    raise Unasked(file)


@contextmanager
def checkers(
    simcheck: Path | None, simready: Path | None, *, ask: bool = True
) -> Iterator[Sequence[Checker]]:
    """Yield ours, and the others whose programs are given; none is asked anew without ``ask``."""
    # Who ends this ends its children too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    with Judge(load_config("default").checks) as judge:

        def ask_ours(file: Path, _: Path) -> Mapping[str, Any]:
            return judge.check(file, USUAL).to_dict()

        found = [Checker(OURS, (".urdf", ".xml", ".usd", ".usda"), ask_ours, said_by_us)]
        if simcheck is not None:
            asked = asked_with(simcheck, "check", "{file}", "--no-config", "-q", "--json", "{out}")
            found.append(Checker("simcheck", (".urdf", ".xml"), asked, said_by_simcheck))
        if simready is not None:
            asked = asked_with(simready, "--profile", PROFILE, "--output", "{out}", "{file}")
            found.append(Checker("simready-validate", (".usd", ".usda"), asked, said_by_simready))
        yield found if ask else [replace(each, ask=unasked) for each in found]


def asked_with(program: Path, *arguments: str) -> Ask:
    """Return how to ask a program, which has no answer where it writes none in time."""

    def ask(file: Path, folder: Path) -> Mapping[str, Any]:
        out = folder / "out.json"
        words = [each.format(file=file, out=out) for each in arguments]
        run_to_end([program.absolute(), *words], folder)
        return json.loads(out.read_text()) if out.is_file() else {}

    return ask


def run_to_end(command: Sequence[Path | str], folder: Path) -> None:
    """Run a command in a folder, and end it with all that it started when its time is over."""
    silent = subprocess.DEVNULL
    started = subprocess.Popen(
        command, cwd=folder, stdout=silent, stderr=silent, start_new_session=True
    )
    try:
        with suppress(subprocess.TimeoutExpired):
            started.wait(LIMIT_S)
    finally:
        if started.poll() is None:
            os.killpg(started.pid, signal.SIGKILL)
            started.wait()


def said_by_us(report: Mapping[str, Any], severity: str) -> Iterator[str]:
    """Yield codes with the links and joints concerned."""
    for each in report["findings"]:
        if each["severity"] == severity:
            names = {*each["parts"], *each["joints"], each["joint"] or ""}
            yield " ".join((each["code"], *sorted(names - {""})))


def said_by_simcheck(report: Mapping[str, Any], severity: str) -> Iterator[str]:
    """Yield names of checks with their targets."""
    for check in report["results"]:
        for each in check["findings"]:
            if each["severity"] == severity:
                yield f"{each['check']} {each['target']}"


def said_by_simready(report: Mapping[str, Any], severity: str) -> Iterator[str]:
    """Yield requirements with how often each is unmet: it names no prim in its report."""
    for asset in report.values():
        for feature in asset["features_summary"].values():
            told = json.loads(feature.get("requirement_messages") or "{}")
            unmet = re.findall(r"[\w.]+", str(feature.get("failing requirements") or ""))
            for code in unmet if severity == "error" else ():
                yield f"{code} {len(told.get(code, ()))}"
