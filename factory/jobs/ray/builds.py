"""Builds on a Ray cluster: what the executor must know of them."""

from __future__ import annotations

from ...articulate.catalog import entry_of
from ...config import BuildConfig
from ...intake.reads import Reads
from ...registry.product import Product
from ..job import modules_for
from .cluster import LOCAL
from .exchange import Exchange
from .executor import RayExecutor
from .inputs import Inputs
from .network import Asked
from .weights import Checkpoints

#: Arguments of :func:`~..worker.build_here`.
STAGING = "staging"
CACHE = "cache"
ADDRESS = "address"
SOURCE = "source"
PLACE = "place"
WEIGHTS = "weights"


def ray_executor(
    config: BuildConfig, *, workers: int | None = None, address: str = LOCAL, exchange: str = ""
) -> RayExecutor:
    """Return the executor to give to a :class:`~.job.Job`, with ``one_network=False``.

    ``exchange`` is fsspec's URL through which bundles come back; inputs and checkpoints are sent to
    nodes then. It is empty if the registry's folder and the inputs lie where all nodes see them,
    which also lets them share a cache.
    """
    network = config.particulate
    named = (network.checkpoint, network.features)
    learned = entry_of(config.articulator).asks_network
    return RayExecutor(
        workers=workers,
        address=address,
        retries=config.retries,
        modules=modules_for(config),
        exchange=Exchange(STAGING, exchange, absent=(CACHE,)),
        network=Asked(network, ADDRESS) if learned else None,
        inputs=Inputs(SOURCE, PLACE, files_of) if exchange else None,
        weights=Checkpoints(WEIGHTS, named) if exchange and learned else None,
    )


def files_of(product: Product | None) -> Reads:
    """Return what an input was made of, as far as a call's value says."""
    return {} if product is None else product.reads
