"""The asker's side: a network that is elsewhere, and the same one at home where that is gone."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...mesh import Float32Array, IntArray
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

    def __call__(self, cloud: Cloud, context: Cloud) -> Prediction:
        """See :class:`..inference.Network`."""
        if self._own is None:
            given = {**_seen("cloud", cloud), **_seen("context", context)}
            try:
                answer = self._ask("predict", {}, given)
                token = answer.texts.get("token")
                if len(answer.arrays.get("mask_logits", ())) != len(cloud.points):
                    raise WireError("the answer is about another cloud")
                closest = None if token is None else partial(self._closest, token, cloud, context)
                return Prediction(closest_points=closest, **answer.arrays)
            except (OSError, WireError, ValueError, TypeError):
                pass
        return self._at_home()(cloud, context)

    def _ask(self, kind: str, texts: dict[str, str], arrays: dict[str, Any]) -> Message:
        deadline = time.monotonic() + self._address.answer_s
        question = pack(Message(kind, {"identity": self._identity, **texts}, arrays))
        with _connected(self._address) as connection:
            send(connection, question, deadline)
            answer = unpack(receive(connection, deadline))
        if answer.kind == "refused":
            raise WireError(answer.texts.get("why", "no answer"))
        return answer

    def _closest(
        self,
        token: str,
        cloud: Cloud,
        context: Cloud,
        part_ids: IntArray,
        rows: IntArray | None = None,
    ) -> Float32Array:
        """See :class:`..prediction.ClosestPoints`; asked at home where the answer is not held."""
        picked = np.arange(len(cloud.points)) if rows is None else np.asarray(rows)
        try:
            wanted = {"part_ids": np.asarray(part_ids), "rows": picked}
            found = self._ask("closest", {"token": token}, wanted).arrays["points"]
            if found.shape == (len(picked), 3):
                return found
        except (OSError, WireError, KeyError):
            pass
        again = self._at_home()(cloud, context).closest_points
        assert again is not None, "the same network gives the same kind of answer"  # noqa: S101
        return again(part_ids, picked)

    def _at_home(self) -> Network:
        if self._own is None:
            self._own = self._load()
        return self._own


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
