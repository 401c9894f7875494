"""One network on every node of a Ray cluster; or one on a GPU, with a socket on every node."""

from __future__ import annotations

import os
import shutil
import socket
import threading
import uuid
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from ...config import ParticulateConfig
from ...models.particulate.device import device_for
from ...models.service import Address
from ...models.service.answering import Answering, LoadedNetwork, refusal
from ...models.service.process import answer_all, listening_socket, load_named
from ...models.weights.sources import weights_at
from .weights import SentWeights, arrived

#: Clouds that wait for one GPU at a time.
AT_A_GPU = 64
#: How long a node may take to say that it closed its socket [s].
GOODBYE_S = 5.0
RELAY_S = 240.0


class Networks:
    """The networks of one run on a cluster."""

    def __init__(self, ray: Any, config: ParticulateConfig, weights: SentWeights) -> None:
        self._ray = ray
        self._config = config
        self._weights = weights
        self._address = Address(f"/tmp/model-{uuid.uuid4().hex}/socket")  # noqa: S108 - nobody can guess it
        self._shared: Any = None
        self._sockets: dict[str, Any] = {}

    @property
    def address(self) -> Address | None:
        """Return where calls ask; ``None`` if there is nobody to ask."""
        return self._address if self._sockets else None

    def look(self) -> None:
        """Open a socket on every node that has none."""
        on_gpu = device_for(self._config.device) != "cpu"
        if on_gpu and self._shared is None:
            if self._ray.cluster_resources().get("GPU", 0.0) < 1.0:
                return
            shared = self._ray.remote(NodeNetwork).options(
                num_cpus=0, num_gpus=1, max_restarts=-1, max_concurrency=AT_A_GPU
            )
            self._shared = shared.remote(self._config, self._weights)
        affinity = self._ray.util.scheduling_strategies.NodeAffinitySchedulingStrategy
        for node in self._ray.nodes():
            name = node["NodeID"]
            if node["Alive"] and name not in self._sockets:
                placed = self._ray.remote(NodeSocket).options(
                    num_cpus=0, max_restarts=-1, scheduling_strategy=affinity(name, soft=False)
                )
                self._sockets[name] = placed.remote(
                    self._address.path, self._config, self._shared, self._weights
                )

    def close(self) -> None:
        """Close all sockets, and end the networks behind them."""
        with suppress(Exception):
            closing = [each.close.remote() for each in self._sockets.values()]
            self._ray.wait(closing, num_returns=len(closing), timeout=GOODBYE_S)
        for actor in (*self._sockets.values(), self._shared):
            if actor is not None:
                with suppress(Exception):
                    self._ray.kill(actor)


class NodeNetwork:
    """A network in a Ray process."""

    def __init__(self, config: ParticulateConfig, weights: SentWeights) -> None:
        self._answering = Answering(partial(_load, config, weights))

    def answer(self, question: bytes) -> bytes:
        """See :class:`...models.service.answering.Answering`."""
        return self._answering(question)


def _load(config: ParticulateConfig, weights: SentWeights) -> LoadedNetwork:
    import ray

    with weights_at(arrived(ray, weights)):
        return load_named(config)


class NodeSocket:
    """A node's socket, in a Ray process; behind it an own network, or the one all nodes share."""

    def __init__(
        self, path: str, config: ParticulateConfig, shared: Any, weights: SentWeights
    ) -> None:
        self._path = path
        self._shared = shared
        self._own = NodeNetwork(config, weights)
        os.makedirs(Path(path).parent, mode=0o700, exist_ok=True)
        # Nodes that are one machine share its socket.
        if not _somebody_listens(path):
            threading.Thread(
                target=answer_all, args=(listening_socket(path), self._answer), daemon=True
            ).start()

    def close(self) -> None:
        """Remove its folder: nobody waits for it any more."""
        shutil.rmtree(Path(self._path).parent, ignore_errors=True)

    def _answer(self, question: bytes) -> bytes:
        try:
            if self._shared is None:
                return self._own.answer(question)
            import ray

            relayed: bytes = ray.get(self._shared.answer.remote(question), timeout=RELAY_S)
            return relayed
        except Exception as error:  # noqa: BLE001 - who asks will ask at home
            return refusal(error)


def _somebody_listens(path: str) -> bool:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        return probe.connect_ex(path) == 0
