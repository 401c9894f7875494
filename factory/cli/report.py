"""``factory report``: a registry as pages that people look at."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..errors import ConfigError, Exit, RegistryError
from ..registry import Registry
from ..runtime.terminal import complain, say
from .flags import OfRegistry

#: Longest that one asset's page may take [s]: far more than any took.
PAGE_S = 180.0
#: After so many pages a worker is replaced.
PAGES = 500


@dataclass(frozen=True)
class ReportPages(OfRegistry):
    """Write the report of a registry: a grid of all assets, and a page with a viewer for each.

    It is written to <output>/report and needs neither a network nor a web server: open its
    index.html. Only pages of what is new or changed are drawn; `factory build` and `factory
    nightly` do the same at their end.
    """

    workers: int | None = None
    """Pages drawn at once; all processors by default."""


def run(command: ReportPages) -> int:
    """Write the pages; returns the exit code."""
    registry = Registry(command.output)
    if command.workers is not None and command.workers < 1:
        raise ConfigError(f"--workers must be at least 1, not {command.workers}")
    say(write_report(registry, command.workers))
    return Exit.OK


def write_report(registry: Registry, workers: int | None) -> Path:
    """Draw pages of new or changed assets by a few workers; others may use the registry meanwhile.

    Returns the first page; what could not be drawn is said on stderr.

    Raises:
        ConfigError: a library is missing.
        RegistryError: the pages cannot be written.
    """
    from asset_factory.sim_checks.processes.isolation import Limits, processors

    from ..jobs import Call, LocalExecutor
    from ..report.pages import require_libraries
    from ..report.site.site import index_of, stale, write_asset, write_index
    from . import console

    require_libraries()
    drawers = LocalExecutor(workers or processors(), calls=PAGES)
    failed = []
    try:
        calls = [Call(each.id, {"root": registry.root, "entry": each}) for each in stale(registry)]
        drawn = drawers.run(write_asset, calls, Limits(wall_s=PAGE_S))
        with console.counted("drawing pages") as progress:
            for done, (call, outcome) in enumerate(drawn, start=1):
                if isinstance(outcome.error, OSError):
                    raise outcome.error
                if outcome.failure is not None:
                    failed.append(f"factory: no page of {call.name}: {outcome.detail}")
                progress(done, len(calls))
        write_index(registry)
    except OSError as error:
        where = error.filename or registry.root
        raise RegistryError(f"{where}: the report cannot be written: {error.strerror}") from error
    for sentence in sorted(failed):
        complain(sentence)
    return index_of(registry.root)


def report_after(output: Path, workers: int | None) -> Path | None:
    """Write the report at the end of a build or a night; a failure is only told.

    Returns the first page; ``None`` where it could not be written, which is said on stderr.
    """
    try:
        return write_report(Registry(output), workers)
    except (ConfigError, RegistryError) as error:
        complain(f"factory: {error}")
        return None
