"""The asker's side: a network that is elsewhere, and the same one at home where that is gone."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..particulate.inference import Network
from ..particulate.prediction import Prediction
from ..particulate.sampling import Cloud
from .wire import Message, WireError, pack, receive, send, unpack


@dataclass(frozen=True)
class Address:
    """Where a service is asked.

    Attributes:
        path: of its socket, in a folder that goes when the service is given up for good.
        start_s: longest to wait for a service that starts, or starts again [s].
        answer_s: longest to wait for an answer, the turn of others included [s].
    """

    path: str
    start_s: float = 20.0
    answer_s: float = 300.0


_ADDRESS: ContextVar[Address | None] = ContextVar("model_service", default=None)


@contextmanager
def asking(address: Address | None) -> Iterator[None]:
    """Have networks asked there within this; with ``None``, at home."""
    before = _ADDRESS.set(address)
    try:
        yield
    finally:
        _ADDRESS.reset(before)


def network_for(identity: str, own: Callable[[], Network]) -> Network:
    """Return the service's network if there is a service, else one's own.

    A service that has a network of another identity is not listened to.
    """
    address = _ADDRESS.get()
    return own() if address is None else ServedNetwork(address, identity, own)


class ServedNetwork:
    """Asks a service; after the first question that gets no answer, its own network."""

    def __init__(self, address: Address, identity: str, own: Callable[[], Network]) -> None:
        self._address = address
        self._identity = identity
        self._load = own
        self._own: Network | None = None

    def __call__(self, cloud: Cloud, context: Cloud, least_confidence: float = 0.0) -> Prediction:
        """See :class:`..inference.Network`."""
        if self._own is None:
            with suppress(OSError, WireError, ValueError, TypeError):
                return self._ask(cloud, context, least_confidence)
            self._own = self._load()
        return self._own(cloud, context, least_confidence)

    def _ask(self, cloud: Cloud, context: Cloud, least_confidence: float) -> Prediction:
        deadline = time.monotonic() + self._address.answer_s
        texts = {"identity": self._identity, "least_confidence": repr(float(least_confidence))}
        asked = Message(texts, {**_seen("cloud", cloud), **_seen("context", context)})
        with _connected(self._address) as connection:
            send(connection, pack(asked), deadline)
            answer = unpack(receive(connection, deadline))
        if "refused" in answer.texts:
            raise WireError(answer.texts["refused"])
        if len(answer.arrays.get("mask_logits", ())) != len(cloud.points):
            raise WireError("the answer is about another cloud")
        return Prediction(**answer.arrays)


@contextmanager
def _connected(address: Address) -> Iterator[socket.socket]:
    """Yield a connection, once the service listens; OSError when it is late or gone for good."""
    patient_until = time.monotonic() + address.start_s
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        connection.settimeout(address.start_s)
        while True:
            try:
                connection.connect(address.path)
                break
            except OSError:
                if time.monotonic() > patient_until or not Path(address.path).parent.is_dir():
                    raise
            time.sleep(0.05)
        yield connection


def _seen(name: str, cloud: Cloud) -> dict[str, Any]:
    """Return what the network looks at, in the numbers it computes with."""
    return {
        f"{name}.points": np.asarray(cloud.points, np.float32),
        f"{name}.normals": np.asarray(cloud.normals, np.float32),
        f"{name}.components": cloud.components,
    }
