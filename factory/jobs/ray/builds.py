"""Builds on a Ray cluster: what the executor must know of them."""

from __future__ import annotations

from importlib.util import find_spec

from ...articulate.catalog import entry_of
from ...config import BuildConfig
from ..job import modules_for
from .cluster import LOCAL
from .exchange import Exchange
from .executor import RayExecutor
from .network import Asked

#: Arguments of :func:`~..worker.build_here`.
STAGING = "staging"
CACHE = "cache"
ADDRESS = "address"


def ray_executor(
    config: BuildConfig, *, workers: int | None = None, address: str = LOCAL, exchange: str = ""
) -> RayExecutor:
    """The executor to give to a :class:`~.job.Job`, with ``one_network=False``.

    Args:
        config: with which inputs are built.
        workers: inputs at once; by default as many as the cluster has room for.
        address: of the cluster, see :class:`~.ray_executor.RayExecutor`.
        exchange: fsspec's URL through which bundles come back; empty if the registry's folder lies
            where all nodes see it, which also lets them share its cache.
    """
    learned = entry_of(config.articulator).asks_network and find_spec("torch") is not None
    return RayExecutor(
        workers=workers,
        address=address,
        retries=config.retries,
        modules=modules_for(config),
        exchange=Exchange(STAGING, exchange, absent=(CACHE,)),
        network=Asked(config.particulate, ADDRESS) if learned else None,
    )
