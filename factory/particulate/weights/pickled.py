"""Checkpoints as torch saves them: a zip archive with a pickle that describes the tensors.

A pickle can call anything. This reader knows four names, gives every other one an inert stand-in,
and never imports what a file asks for; so settings that a trainer stored beside its weights need no
library either.

A pickle can also share: forty pairs, each of the one before twice, take an age to hash or to print.
So nothing of what a file describes is printed, and keys are plain. And it can change the state of
what it names:
    here nobody has any.
"""

from __future__ import annotations

import pickle
import zipfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

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
_MAX_PICKLE = 8_000_000
_PLAIN = (str, bytes, int, float, bool, type(None))
_WORD = 16
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
    numbers = (
        (offset, *shape, *strides)
        if isinstance(shape, tuple) and isinstance(strides, tuple)
        else (-1,)
    )
    sound = all(type(number) is int and number >= 0 for number in numbers)
    if not isinstance(storage, _Storage) or not sound or len(shape) != len(strides):
        raise pickle.UnpicklingError("a tensor is not described as torch does")
    return _TensorView(storage, offset, shape, strides)


def _rebuild_parameter(data: Any, *_rest: object) -> Any:
    return data


def _ordered(items: Iterable[Any] = (), *_rest: object) -> dict[Any, Any]:
    return {_plain_key(key): value for key, value in items}


def _plain_key(key: Any) -> Any:
    """``key``, if it can be hashed at once: a plain value, or a short tuple of them."""
    flat = key if type(key) is tuple and len(key) <= _WORD else (key,)
    if not all(type(item) in _PLAIN for item in flat):
        raise pickle.UnpicklingError(f"a {type(key).__name__} is the key of a mapping or in a set")
    return key


_KNOWN: dict[tuple[str, str], Any] = {
    ("collections", "OrderedDict"): _ordered,
    ("torch._utils", "_rebuild_tensor_v2"): _rebuild_tensor,
    ("torch._utils", "_rebuild_parameter"): _rebuild_parameter,
    **{("torch", name): _StorageKind(dtype) for name, dtype in _STORAGES.items()},
}


# The interpreter in Python, not the one in C: only its steps can be replaced.
_Interpreter: Any = vars(pickle)["_Unpickler"]


class _Reader(_Interpreter):  # type: ignore[misc]
    dispatch: ClassVar[dict[int, Callable[[Any], None]]] = dict(_Interpreter.dispatch)

    def find_class(self, module: str, name: str) -> Any:
        return _KNOWN.get((module, name), _Inert)

    def persistent_load(self, pid: Any) -> Any:
        try:
            tag, kind, key, _device, count = pid
        except (TypeError, ValueError) as error:
            raise pickle.UnpicklingError("a storage is not described as torch does") from error
        if (
            tag != "storage"
            or not isinstance(kind, _StorageKind)
            or type(count) is not int
            or type(key) is not str
        ):
            raise pickle.UnpicklingError("a storage of unknown kind")
        return _Storage(key, kind.dtype, count)

    def make(self, call: Any, args: Any) -> Any:
        """What a call makes; only this module's own stand-ins are called."""
        if (
            not (isinstance(call, _Inert) or call is _Inert or call in _CALLABLE)
            or type(args) is not tuple
        ):
            raise pickle.UnpicklingError(f"a {type(call).__name__} is called")
        return call(*args)

    def reduce(self) -> None:
        """REDUCE, NEWOBJ: a call with a tuple of arguments."""
        args = self.stack.pop()
        self.stack[-1] = self.make(self.stack[-1], args)

    def reduce_named(self) -> None:
        """NEWOBJ_EX: the same with named arguments, which a stand-in does not look at."""
        self.stack.pop()
        self.reduce()

    def object(self) -> None:
        """OBJ: a class and its arguments since the mark."""
        call, *args = self.pop_mark()
        self.append(self.make(call, tuple(args)))

    def instance(self) -> None:
        """INST: a name, and arguments since the mark."""
        module, name = (self.readline()[:-1].decode("ascii") for _ in range(2))
        args = tuple(self.pop_mark())
        self.append(self.make(self.find_class(module, name), args))

    def build(self) -> None:
        """BUILD: nobody here has a state."""
        self.stack.pop()

    def set_item(self) -> None:
        """SETITEM."""
        value, key = self.stack.pop(), self.stack.pop()
        self.stack[-1][_plain_key(key)] = value

    def set_items(self) -> None:
        """SETITEMS."""
        items = self.pop_mark()
        for key, value in zip(items[::2], items[1::2], strict=True):
            self.stack[-1][_plain_key(key)] = value

    def dictionary(self) -> None:
        """DICT."""
        items = self.pop_mark()
        self.append(_ordered(zip(items[::2], items[1::2], strict=True)))

    def add_items(self) -> None:
        """ADDITEMS: nobody here asks for a set's items."""
        self.pop_mark()

    def frozen(self) -> None:
        """FROZENSET."""
        self.pop_mark()
        self.append(_Inert())


_CALLABLE: tuple[Any, ...] = (_ordered, _rebuild_tensor, _rebuild_parameter)
_STEPS: dict[bytes, Callable[[Any], None]] = {
    pickle.REDUCE: _Reader.reduce,
    pickle.NEWOBJ: _Reader.reduce,
    pickle.NEWOBJ_EX: _Reader.reduce_named,
    pickle.OBJ: _Reader.object,
    pickle.INST: _Reader.instance,
    pickle.BUILD: _Reader.build,
    pickle.SETITEM: _Reader.set_item,
    pickle.SETITEMS: _Reader.set_items,
    pickle.DICT: _Reader.dictionary,
    pickle.ADDITEMS: _Reader.add_items,
    pickle.FROZENSET: _Reader.frozen,
}
_Reader.dispatch.update({step[0]: taken for step, taken in _STEPS.items()})


def read_pickled(file: Path) -> Checkpoint:
    """What a ``.pt`` or ``.ckpt`` file holds; no tensor is read yet.

    The weights are the mapping under ``state_dict``, as trainers save them, or the file's own
    mapping.

    Raises:
        ConfigError: not such a file, damaged, or a tensor beyond the end of its storage.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            records = {info.filename: info for info in archive.infolist()}
            top = _read_description(file, archive, records)
            prefix = next(name for name in records if name.endswith("data.pkl")).removesuffix(
                "data.pkl"
            )
            _refuse_big_endian(file, archive, records, prefix)
    except ConfigError:
        raise
    except Exception as error:
        # Archives from anybody: every decompressor has errors of its own.
        raise ConfigError(
            f"{file}: damaged, cut off, or not written by torch.save: {error}"
        ) from error
    weights = top.get("state_dict", top) if isinstance(top, Mapping) else top
    if not isinstance(weights, Mapping):
        raise ConfigError(f"{file}: holds no mapping from names to tensors")
    views = {
        name: view
        for name, view in weights.items()
        if isinstance(name, str) and isinstance(view, _TensorView)
    }
    if not views:
        raise ConfigError(f"{file}: holds no tensors")
    return Checkpoint(
        file, {name: _locate(file, name, view, records, prefix) for name, view in views.items()}
    )


def _read_description(
    file: Path, archive: zipfile.ZipFile, records: Mapping[str, zipfile.ZipInfo]
) -> Any:
    names = [name for name in records if name.endswith("data.pkl")]
    if len(names) != 1:
        raise ConfigError(
            f"{file}: a zip archive, but not one of torch.save: {len(names)} descriptions in it, want 1"
        )
    if records[names[0]].file_size > _MAX_PICKLE:
        raise ConfigError(
            f"{file}: its description takes {records[names[0]].file_size} bytes, at most {_MAX_PICKLE}"
        )
    with archive.open(names[0]) as stream:
        try:
            return _Reader(stream).load()
        except (zipfile.BadZipFile, OSError, MemoryError):
            raise
        except Exception as error:
            # A hostile pickle can raise whatever its opcodes reach.
            raise ConfigError(f"{file}: its description cannot be read: {error}") from error


def _refuse_big_endian(
    file: Path, archive: zipfile.ZipFile, records: Mapping[str, zipfile.ZipInfo], prefix: str
) -> None:
    record = records.get(f"{prefix}byteorder")
    if record is not None and (
        record.file_size > _WORD or archive.read(record).strip() != b"little"
    ):
        raise ConfigError(
            f"{file}: saved on a big-endian machine; save it again on a little-endian one"
        )


def _locate(
    file: Path, name: str, view: _TensorView, records: Mapping[str, zipfile.ZipInfo], prefix: str
) -> StoredTensor:
    record = records.get(f"{prefix}data/{view.storage.key}")
    if record is None or record.compress_type != zipfile.ZIP_STORED:
        raise ConfigError(
            f"{file}: {name}: its numbers are {'missing' if record is None else 'compressed'}"
        )
    width = ITEM_BYTES[view.storage.dtype]
    start = _data_start(file, record) + view.offset * width
    tensor = StoredTensor(file, name, view.storage.dtype, view.shape, view.strides, start)
    # What the archive says of itself, and what there is.
    held = min(record.file_size, max(0, file.stat().st_size - start + view.offset * width)) // width
    elements = 1
    for size in view.shape:
        elements *= size
    if view.offset + max(tensor.span, elements) > held:
        raise ConfigError(
            f"{file}: {name}: shape {list(view.shape)} does not fit the {held} numbers stored"
        )
    return tensor


def _data_start(file: Path, record: zipfile.ZipInfo) -> int:
    with file.open("rb") as stream:
        stream.seek(record.header_offset)
        header = stream.read(_LOCAL_HEADER)
    lengths = (int.from_bytes(header[part], "little") for part in (_NAME_LENGTH, _EXTRA_LENGTH))
    return record.header_offset + _LOCAL_HEADER + sum(lengths)
