"""``factory check``: validate anyone's descriptions."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

import tyro
from tyro.conf import Positional

from asset_factory.sim_checks import Report, Status
from asset_factory.sim_checks.read.usd.layers import is_usd

from ..errors import ConfigError, Exit
from ..presets import load_config
from ..runtime.store import write_json
from ..runtime.terminal import complain, say
from . import console
from .flags import DEFAULT_SIMULATORS, RootFlags, simulators_named, workers_fitting

if TYPE_CHECKING:
    from asset_factory.sim_checks.config import CheckConfig
    from asset_factory.sim_checks.read.roots import ReadOptions


@dataclass(frozen=True)
class Check:
    """Validate URDF, xacro, MJCF or USD files, anyone's.

    Exit codes: 0 every file got a verdict; 3 some file could not be validated; 2 wrong usage;
    1 something was rejected and --strict was given.

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
    reading: tyro.conf.OmitArgPrefixes[RootFlags] = field(default_factory=RootFlags)
    """Where descriptions may read."""


def run(command: Check) -> int:
    """Validate every file; returns the exit code."""
    from ..jobs.memory import CHECK_BYTES

    simulators = simulators_named(command.sim)
    config = load_config(command.config).checks
    workers = workers_fitting(command.workers, CHECK_BYTES)
    files = _described(command.files)
    reports = []
    printed = command.json is None or str(command.json) != "-"
    options = replace(command.reading.options(command.files), srdf=command.srdf)
    if command.srdf is not None and not (command.srdf.is_file() and len(files) == 1):
        raise ConfigError(f"--srdf: want a file, for one description; got {len(files)} of them")
    with _checked(files, simulators, config, workers, options) as checked:
        for report in checked:
            reports.append(report)
            if printed:
                console.print_report(report)
            # Where reports go elsewhere than to the terminal, that says how far it is.
            if sys.stderr.isatty() and not (printed and sys.stdout.isatty()):
                complain(f"{len(reports)} of {len(files)} files checked")
    data: Any = [report.to_dict() for report in reports]
    data = data if len(data) > 1 or any(path.is_dir() for path in command.files) else data[0]
    if not printed:
        say(json.dumps(data, indent=2))
    elif command.json is not None:
        write_json(command.json, data)
    statuses = {report.status for report in reports}
    if Status.UNJUDGED in statuses:
        return Exit.UNJUDGED
    return Exit.REJECTED if command.strict and Status.REJECTED in statuses else Exit.OK


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

        def check(path: Path, name: str | None) -> Report:
            judge = judges.get()
            try:
                report = judge.check(path, simulators, None, options)
            finally:
                judges.put(judge)
            return replace(report, description=name or report.description)

        def in_order() -> Iterator[Report]:
            futures = [pool.submit(check, path, name) for path, name in files]
            for future in futures:
                yield future.result()

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
            raise ConfigError(
                f"{path}: no such file; want a URDF, MJCF or USD file, or a folder of them"
            )
    if not found:
        where = f"in {', '.join(map(str, paths))}" if paths else "given"
        raise ConfigError(f"no URDF, MJCF or USD file {where}; want at least one")
    return found
