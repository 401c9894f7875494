"""The safetensors format: a length, a JSON header, and the bytes of every tensor one after another.

The whole format is the next hundred lines, and reading it here lets an error name the tensor.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...errors import ConfigError
from ...runtime.store import writing
from .stored import ITEM_BYTES, Checkpoint, StoredTensor, Tensor, dense_strides, dtype_name

_LENGTH = struct.Struct("<Q")
_MAX_HEADER, _MAX_VALUES = 16_000_000, 1_000_000
_MAX_RANK = 32
_MAX_SIZE = 2**62
_ALIGNMENT = 8
_METADATA = "__metadata__"
_LETTERS_SAID = 200


def read_safetensors(file: Path) -> Checkpoint:
    """What a safetensors file holds; no tensor is read yet.

    Raises:
        ConfigError: no such format, or a tensor that the file does not hold to its end.
    """
    size = file.stat().st_size
    with file.open("rb") as stream:
        prefix = stream.read(_LENGTH.size)
        if len(prefix) < _LENGTH.size:
            raise ConfigError(f"{file}: {size} bytes are too few for a safetensors file")
        length = int(_LENGTH.unpack(prefix)[0])
        if length > min(_MAX_HEADER, size - _LENGTH.size):
            raise ConfigError(
                f"{file}: not safetensors, or cut off: says its header takes {length} of {size} bytes"
            )
        header = _parse(file, stream.read(length))
    metadata = header.pop(_METADATA, {})
    if not isinstance(metadata, dict) or not all(
        isinstance(value, str) for value in metadata.values()
    ):
        raise ConfigError(f"{file}: {_METADATA} is not an object of texts")
    data = _LENGTH.size + length
    entries = sorted(
        (_entry(file, name, value) for name, value in header.items()), key=lambda entry: entry[1]
    )
    tensors, end = {}, 0
    for tensor, begin, stop in entries:
        if begin != end:
            raise ConfigError(
                f"{file}: {tensor.name} starts at byte {begin} of the data, want {end}: overlap or gap"
            )
        if data + stop > size:
            held = max(0, size - data - begin)
            raise ConfigError(
                f"{file}: {tensor.name} is cut off: {held} of {stop - begin} bytes are there"
            )
        end = stop
        at = StoredTensor(
            file, tensor.name, tensor.dtype, tensor.shape, tensor.strides, data + begin
        )
        tensors[tensor.name] = at
    return Checkpoint(file, tensors, metadata)


def write_safetensors(
    file: Path, tensors: Mapping[str, Tensor], metadata: Mapping[str, str]
) -> None:
    """Write tensors so that a reader sees the whole file or none; the same tensors give the same bytes.

    Args:
        file: where; replaced if it is there.
        tensors: torch tensors by name.
        metadata: about the file.
    """
    header: dict[str, Any] = {_METADATA: dict(sorted(metadata.items()))} if metadata else {}
    # Wide items first, so that every tensor starts on a multiple of its own width.
    names = sorted(tensors, key=lambda name: (-ITEM_BYTES[dtype_name(tensors[name])], name))
    begin = 0
    for name in names:
        dtype, shape = dtype_name(tensors[name]), list(tensors[name].shape)
        end = begin + ITEM_BYTES[dtype] * math.prod(shape)
        header[name] = {"dtype": dtype, "shape": shape, "data_offsets": [begin, end]}
        begin = end
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % _ALIGNMENT)
    with writing(file) as stream:
        stream.write(_LENGTH.pack(len(text)) + text)
        for name in names:
            stream.write(_raw(tensors[name]))


def _raw(tensor: Tensor) -> memoryview:
    import torch

    flat = tensor.detach().cpu().contiguous().reshape(-1)
    return memoryview(flat.view(torch.uint8).numpy())


def _parse(file: Path, text: bytes) -> dict[str, Any]:
    values = sum(text.count(opening) for opening in (b"{", b"["))
    if values > _MAX_VALUES:
        raise ConfigError(
            f"{file}: not safetensors: {values} lists and objects in its header, at most {_MAX_VALUES}"
        )
    try:
        header = json.loads(text, object_pairs_hook=_without_doubles)
    except (ValueError, RecursionError) as error:
        raise ConfigError(f"{file}: not safetensors: its header is no JSON ({error})") from error
    if not isinstance(header, dict):
        raise ConfigError(f"{file}: not safetensors: its header is no JSON object")
    return header


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise ValueError(f"{key} appears twice")
        found[key] = value
    return found


def _entry(file: Path, name: str, value: Any) -> tuple[StoredTensor, int, int]:
    try:
        dtype, shape = value["dtype"], tuple(value["shape"])
        begin, end = value["data_offsets"]
    except (TypeError, KeyError, ValueError) as error:
        said = repr(value)[:_LETTERS_SAID]
        raise ConfigError(
            f"{file}: {name}: want dtype, shape and data_offsets, got {said}"
        ) from error
    sound = all(type(number) is int and 0 <= number <= _MAX_SIZE for number in (*shape, begin, end))
    if not sound or len(shape) > _MAX_RANK:
        said = repr(value)[:_LETTERS_SAID]
        raise ConfigError(
            f"{file}: {name}: want whole numbers of at least 0, at most {_MAX_RANK} sizes, got {said}"
        )
    if not isinstance(dtype, str) or dtype not in ITEM_BYTES:
        said = repr(dtype)[:_LETTERS_SAID]
        raise ConfigError(
            f"{file}: {name}: dtype {said} is not known; there are {', '.join(ITEM_BYTES)}"
        )
    want = ITEM_BYTES[dtype] * math.prod(shape)
    if end - begin != want:
        raise ConfigError(
            f"{file}: {name}: {end - begin} bytes for {dtype} of shape {list(shape)}, want {want}"
        )
    return StoredTensor(file, name, dtype, shape, dense_strides(shape), 0), begin, end
