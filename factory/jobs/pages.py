"""The report of a registry, drawn by a few workers: only new or changed assets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from asset_factory.sim_checks.processes.isolation import Limits

from ..errors import ConfigError
from ..registry import Registry
from ..report.site.site import stale, write_asset, write_index
from .executor import Call
from .local import LocalExecutor

#: Of one asset's page: far more than any took.
LIMITS = Limits(wall_s=180.0)
LIBRARIES = ("embreex", "jinja2", "PIL")


@dataclass(frozen=True)
class PagesDrawn:
    """The pages drawn.

    Attributes:
        index: the first page.
        drawn: pages that were written.
        failed: assets whose page could not be drawn, each with the reason.
    """

    index: Path
    drawn: int
    failed: tuple[str, ...] = ()


def missing_library() -> str | None:
    """Return what the report needs and is not installed, as a sentence."""
    for library in LIBRARIES:
        if find_spec(library) is None:
            return f"the report needs {library}: pip install 'asset-factory[build]'"
    return None


def draw_pages(
    registry: Registry, workers: int, progress: Callable[[int, int], None] | None = None
) -> PagesDrawn:
    """Write or renew the site of a registry, which others may use meanwhile.

    ``progress`` is told how many pages are done, of how many.

    Raises:
        ConfigError: a library is missing.
        OSError: the site cannot be written.
    """
    missing = missing_library()
    if missing is not None:
        raise ConfigError(missing)
    old = tuple(stale(registry))
    calls = [Call(entry.id, {"root": registry.root, "entry": entry}) for entry in old]
    failed = []
    executor = LocalExecutor(workers, calls=500)
    for done, (call, outcome) in enumerate(executor.run(write_asset, calls, LIMITS), start=1):
        if isinstance(outcome.error, OSError):
            raise outcome.error
        if outcome.failure is not None:
            failed.append(f"{call.name}: {outcome.detail}")
        if progress is not None:
            progress(done, len(calls))
    index = write_index(registry)
    return PagesDrawn(index, len(calls) - len(failed), tuple(sorted(failed)))
