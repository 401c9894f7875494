"""``factory check``: judge anyone's descriptions."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tyro.conf import Positional

from asset_factory.sim_checks import Status
from asset_factory.sim_checks.read.usd.layers import is_usd

from ..errors import ConfigError, Exit
from ..presets import load_config
from ..runtime.store import write_json
from ..runtime.terminal import say
from . import console
from .flags import DEFAULT_SIMULATORS, simulators_named


@dataclass(frozen=True)
class Check:
    """Judge URDF, MJCF or USD files, anyone's.

    Exit codes: 0 every file got a verdict; 3 some file could not be judged; 2 wrong usage;
    1 something was rejected and --strict was given.

    Example: factory check robot.urdf others/ --sim all --json report.json
    """

    files: Positional[tuple[Path, ...]]
    """URDF, MJCF or USD files, or folders of them."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that judge, separated by commas; 'all' is sapien,mujoco,pybullet."""
    json: Path | None = None
    """Where to write the report; a list of reports for several files or a folder. '-' prints it."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""
    strict: bool = False
    """Exit with 1 when anything was rejected."""


def run(command: Check) -> int:
    """Judge every file; returns the exit code."""
    from asset_factory.sim_checks.judge import Judge
    from asset_factory.sim_checks.processes.isolation import processors

    simulators = simulators_named(command.sim)
    config = load_config(command.config).checks
    files = _described(command.files)
    reports = []
    printed = command.json is None or str(command.json) != "-"
    with Judge(config, processors()) as judge:
        for path, name in files:
            report = judge.check(path, simulators)
            reports.append(replace(report, description=name or report.description))
            if printed:
                console.print_report(reports[-1])
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


def _described(paths: Sequence[Path]) -> list[tuple[Path, str | None]]:
    """Every file to judge; in a folder with their path, to tell ``asset.urdf`` from another."""
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
