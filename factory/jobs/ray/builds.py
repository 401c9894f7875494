"""Builds on a Ray cluster: what the executor must know of them."""

from __future__ import annotations

from ...articulate.catalog import entry_of
from ...config import BuildConfig
from ..job import modules_for
from .cluster import LOCAL
from .executor import RayExecutor


def ray_executor(
    config: BuildConfig, *, workers: int | None = None, address: str = LOCAL, exchange: str = ""
) -> RayExecutor:
    """Return the executor to give to a :class:`~.job.Job`.

    ``exchange`` is fsspec's URL through which bundles come back; inputs and checkpoints are sent to
    nodes then. It is empty if the registry's folder and the inputs lie where all nodes see them,
    which also lets them share a cache.
    """
    learned = entry_of(config.articulator).asks_network
    return RayExecutor(
        workers=workers,
        address=address,
        retries=config.retries,
        modules=modules_for(config),
        exchange=exchange,
        network=config.particulate if learned else None,
    )
