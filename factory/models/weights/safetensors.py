"""The safetensors format through its own library, with limits before and order after.

The library parses headers of up to 100 MB and takes the last of two tensors of one name; it writes
metadata in another order each time.
"""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

import numpy as np
import numpy.typing as npt

from ...errors import ConfigError
from ...runtime.store import writing

T = TypeVar("T")
Tensor = Any
Shape = tuple[int, ...]


@dataclass(frozen=True)
class Checkpoint:
    """A file of tensors.

    Attributes:
        file: where, as messages name it.
        stored: the safetensors file that holds the tensors.
        shapes: elements per dimension, by name.
        dtypes: types, as the safetensors format names them, e.g. ``F32``, by name.
        metadata: what the file says about itself.
    """

    file: Path
    stored: Path
    shapes: Mapping[str, Shape]
    dtypes: Mapping[str, str]
    metadata: Mapping[str, str]

    def read(self, reader: Callable[[Mapping[str, Shape]], T]) -> T:
        """Return what a reader makes of the shapes; what it raises names the file."""
        try:
            return reader(self.shapes)
        except ConfigError as error:
            raise ConfigError(f"{self.file}: {error}") from error

    def load(self, leave: tuple[str, ...] = (), framework: str = "pt") -> dict[str, Tensor]:
        """Return the tensors, but those whose names begin with one of ``leave``.

        Those of torch (``pt``) are the file itself; those of ``numpy`` are in memory of their own.

        Raises:
            ConfigError: the file ends before a tensor does, or the framework has not its type.
        """
        from safetensors import SafetensorError, safe_open

        names = [name for name in self.shapes if not name.startswith(leave)]
        try:
            with safe_open(self.stored, framework=framework) as opened:
                return {name: opened.get_tensor(name) for name in names}
        except (SafetensorError, TypeError) as error:
            raise _unreadable(self.file, error) from error


_LENGTH = struct.Struct("<Q")
_MAX_HEADER = 16_000_000
_METADATA = "__metadata__"
_LETTERS_SAID = 200


def read_safetensors(file: Path) -> Checkpoint:
    """Return what a safetensors file holds; no tensor is read yet.

    Raises:
        ConfigError: no such format, or a tensor that the file does not hold to its end.
    """
    from safetensors import SafetensorError, safe_open

    header = _header(file)
    try:
        with safe_open(file, framework="numpy") as opened:
            parts = {name: opened.get_slice(name) for name in opened.keys()}  # noqa: SIM118
            metadata = opened.metadata() or {}
        json.loads(header, object_pairs_hook=_without_doubles)
    except (SafetensorError, ValueError) as error:
        raise _unreadable(file, error) from error
    shapes = {name: tuple(part.get_shape()) for name, part in parts.items()}
    dtypes = {name: part.get_dtype() for name, part in parts.items()}
    return Checkpoint(file, file, shapes, dtypes, metadata)


def write_safetensors(
    file: Path, tensors: Mapping[str, Tensor], metadata: Mapping[str, str]
) -> None:
    """Write tensors, the whole file or none; the same tensors give the same bytes.

    Raises:
        ConfigError: the format has no name for a tensor's type.
    """
    from safetensors.torch import save_file

    owned = {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}
    _write(file, partial(save_file, owned), metadata)


def write_arrays(
    file: Path, arrays: Mapping[str, npt.NDArray[Any]], metadata: Mapping[str, str]
) -> None:
    """Write arrays as :func:`write_safetensors` writes tensors; imports no torch."""
    from safetensors.numpy import save_file

    owned = {name: np.array(array, order="C") for name, array in arrays.items()}
    _write(file, partial(save_file, owned), metadata)


def _write(file: Path, save: Callable[..., None], metadata: Mapping[str, str]) -> None:
    with writing(file) as stream:
        try:
            save(stream.name, dict(metadata) or None)
        except (KeyError, ValueError) as error:
            raise ConfigError(f"{file}: cannot be saved as safetensors: {error}") from error
        _put_in_order(stream)
        # The library puts a file of its own in place, which only its user may read.
        os.chmod(stream.name, 0o644)


def _header(file: Path) -> bytes:
    size = file.stat().st_size
    with file.open("rb") as stream:
        prefix = stream.read(_LENGTH.size)
        if len(prefix) < _LENGTH.size:
            raise ConfigError(f"{file}: {size} bytes are too few for a safetensors file")
        length = int(_LENGTH.unpack(prefix)[0])
        if length > min(_MAX_HEADER, size - _LENGTH.size):
            says = f"says its header takes {length} of {size} bytes"
            raise ConfigError(f"{file}: not safetensors, or cut off: {says}")
        return stream.read(length)


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"{next(name for name in names if names.count(name) > 1)} appears twice")
    return found


def _put_in_order(stream: BinaryIO) -> None:
    """Sort the metadata of a file that is being written, within the room that its header takes."""
    with open(stream.name, "r+b") as file:
        (length,) = _LENGTH.unpack(file.read(_LENGTH.size))
        header = json.loads(file.read(length))
        if _METADATA in header:
            header[_METADATA] = dict(sorted(header[_METADATA].items()))
        text = json.dumps(header, separators=(",", ":"), ensure_ascii=False).encode()
        if len(text) > length:
            raise ValueError(f"a header of {length} bytes takes {len(text)} when it is sorted")
        file.seek(_LENGTH.size)
        file.write(text.ljust(length))


def _unreadable(file: Path, error: Exception) -> ConfigError:
    said = str(error).removeprefix("Error while deserializing header: ")[:_LETTERS_SAID]
    return ConfigError(f"{file}: not safetensors, damaged or cut off: {said}")
