"""Messages between a service and its clients: short texts and plain arrays; no code.

A message is a safetensors file in memory, whose metadata are the texts, and ends where its sender
stops sending.
"""

from __future__ import annotations

import json
import socket
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

#: Longest message [bytes]: a cloud of a million points, or what a network says of it.
MOST_BYTES = 128 * 1024**2
#: Longest of what a message says of itself: its texts, and the shapes of its arrays [bytes].
MOST_HEADER_BYTES = 65536
_LENGTH_BYTES = 8


class WireError(Exception):
    """What came is no message."""


@dataclass(frozen=True)
class Message:
    """One question or answer.

    Attributes:
        texts: short ones, by name.
        arrays: float32 or int64, by name.
    """

    texts: Mapping[str, str]
    arrays: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)


def pack(message: Message) -> bytes:
    """Return a message as bytes. Raises WireError: it would be too long."""
    from safetensors.numpy import save

    arrays = {name: np.asarray(array, order="C") for name, array in message.arrays.items()}
    data = save(arrays, dict(message.texts))
    _check_length(len(data))
    return data


def unpack(data: bytes) -> Message:
    """Return the message that some bytes hold. Raises WireError: they hold none."""
    from safetensors import SafetensorError
    from safetensors.numpy import load

    length = int.from_bytes(data[:_LENGTH_BYTES], "little")
    if length > MOST_HEADER_BYTES:
        raise WireError(f"a header of {length} bytes; {MOST_HEADER_BYTES} at most")
    try:
        arrays = load(data)
        texts = json.loads(data[_LENGTH_BYTES : _LENGTH_BYTES + length])["__metadata__"]
        return Message(texts, arrays)
    except (SafetensorError, ValueError, KeyError, TypeError) as error:
        raise WireError(f"it cannot be read: {type(error).__name__}: {error}") from error


def send(connection: socket.socket, data: bytes, deadline: float) -> None:
    """Send one packed message by a ``time.monotonic()`` deadline; raises OSError, TimeoutError."""
    connection.settimeout(_left(deadline))
    connection.sendall(data)
    connection.shutdown(socket.SHUT_WR)


def receive(connection: socket.socket, deadline: float) -> bytes:
    """Receive one packed message; memory is taken as bytes come.

    Raises:
        OSError: the other side is gone, or the deadline came (TimeoutError).
        WireError: longer than any message may be.
    """
    received = bytearray()
    while True:
        connection.settimeout(_left(deadline))
        piece = connection.recv(1 << 20)
        if not piece and not received:
            raise ConnectionResetError("the other side left without a word")
        if not piece:
            return bytes(received)
        received += piece
        _check_length(len(received))


def _check_length(count: int) -> None:
    if count > MOST_BYTES:
        raise WireError(f"a message of {count} bytes; {MOST_BYTES} at most")


def _left(deadline: float) -> float:
    left = deadline - time.monotonic()
    if left <= 0.0:
        raise TimeoutError("no time is left")
    return left
