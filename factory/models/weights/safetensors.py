"""The safetensors format through its own library, with limits before and order after.

The library parses headers of up to 100 MB and takes the last of two tensors of one name; it writes
metadata in another order each time.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, BinaryIO

from ...errors import ConfigError
from ...runtime.store import writing
from .stored import Checkpoint, StoredTensor, Tensor

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
            slices = {name: opened.get_slice(name) for name in opened.keys()}  # noqa: SIM118
            tensors = {
                name: StoredTensor(
                    part.get_dtype(), tuple(part.get_shape()), partial(_load, file, name)
                )
                for name, part in slices.items()
            }
            metadata = opened.metadata() or {}
        json.loads(header, object_pairs_hook=_without_doubles)
    except (library.SafetensorError, ValueError) as error:
        raise _unreadable(file, error) from error
    return Checkpoint(file, tensors, metadata)


def write_safetensors(
    file: Path, tensors: Mapping[str, Tensor], metadata: Mapping[str, str]
) -> None:
    """Write tensors, the whole file or none; the same tensors give the same bytes.

    Args:
        file: where; replaced if it is there.
        tensors: torch tensors by name.
        metadata: about the file.

    Raises:
        ConfigError: the format has no name for a tensor's type.
    """
    _library()
    from safetensors.torch import save_file

    owned = {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}
    with writing(file) as stream:
        try:
            save_file(owned, stream.name, dict(metadata) or None)
        except (KeyError, ValueError) as error:
            raise ConfigError(f"{file}: cannot be saved as safetensors: {error}") from error
        _put_in_order(stream)


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
            raise ConfigError(
                f"{file}: not safetensors, or cut off: says its header takes {length} "
                f"of {size} bytes"
            )
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
