"""Messages between a service and its clients: a word, short texts, plain arrays; no code."""

from __future__ import annotations

import json
import math
import socket
import struct
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

#: Longest message [bytes]: a cloud of a million points, or what a network says of it.
MOST_BYTES = 128 * 1024**2
MOST_HEADER_BYTES = 65536
DTYPES = {name: np.dtype(name) for name in ("<f4", "<i8")}
_LENGTHS = struct.Struct("<II")


class WireError(Exception):
    """What came is no message."""


@dataclass(frozen=True)
class Message:
    """One question or answer.

    Attributes:
        kind: of the question or answer.
        texts: short ones, by name.
        arrays: float32 or int64, by name.
    """

    kind: str
    texts: Mapping[str, str] = field(default_factory=dict)
    arrays: Mapping[str, Array] = field(default_factory=dict)


def pack(message: Message) -> bytes:
    """Return a message as bytes: two lengths, a header of JSON, then one array after another.

    Raises:
        WireError: it would be too long.
    """
    arrays = {
        name: np.asarray(array, _wire_dtype(array), order="C")
        for name, array in message.arrays.items()
    }
    listed = [[name, array.dtype.str, list(array.shape)] for name, array in arrays.items()]
    said = {"kind": message.kind, "texts": dict(message.texts), "arrays": listed}
    header = json.dumps(said).encode()
    body = b"".join(array.tobytes() for array in arrays.values())
    _check_lengths(len(header), len(body))
    return _LENGTHS.pack(len(header), len(body)) + header + body


def unpack(data: bytes) -> Message:
    """Return the message that some bytes hold. Raises WireError: they hold none."""
    header_bytes, body_bytes = _lengths(data)
    announced = _LENGTHS.size + header_bytes + body_bytes
    if len(data) != announced:
        raise WireError(f"a message of {len(data)} bytes says it has {announced}")
    try:
        header = json.loads(data[_LENGTHS.size : _LENGTHS.size + header_bytes])
        kind = str(header["kind"])
        listed = ((str(name), DTYPES[code], shape) for name, code, shape in header["arrays"])
        shapes = [(name, dtype, tuple(map(int, shape))) for name, dtype, shape in listed]
        texts = {str(name): str(text) for name, text in header["texts"].items()}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise WireError(f"its header cannot be read: {type(error).__name__}: {error}") from error
    arrays = {}
    start = _LENGTHS.size + header_bytes
    for name, dtype, shape in shapes:
        count = math.prod(shape)
        if min(shape, default=0) < 0 or start + count * dtype.itemsize > len(data):
            raise WireError(f"{name}: shape {shape} does not fit a message of {len(data)} bytes")
        arrays[name] = np.frombuffer(data, dtype, count, start).reshape(shape)
        start += count * dtype.itemsize
    if start != len(data):
        raise WireError(f"{len(data) - start} bytes are left over")
    return Message(kind, texts, arrays)


def send(connection: socket.socket, data: bytes, deadline: float) -> None:
    """Send one packed message by a ``time.monotonic()`` deadline; raises OSError, TimeoutError."""
    connection.settimeout(_left(deadline))
    connection.sendall(data)


def receive(connection: socket.socket, deadline: float) -> bytes:
    """Receive one packed message; memory is taken as bytes come, not because a header says so.

    Raises:
        OSError: the other side is gone, or the deadline came (TimeoutError).
        WireError: longer than any message may be.
    """
    lengths = _receive_exactly(connection, _LENGTHS.size, deadline)
    return lengths + _receive_exactly(connection, sum(_lengths(lengths)), deadline)


def _receive_exactly(connection: socket.socket, count: int, deadline: float) -> bytes:
    received = bytearray()
    while len(received) < count:
        connection.settimeout(_left(deadline))
        piece = connection.recv(min(count - len(received), 1 << 20))
        if not piece:
            raise ConnectionResetError("the other side left in the middle of a message")
        received += piece
    return bytes(received)


def _lengths(data: bytes) -> tuple[int, int]:
    if len(data) < _LENGTHS.size:
        raise WireError(f"a message of {len(data)} bytes has no header")
    header, body = _LENGTHS.unpack_from(data)
    _check_lengths(header, body)
    return header, body


def _check_lengths(header: int, body: int) -> None:
    if header > MOST_HEADER_BYTES or body > MOST_BYTES:
        most = f"{MOST_HEADER_BYTES} and {MOST_BYTES} at most"
        raise WireError(f"a header of {header} and a body of {body} bytes; {most}")


def _left(deadline: float) -> float:
    left = deadline - time.monotonic()
    if left <= 0.0:
        raise TimeoutError("no time is left")
    return left


def _wire_dtype(array: Array) -> np.dtype[Any]:
    return DTYPES["<i8"] if np.issubdtype(array.dtype, np.integer) else DTYPES["<f4"]
