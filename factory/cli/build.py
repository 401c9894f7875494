"""``factory build``: meshes in, a registry out."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import tyro

from asset_factory.sim_checks import Status

from ..config import BuildConfig
from ..errors import ConfigError, Exit, RegistryError
from ..registry import Registry
from ..registry.result import Result
from ..runtime.layout import SUMMARY
from ..runtime.store import write_json
from ..runtime.terminal import complain, say
from . import console
from .flags import (
    DEFAULT_SIMULATORS,
    InputFlags,
    formats_asked,
    input_config,
    simulators_named,
    with_repairs,
)
from .report import report_after

if TYPE_CHECKING:
    from ..jobs.job import Job
    from ..report.summary import Summary


@dataclass(frozen=True)
class Build:
    """Turn meshes into simulation-checked assets and register what passes.

    The same command again does only what is missing: what the registry knows for the same input,
    settings and libraries is not built again.

    Exit codes: 0 every input got a verdict; 3 some input could not be validated; 2 wrong usage, or
    the output cannot be written; 1 something was rejected and --strict was given; 130, 143
    interrupted (what was finished is registered).

    Example: factory build --input meshes/ --output out/ --sim all
    """

    input: tuple[str, ...]
    """Meshes (GLB, glTF, OBJ, PLY, STL, OFF), URDF, xacro, MJCF, USD, folders of them, or URLs."""
    output: Path
    """The registry's folder; made if it is not there."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that validate, separated by commas; 'all' is sapien,mujoco,pybullet."""
    formats: str = "urdf,mjcf"
    """What assets are written in, separated by commas: urdf and mjcf always, sdf, usd, glb."""
    workers: int | None = None
    """Inputs built at once; as many as there are processors and memory for by default."""
    limit: int | None = None
    """Build at most so many; those known from before are not counted."""
    max_hours: float | None = None
    """Stop after so long [h]; inputs under way or not begun then are left to the next run."""
    since: str | None = None
    """Only inputs modified since: seconds ago, a date such as 2026-11-21, or a file's own time."""
    retry_rejected: tuple[str, ...] = ()
    """Build again what was rejected or could not be validated for these reasons; 'any': for any."""
    repair: bool = False
    """Verify the files of known assets, and build damaged ones again."""
    executor: Literal["local", "ray"] = "local"
    """Where workers run: on this machine, or on a Ray cluster."""
    ray_address: str = "local"
    """With --executor ray: 'auto' or host:port of a cluster that runs; 'local' starts one."""
    ray_exchange: str = ""
    """With --executor ray: fsspec URL through which nodes without a shared folder send assets."""
    repairs: str | None = None
    """What may be repaired: none, geometry (collision geometry only), or all (joints too)."""
    no_interior: bool = False
    """Invent nothing behind the panels of a one-piece mesh: no hollows, no drawers' boxes."""
    no_report: bool = False
    """Leave the pages of the registry as they are; see `factory report`."""
    json: bool = False
    """Print the summary as JSON, as in summary.json."""
    quiet: bool = False
    """Print nothing but what went wrong; exit code and summary.json tell the rest."""
    strict: bool = False
    """Exit with 1 when anything was rejected."""
    loading: tyro.conf.OmitArgPrefixes[InputFlags] = field(default_factory=InputFlags)
    """How inputs are loaded and articulated."""


def run(command: Build) -> int:
    """Build every input; returns the exit code."""
    # Geometry libraries load only to build.
    from ..jobs.signals import Terminated, interruptible
    from ..report.summary import JobState, Summary

    inputs = wanted_inputs(command)
    if not inputs and command.since is None:
        raise ConfigError(_nothing_found(command))
    job = job_for(command, inputs)
    for sentence in (*passed_over(command), *idle_retries(command)):
        complain(f"factory: {sentence}")
    results: list[Result] = []
    stopped = 0
    try:
        with interruptible(partial(_wind_up, job)):
            results += console.follow(job.run(), len(inputs), job.under_way, quiet=command.quiet)
    except KeyboardInterrupt as interruption:
        stopped = Exit.TERMINATED if isinstance(interruption, Terminated) else Exit.INTERRUPTED
    left = len(inputs) - len(results)
    summary = Summary(tuple(results), JobState.INTERRUPTED if stopped else job.state, left)
    path = command.output / SUMMARY
    try:
        write_json(path, summary.to_dict())
    except OSError as error:
        raise RegistryError(f"{path}: cannot be written: {error.strerror}") from error
    if summary.state is JobState.INTERRUPTED:
        done = f"what was finished is registered, {left} inputs are left"
        complain(f"factory: interrupted; {done}; the same command goes on with them")
        return stopped or Exit.INTERRUPTED
    _show(summary, command)
    page = report_after(command.output, command.workers) if not command.no_report else None
    if page is not None and not (command.json or command.quiet):
        say(f"Report: {page}")
    if summary.count(Status.UNJUDGED):
        return Exit.UNJUDGED
    return Exit.REJECTED if command.strict and summary.count(Status.REJECTED) else Exit.OK


def _wind_up(job: Job) -> None:
    job.wind_up()
    complain("factory: finishing what is begun; Ctrl-C again stops at once")


def _show(summary: Summary, command: Build) -> None:
    if command.json:
        say(json.dumps(summary.to_dict(), indent=2))
    elif not command.quiet:
        console.print_results(summary, command.output)
        if summary.left:
            left = f"{summary.left} inputs are left ({summary.state.replace('_', ' ')})"
            say(f"{left}; the same command goes on with them.")


def wanted_inputs(command: Build) -> tuple[Path, ...]:
    """Find the inputs that flags name. Raises ConfigError: one is missing, or bad ``--since``."""
    from ..intake.discover import find_inputs
    from ..intake.mirror import local_inputs
    from ..jobs.budget import modified_since, parse_since

    inputs = find_inputs(local_inputs(command.input, command.output))
    if command.since is None:
        return inputs
    return tuple(modified_since(inputs, parse_since(command.since)))


def _nothing_found(command: Build) -> str:
    """Return what to say where no file is an input."""
    from ..intake.formats.catalog import FORMATS

    known = " ".join(line.suffix for line in FORMATS if line.stands_alone)
    found = f"no input in {', '.join(command.input)}; want {known} .urdf .xml or USD files"
    return " and ".join([found, *passed_over(command)])


def passed_over(command: Build) -> Iterator[str]:
    """Yield a sentence about links that lead out of the folders given, if there are any."""
    from ..intake.discover import links_out
    from ..intake.mirror import mirror_of

    links = links_out([mirror_of(place, command.output) for place in command.input])
    if links:
        passed = f"passed over {len(links)} links that lead out of the input folder"
        yield f"{passed}, such as {links[0]}; name them with --input to have them built"


def idle_retries(command: Build) -> Iterator[str]:
    """Yield one sentence per retry reason that nothing in the registry has, with those it has."""
    from ..jobs.budget import ANY

    known = Registry(command.output).values("reason") if command.retry_rejected else ()
    for reason in command.retry_rejected:
        if reason not in (*known, ANY):
            there = f"there are {', '.join(known)}" if known else "nothing was rejected so far"
            yield f"--retry-rejected: nothing was rejected for {reason!r}; {there}"


def job_for(command: Build, inputs: tuple[Path, ...]) -> Job:
    """Return the job that flags ask for. Raises ConfigError: a bad flag, and what is right."""
    from ..jobs import Budget, executor_for
    from ..jobs.job import Job

    config = build_config(command)
    if command.executor != "ray" and (command.ray_address != "local" or command.ray_exchange):
        raise ConfigError("--ray-address and --ray-exchange want --executor ray")
    place = (command.ray_address, command.ray_exchange)
    executor = executor_for(config, command.executor, command.workers, *place)
    max_s = None if command.max_hours is None else 3600.0 * command.max_hours
    budget = Budget(command.limit, max_s, command.retry_rejected, command.repair)
    return Job(inputs, command.output, config, executor, budget)


def build_config(command: Build) -> BuildConfig:
    """Return the configuration that the flags ask for."""
    from ..intake.mirror import mirror_of

    config = input_config(command.loading, here=command.executor == "local")
    config = with_repairs(config, command.repairs)
    folders = (mirror_of(place, command.output).absolute() for place in command.input)
    given = (*(str(folder) for folder in folders if folder.is_dir()), *config.intake.given)
    interior = config.solids.interior and not command.no_interior
    return replace(
        config,
        intake=replace(config.intake, given=given),
        simulators=simulators_named(command.sim),
        formats=formats_asked(command.formats),
        solids=replace(config.solids, interior=interior),
    )
