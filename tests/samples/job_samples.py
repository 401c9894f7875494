"""Inputs that are built in no time, and an executor that needs no processes."""

import os
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from laid import laid

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake.source import Source, asset_id
from asset_factory.factory.jobs import Call
from asset_factory.factory.jobs.job import Job
from asset_factory.factory.jobs.probe import KnownReads
from asset_factory.factory.registry import Entry
from asset_factory.factory.registry.keys import source_key
from asset_factory.factory.registry.product import Product
from asset_factory.factory.registry.report_file import BuildReport
from asset_factory.factory.registry.result import Result
from asset_factory.sim_checks import Report
from asset_factory.sim_checks.processes.isolation import Failure, Limits, Outcome

PLAIN = BuildConfig(articulator="rigid", simulators=())
MADE = "made.log"


class Inline:
    """Makes calls here, one after the other, in place of any executor."""

    def __init__(self, *_workers: int, **_settings: int) -> None:
        pass

    def run(
        self, function: Callable[..., Any], calls: Iterable[Call], limits: Limits
    ) -> Iterator[tuple[Call, Outcome[Any]]]:
        for call in calls:
            try:
                yield call, Outcome(function(**call.arguments), None, "", "", 0.0)
            except TimeoutError as error:
                yield call, Outcome(None, Failure.TIMEOUT, str(error), "", 0.0)
            except OSError as error:
                yield call, Outcome(None, "raised", str(error), "", 0.0, error)


def write_inputs(folder: Path, count: int, *named: str) -> tuple[Path, ...]:
    """Files that look like inputs, and some more of them by name."""
    stems = (*(f"thing_{number}" for number in range(count)), *named)
    return tuple(laid(folder / f"{stem}.stl", f"solid {stem}") for stem in stems)


def pretend(
    source: Path,
    staging: Path,
    config: BuildConfig,
    cache: Path,
    address: object,
    engines: int,
) -> Product:
    """In place of a build: the input's name tells the outcome; every time is noted beside it."""
    note(source)
    if "dies" in source.name:
        os.kill(os.getpid(), 11)
    if "full" in source.name:
        raise OSError(28, "No space left on device")
    if "nap" in source.name:
        time.sleep(2)
    if "slow" in source.name:
        time.sleep(60)
    origin = Source(source, config)
    origin.reads = dict(KnownReads(cache / "inputs", config).probe(source).reads)
    status, reason = ("rejected", "ugly") if "bad" in source.name else ("passed", "")
    name = asset_id(source.stem, origin.reads[source.name])
    entry = Entry(name, source.stem, "", status, reason, 1, 0, 1, key=source_key(origin))
    staging.mkdir(parents=True)
    (staging / "asset.urdf").write_text("<robot/>")
    bundle = staging if status == "passed" else None
    result = Result(str(source), entry)
    told = BuildReport(Report(""))
    return Product(result, told, bundle, (entry.id,), origin.reads)


def note(source: Path) -> None:
    """One line in one write, whoever else writes."""
    descriptor = os.open(source.parent / MADE, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    os.write(descriptor, f"{source.name} {os.getpid()}\n".encode())
    os.close(descriptor)


def made(folder: Path) -> list[str]:
    """Names of the inputs that were built, each as often as it was."""
    path = folder / MADE
    return [line.split()[0] for line in path.read_text().splitlines()] if path.exists() else []


def job(inputs: tuple[Path, ...], output: Path, config: BuildConfig = PLAIN, **rest: Any) -> Job:
    """A job without processes."""
    return Job(inputs, output, config, rest.pop("executor", Inline()), **rest)
