"""``factory check``: validate anyone's descriptions."""

from __future__ import annotations

import json
from collections.abc import Hashable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

import tyro
from tyro.conf import Positional

from asset_factory.sim_checks import Finding, Report, Status
from asset_factory.sim_checks.grouping import described, excuse_unread, told_once
from asset_factory.sim_checks.read.usd.layers import is_usd

from ..errors import ConfigError, Exit
from ..presets import load_config
from ..runtime.store import write_json, write_whole
from ..runtime.terminal import complain, printable, say
from . import console
from .check_formats import FORMATS, PAGE, read_baseline, total, without_known, write_baseline
from .flags import DEFAULT_SIMULATORS, RootFlags, require_files, simulators_named

if TYPE_CHECKING:
    from asset_factory.sim_checks.config import CheckConfig
    from asset_factory.sim_checks.read.roots import ReadOptions


@dataclass(frozen=True)
class Check:
    """Validate URDF, xacro, MJCF or USD files, anyone's.

    Exit codes: 0 every file got a verdict; 3 some file could not be validated; 2 wrong usage;
    1 something was rejected and --strict was given. With --baseline only new findings count.

    Example: factory check robot.urdf others/ --sim all --json report.json
    """

    files: Positional[tuple[Path, ...]]
    """URDF, xacro, MJCF or USD files, or folders of them."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that validate, separated by commas; 'all' is sapien,mujoco,pybullet."""
    json: Path | None = None
    """Where to write the report; a list of reports for several files or a folder. '-' prints it."""
    workers: int | None = None
    """Files checked at once; as many as there are processors and memory for by default."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""
    strict: bool = False
    """Exit with 1 when anything was rejected."""
    srdf: Path | None = None
    """An SRDF whose exempt pairs hold for the one file checked; by default the one beside it."""
    roots: tyro.conf.OmitArgPrefixes[RootFlags] = field(default_factory=RootFlags)
    """Which files descriptions may refer to."""
    format: str = "text"
    """text, json, sarif, junit, markdown or github; then, after a comma, FORMAT=FILE."""
    baseline: Path | None = None
    """A file of known findings: they fail nothing, and only JSON shows them."""
    write_baseline: Path | None = None
    """Where to write all findings of this run as known; none of them fails it."""
    verbose: bool = False
    """Print every finding, not the worst of each code."""


def run(command: Check) -> int:
    """Validate every file; returns the exit code."""
    from ..jobs.memory import CHECK_BYTES, workers_for

    simulators = simulators_named(command.sim)
    config = load_config(command.config).checks
    workers = workers_for(command.workers, CHECK_BYTES)
    known = read_baseline(command.baseline) if command.baseline else frozenset()
    files = _described(command.files)
    options = replace(command.roots.options(command.files), srdf=command.srdf)
    if command.srdf is not None and not (command.srdf.is_file() and len(files) == 1):
        there = "a file" if command.srdf.is_file() else "no file"
        said = f"--srdf: {command.srdf} is {there}, for {len(files)} descriptions"
        raise ConfigError(f"{said}; want a file, for one description")
    form, written = _forms("json" if str(command.json) == "-" else command.format)
    require_files(command.json, command.write_baseline, *written.values())
    reports: list[Report] = []
    new: list[tuple[str, Report]] = []
    seen: set[Hashable] = set()
    told: list[Finding] = []
    with _checked(files, simulators, config, workers, options) as checked:
        for (path, _), report in zip(files, checked, strict=True):
            reports.append(report)
            file = _name_of(path)
            new.append((file, without_known(file, report, known)))
            if form == "text":
                told += _print_new(path, new[-1][1], seen, verbose=command.verbose)
    data: Any = [report.to_dict() for report in reports]
    data = data if len(data) > 1 or any(path.is_dir() for path in command.files) else data[0]
    if form == "text":
        more = "" if command.verbose else "; --verbose prints each finding"
        say(f"{total(new, told)}{more}; {PAGE} says what a code means")
    else:
        say(json.dumps(data, indent=2) if form == "json" else FORMATS[form](new))
    try:
        for other, target in written.items():
            text = json.dumps(data, indent=2) if other == "json" else FORMATS[other](new)
            write_whole(target, f"{printable(text)}\n".encode())
        if command.json is not None and str(command.json) != "-":
            write_json(command.json, data)
        if command.write_baseline is not None:
            named = [(_name_of(path), r) for (path, _), r in zip(files, reports, strict=True)]
            write_baseline(command.write_baseline, named)
            return Exit.OK
    except OSError as error:
        where = error.filename2 or error.filename
        raise ConfigError(f"{where}: cannot be written: {error.strerror}") from error
    statuses = {report.status for _, report in new}
    if Status.UNJUDGED in statuses:
        return Exit.UNJUDGED
    return Exit.REJECTED if command.strict and Status.REJECTED in statuses else Exit.OK


def _forms(said: str) -> tuple[str, dict[str, Path]]:
    """Return the format that is printed, and the files of others. Raises ConfigError."""
    printed = [each for each in said.split(",") if "=" not in each]
    written = dict(each.split("=", 1) for each in said.split(",") if "=" in each)
    names = ("text", "json", *FORMATS)
    wrong = {*printed, *written} - set(names) or ({"text"} & set(written))
    if wrong or len(printed) > 1:
        known = ", ".join(names)
        raise ConfigError(f"--format must be one of {known}, or FORMAT=FILE, not {said!r}")
    return next(iter(printed), "text"), {form: Path(file) for form, file in written.items()}


def _print_new(path: Path, report: Report, seen: set[Hashable], *, verbose: bool) -> list[Finding]:
    """Print a report but for findings ``seen`` in another file of its asset; return the others."""
    asset = path.parent, described(report)
    once = [(asset, told_once(each)) for each in report.findings]
    kept = [each for each, key in zip(report.findings, once, strict=True) if key not in seen]
    console.print_report(report, kept, verbose=verbose)
    seen.update(once if described(report) is not None else ())
    return kept


def _name_of(path: Path) -> str:
    """Return a path as the working directory has it, with forward slashes."""
    here = Path.cwd()
    real = path.resolve()
    return (real.relative_to(here) if real.is_relative_to(here) else path).as_posix()


@contextmanager
def _checked(
    files: Sequence[tuple[Path, str | None]],
    simulators: Sequence[str],
    config: CheckConfig,
    workers: int,
    options: ReadOptions,
) -> Iterator[Iterator[Report]]:
    """Yield the reports in the order of the files, each once it and all before it are there.

    A validator serves one file at a time; what it asks are child processes of its own, so that
    threads are enough here. Simulators share what processors the files leave.
    """
    from asset_factory.sim_checks.judge import Judge
    from asset_factory.sim_checks.processes.isolation import processors

    most = min(workers, len(files))
    judges: SimpleQueue[Judge] = SimpleQueue()
    with ExitStack() as stack:
        for _ in range(most):
            judges.put(stack.enter_context(Judge(config, max(1, processors() // most))))
        pool = ThreadPoolExecutor(most, thread_name_prefix="check")
        # Someone who interrupts does not wait for files that are under way.
        stack.callback(pool.shutdown, wait=False, cancel_futures=True)

        def check(number: int, path: Path, name: str | None) -> Report:
            judge = judges.get()
            complain(f"checking {name or path} ({number} of {len(files)})")
            try:
                report = judge.check(path, simulators, None, options)
            finally:
                judges.put(judge)
            return replace(report, description=name or report.description)

        def in_order() -> Iterator[Report]:
            futures = [pool.submit(check, n, *file) for n, file in enumerate(files, 1)]
            for (path, _), future in zip(files, futures, strict=True):
                report = future.result()
                if any(each.code == "not_simulated" for each in report.findings):
                    # Only here does a report wait for files after it.
                    beside = [
                        other.result()
                        for (near, _), other in zip(files, futures, strict=True)
                        if near.parent == path.parent and near != path
                    ]
                    report = excuse_unread(report, beside)
                yield report

        yield in_order()


def _described(paths: Sequence[Path]) -> list[tuple[Path, str | None]]:
    """Yield every file to check, named by its path where several files may share a name."""
    found: list[tuple[Path, str | None]] = []
    for path in paths:
        if path.is_dir():
            from ..intake.discover import find_inputs, is_description

            inside = [file for file in find_inputs((path,)) if is_description(file) or is_usd(file)]
            found += [(file, file.relative_to(path).as_posix()) for file in inside]
        elif path.is_file():
            found.append((path, None))
        else:
            want = "want a URDF, MJCF or USD file, or a folder of them"
            raise ConfigError(f"{path}: no such file; {want}")
    if not found:
        where = f"in {', '.join(map(str, paths))}" if paths else "given"
        raise ConfigError(f"no URDF, MJCF or USD file {where}; want at least one")
    return found
