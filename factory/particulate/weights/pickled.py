"""Checkpoints as torch saves them: a zip archive with a pickle that describes the tensors.

A pickle can call anything. This reader knows four names, gives every other one an inert stand-in, and never
imports what a file asks for; so settings that a trainer stored beside its weights need no library either.
"""

from __future__ import annotations

import pickle
import zipfile
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...errors import ConfigError
from .stored import ITEM_BYTES, Checkpoint, Shape, StoredTensor

_STORAGES = {
    "DoubleStorage": "F64",
    "FloatStorage": "F32",
    "HalfStorage": "F16",
    "BFloat16Storage": "BF16",
    "LongStorage": "I64",
    "IntStorage": "I32",
    "ShortStorage": "I16",
    "CharStorage": "I8",
    "ByteStorage": "U8",
    "BoolStorage": "BOOL",
}
_MAX_PICKLE = 100_000_000
_LOCAL_HEADER, _NAME_LENGTH, _EXTRA_LENGTH = 30, slice(26, 28), slice(28, 30)


@dataclass(frozen=True)
class _StorageKind:
    dtype: str


@dataclass(frozen=True)
class _Storage:
    key: str
    dtype: str
    count: int


@dataclass(frozen=True)
class _TensorView:
    storage: _Storage
    offset: int
    shape: Shape
    strides: Shape


class _Inert:
    """Stands for whatever a file asks for: takes everything, does nothing."""

    def __new__(cls, *_args: object, **_settings: object) -> _Inert:
        return super().__new__(cls)

    def __init__(self, *_args: object, **_settings: object) -> None:
        pass

    def __call__(self, *_args: object, **_settings: object) -> _Inert:
        return _Inert()

    def __setstate__(self, _state: object) -> None:
        pass

    def __setitem__(self, _key: object, _value: object) -> None:
        pass

    def append(self, _item: object) -> None:
        """Takes a list's item."""

    def extend(self, _items: object) -> None:
        """Takes a list's items."""

    def add(self, _item: object) -> None:
        """Takes a set's item."""


def _rebuild_tensor(storage: Any, offset: Any, shape: Any, strides: Any, *_rest: object) -> Any:
    numbers = (offset, *shape, *strides) if isinstance(shape, tuple) and isinstance(strides, tuple) else (-1,)
    sound = all(type(number) is int and number >= 0 for number in numbers)
    if not isinstance(storage, _Storage) or not sound or len(shape) != len(strides):
        raise pickle.UnpicklingError("a tensor is not described as torch does")
    return _TensorView(storage, offset, shape, strides)


def _rebuild_parameter(data: Any, *_rest: object) -> Any:
    return data


_KNOWN: dict[tuple[str, str], Any] = {
    ("collections", "OrderedDict"): OrderedDict,
    ("torch._utils", "_rebuild_tensor_v2"): _rebuild_tensor,
    ("torch._utils", "_rebuild_parameter"): _rebuild_parameter,
    **{("torch", name): _StorageKind(dtype) for name, dtype in _STORAGES.items()},
}


class _Reader(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        return _KNOWN.get((module, name), _Inert)

    def persistent_load(self, pid: Any) -> Any:
        try:
            tag, kind, key, _device, count = pid
        except (TypeError, ValueError) as error:
            raise pickle.UnpicklingError("a storage is not described as torch does") from error
        if tag != "storage" or not isinstance(kind, _StorageKind) or type(count) is not int:
            raise pickle.UnpicklingError(f"a storage of unknown kind: {kind!r}")
        return _Storage(str(key), kind.dtype, count)


def read_pickled(file: Path) -> Checkpoint:
    """What a ``.pt`` or ``.ckpt`` file holds; no tensor is read yet.

    The weights are the mapping under ``state_dict``, as trainers save them, or the file's own mapping.

    Raises:
        ConfigError: not such a file, damaged, or a tensor beyond the end of its storage.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            records = {info.filename: info for info in archive.infolist()}
            top = _read_description(file, archive, records)
            prefix = next(name for name in records if name.endswith("data.pkl")).removesuffix("data.pkl")
            _refuse_big_endian(file, archive, records, prefix)
    except (zipfile.BadZipFile, NotImplementedError, EOFError, OSError) as error:
        raise ConfigError(f"{file}: damaged, cut off, or not written by torch.save: {error}") from error
    weights = top.get("state_dict", top) if isinstance(top, Mapping) else top
    if not isinstance(weights, Mapping):
        raise ConfigError(f"{file}: holds no mapping from names to tensors")
    views = {name: view for name, view in weights.items() if isinstance(name, str) and isinstance(view, _TensorView)}
    if not views:
        raise ConfigError(f"{file}: holds no tensors")
    return Checkpoint(file, {name: _locate(file, name, view, records, prefix) for name, view in views.items()})


def _read_description(file: Path, archive: zipfile.ZipFile, records: Mapping[str, zipfile.ZipInfo]) -> Any:
    names = [name for name in records if name.endswith("data.pkl")]
    if len(names) != 1:
        raise ConfigError(f"{file}: a zip archive, but not one of torch.save: {len(names)} descriptions in it, want 1")
    if records[names[0]].file_size > _MAX_PICKLE:
        raise ConfigError(f"{file}: its description takes {records[names[0]].file_size} bytes, at most {_MAX_PICKLE}")
    with archive.open(names[0]) as stream:
        try:
            return _Reader(stream).load()
        except (zipfile.BadZipFile, OSError):
            raise
        except Exception as error:
            # A hostile pickle can raise whatever its opcodes reach.
            raise ConfigError(f"{file}: its description cannot be read: {error}") from error


def _refuse_big_endian(
    file: Path, archive: zipfile.ZipFile, records: Mapping[str, zipfile.ZipInfo], prefix: str
) -> None:
    if f"{prefix}byteorder" in records and archive.read(f"{prefix}byteorder").strip() != b"little":
        raise ConfigError(f"{file}: saved on a big-endian machine; save it again on a little-endian one")


def _locate(
    file: Path, name: str, view: _TensorView, records: Mapping[str, zipfile.ZipInfo], prefix: str
) -> StoredTensor:
    record = records.get(f"{prefix}data/{view.storage.key}")
    if record is None or record.compress_type != zipfile.ZIP_STORED:
        raise ConfigError(f"{file}: {name}: its numbers are {'missing' if record is None else 'compressed'}")
    width = ITEM_BYTES[view.storage.dtype]
    start = _data_start(file, record) + view.offset * width
    tensor = StoredTensor(file, name, view.storage.dtype, view.shape, view.strides, start)
    held = record.file_size // width
    elements = 1
    for size in view.shape:
        elements *= size
    if view.offset + max(tensor.span, elements) > held:
        raise ConfigError(f"{file}: {name}: shape {list(view.shape)} does not fit the {held} numbers stored")
    return tensor


def _data_start(file: Path, record: zipfile.ZipInfo) -> int:
    with file.open("rb") as stream:
        stream.seek(record.header_offset)
        header = stream.read(_LOCAL_HEADER)
    lengths = (int.from_bytes(header[part], "little") for part in (_NAME_LENGTH, _EXTRA_LENGTH))
    return record.header_offset + _LOCAL_HEADER + sum(lengths)
