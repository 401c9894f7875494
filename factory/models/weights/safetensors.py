"""The safetensors format through its own library, with limits before and order after.

The library parses headers of up to 100 MB and takes the last of two tensors of one name; it writes
metadata in another order each time.
"""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from ...errors import ConfigError
from ...runtime.store import writing

Tensor = Any
Shape = tuple[int, ...]


@dataclass(frozen=True)
class StoredTensor:
    """One tensor of a file.

    Attributes:
        dtype: its type, as the safetensors format names it, e.g. ``F32``.
        shape: elements per dimension.
        load: reads it: a torch tensor, contiguous, in memory of its own. Raises ConfigError if the
            file ends before the tensor does.
    """

    dtype: str
    shape: Shape
    load: Callable[[], Tensor] = field(repr=False, compare=False)


@dataclass(frozen=True)
class Checkpoint:
    """A file of tensors.

    Attributes:
        file: where.
        tensors: by name.
        metadata: what the file says about itself.
    """

    file: Path
    tensors: Mapping[str, StoredTensor]
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def shapes(self) -> dict[str, Shape]:
        """Name to shape."""
        return {name: tensor.shape for name, tensor in self.tensors.items()}


Array = npt.NDArray[Any]
_LENGTH = struct.Struct("<Q")
_MAX_HEADER = 16_000_000
_METADATA = "__metadata__"
_LETTERS_SAID = 200


def read_safetensors(file: Path) -> Checkpoint:
    """Return what a safetensors file holds; no tensor is read yet.

    Raises:
        ConfigError: no such format, or a tensor that the file does not hold to its end.
    """
    library = _library()
    header = _header(file)
    try:
        with library.safe_open(file, framework="numpy") as opened:
            tensors = {}
            for name in opened.keys():  # noqa: SIM118
                part = opened.get_slice(name)
                shape = tuple(part.get_shape())
                tensors[name] = StoredTensor(part.get_dtype(), shape, partial(_load, file, name))
            metadata = opened.metadata() or {}
        json.loads(header, object_pairs_hook=_without_doubles)
    except (library.SafetensorError, ValueError) as error:
        raise _unreadable(file, error) from error
    return Checkpoint(file, tensors, metadata)


def read_arrays(file: Path) -> tuple[dict[str, Array], dict[str, str]]:
    """Return a small file's arrays by name, read-only, and its metadata; imports no torch.

    Raises:
        ConfigError: as :func:`read_safetensors`, or an array of a type that numpy has not.
    """
    library = _library()
    stored = read_safetensors(file)
    try:
        with library.safe_open(file, framework="numpy") as opened:
            arrays = {name: opened.get_tensor(name) for name in stored.tensors}
    except (library.SafetensorError, TypeError) as error:
        raise _unreadable(file, error) from error
    for array in arrays.values():
        array.setflags(write=False)
    return arrays, dict(stored.metadata)


def write_safetensors(
    file: Path, tensors: Mapping[str, Tensor], metadata: Mapping[str, str]
) -> None:
    """Write tensors, the whole file or none; the same tensors give the same bytes.

    Raises:
        ConfigError: the format has no name for a tensor's type.
    """
    _library()
    from safetensors.torch import save_file

    owned = {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}
    _write(file, lambda target: save_file(owned, target, dict(metadata) or None))


def write_arrays(file: Path, arrays: Mapping[str, Array], metadata: Mapping[str, str]) -> None:
    """Write arrays as :func:`write_safetensors` writes tensors; imports no torch."""
    _library()
    from safetensors.numpy import save_file

    owned = {name: np.array(array, order="C") for name, array in arrays.items()}
    _write(file, lambda target: save_file(owned, target, dict(metadata) or None))


def _write(file: Path, save: Callable[[str], None]) -> None:
    with writing(file) as stream:
        try:
            save(stream.name)
        except (KeyError, ValueError) as error:
            raise ConfigError(f"{file}: cannot be saved as safetensors: {error}") from error
        _put_in_order(stream)
        # The library puts a file of its own in place, which only its user may read.
        os.chmod(stream.name, 0o644)


def _library() -> ModuleType:
    try:
        import safetensors
    except ImportError as error:
        raise ConfigError(
            "weights are read and written by safetensors: pip install safetensors"
        ) from error
    return safetensors


def _load(file: Path, name: str) -> Tensor:
    library = _library()
    try:
        with library.safe_open(file, framework="pt") as opened:
            # A copy: the library's own tensor is the file itself, as long as it lives.
            return opened.get_tensor(name).clone()
    except library.SafetensorError as error:
        raise _unreadable(file, error) from error


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
