"""The report of a registry, drawn by a few workers: only new or changed assets."""

from __future__ import annotations

from collections.abc import Callable

from asset_factory.sim_checks.processes.isolation import Limits

from ..registry import Registry
from ..report.pages import require_libraries
from ..report.site.site import stale, write_asset, write_index
from .executor import Call
from .local import LocalExecutor

#: Of one asset's page: far more than any took.
LIMITS = Limits(wall_s=180.0)


def draw_pages(
    registry: Registry, workers: int, progress: Callable[[int, int], None]
) -> tuple[str, ...]:
    """Write or renew the site of a registry, which others may use meanwhile.

    ``progress`` is told how many pages are done, of how many.

    Returns:
        A sentence for each asset whose page could not be drawn.

    Raises:
        ConfigError: a library is missing.
        OSError: the site cannot be written.
    """
    require_libraries()
    old = tuple(stale(registry))
    calls = [Call(entry.id, {"root": registry.root, "entry": entry}) for entry in old]
    failed = []
    executor = LocalExecutor(workers, calls=500)
    for done, (call, outcome) in enumerate(executor.run(write_asset, calls, LIMITS), start=1):
        if isinstance(outcome.error, OSError):
            raise outcome.error
        if outcome.failure is not None:
            failed.append(f"{call.name}: {outcome.detail}")
        progress(done, len(calls))
    write_index(registry)
    return tuple(sorted(failed))
