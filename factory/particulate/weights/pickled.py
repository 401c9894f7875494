"""Checkpoints as torch saves them: a zip archive of numbers, and a pickle that makes tensors of it.

A pickle can call anything. torch reads it with ``weights_only``, which calls nothing but torch's
own constructors, in a child process that may be killed, since forty pairs, each of the one before
twice, take an age to hash. Settings that a trainer stored beside its weights need no library:
whatever they are made of, an empty stand-in is made instead. The child only says where each tensor
lies; the numbers stay in the file until they are asked for.
"""

from __future__ import annotations

import math
import resource
import time
import zipfile
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

from ...errors import ConfigError
from .stored import Checkpoint, Shape, StoredTensor, Tensor

_DTYPES = {
    "float64": "F64",
    "float32": "F32",
    "float16": "F16",
    "bfloat16": "BF16",
    "int64": "I64",
    "int32": "I32",
    "int16": "I16",
    "int8": "I8",
    "uint8": "U8",
    "bool": "BOOL",
}
_TORCH = {name: plain for plain, name in _DTYPES.items()}
#: The child starts, imports torch and reads; of that, reading alone [s], and what it may add to the
#: memory that torch and the mapped file take [bytes].
_WALL_S, _READING_S, _READING_BYTES = 120.0, 4, 2**30
_MAX_DESCRIPTION, _MAX_NOTE = 8_000_000, 4096
_LETTERS_SAID = 200
_LOCAL_HEADER, _NAME_LENGTH, _EXTRA_LENGTH = 30, slice(26, 28), slice(28, 30)


@dataclass(frozen=True)
class _View:
    """Where a tensor's numbers lie: first byte in the file, elements from one index to the next."""

    dtype: str
    shape: Shape
    strides: Shape
    start: int


class _Mapping:
    """Stands for a class that nobody here has: makes an empty mapping, which may be filled."""

    def __new__(cls, *_args: object) -> Any:
        return OrderedDict()


class _Items:
    """Stands for what holds a sequence: makes an empty list."""

    def __new__(cls, *_args: object) -> Any:
        return []


class _Value:
    """Stands for what has a state that is no mapping: takes everything, keeps nothing."""

    def __init__(self, *_args: object) -> None:
        pass

    def __setstate__(self, _state: object) -> None:
        pass


def read_pickled(file: Path) -> Checkpoint:
    """What a ``.pt`` or ``.ckpt`` file holds; no tensor is read yet.

    The weights are the mapping under ``state_dict``, as trainers save them, or the file's own
    mapping.

    Raises:
        ConfigError: not such a file, damaged, a tensor beyond the end of its storage, or no torch.
    """
    state = file.stat()
    # A job asks several times, and importing torch in a child takes seconds.
    views = _read_views(file.resolve(), state.st_ino, state.st_size, state.st_mtime_ns)
    return Checkpoint(
        file,
        {
            name: StoredTensor(view.dtype, view.shape, partial(_load, file, name, view))
            for name, view in views.items()
        },
    )


@lru_cache(maxsize=8)
def _read_views(file: Path, _inode: int, _size: int, _changed_ns: int) -> Mapping[str, _View]:
    outcome = run_isolated(find_tensors, file, _READING_S, limits=Limits(wall_s=_WALL_S))
    if isinstance(outcome.error, ConfigError):
        raise outcome.error
    if outcome.value is None:
        raise ConfigError(
            f"{file}: its description cannot be read within {_READING_S} s and "
            f"{_READING_BYTES / 2**30:g} GiB: {outcome.detail[:_LETTERS_SAID]}"
        )
    return outcome.value


def find_tensors(file: Path, most_s: int) -> dict[str, _View]:
    """In the child: where each tensor of an archive lies.

    Args:
        file: the archive, by its real path.
        most_s: processor time that reading may take [s].

    Raises:
        ConfigError: as :func:`read_pickled`.
    """
    try:
        import torch
    except ImportError as error:
        raise ConfigError(
            f"{file}: what torch saved is read by torch: pip install torch, or convert it to "
            "safetensors where there is one"
        ) from error
    _limit_reading(most_s, file.stat().st_size)
    try:
        storages = _storages(file)
        names = torch.serialization.get_unsafe_globals_in_checkpoint(file)
        with torch.serialization.safe_globals([_stand_in(name) for name in names]):
            top = torch.load(file, map_location="cpu", weights_only=True, mmap=True)
    except ConfigError:
        raise
    except (zipfile.BadZipFile, zipfile.LargeZipFile, EOFError) as error:
        raise ConfigError(
            f"{file}: damaged, cut off, or not written by torch.save: {error}"
        ) from error
    except Exception as error:
        # Archives from anybody: torch and the decompressors have errors of many types.
        raise ConfigError(f"{file}: its description cannot be read: {_said(error)}") from error
    weights = top.get("state_dict", top) if isinstance(top, Mapping) else top
    if not isinstance(weights, Mapping):
        raise ConfigError(f"{file}: holds no mapping from names to tensors")
    tensors = {
        name: tensor
        for name, tensor in weights.items()
        if isinstance(name, str)
        and isinstance(tensor, torch.Tensor)
        and tensor.layout == torch.strided
    }
    if not tensors:
        raise ConfigError(f"{file}: holds no tensors")
    mapped = _mapped_at(file)
    return {name: _located(file, name, value, mapped, storages) for name, value in tensors.items()}


def _limit_reading(most_s: int, size: int) -> None:
    """What reading may use beyond what torch has taken, until the child's next question."""
    with suppress(OSError):
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        most = pages * resource.getpagesize() + size + _READING_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, resource.getrlimit(resource.RLIMIT_AS)[1]))
    until = math.ceil(time.process_time()) + most_s
    resource.setrlimit(resource.RLIMIT_CPU, (until, resource.getrlimit(resource.RLIMIT_CPU)[1]))


#: torch fills mappings, lists and states, and asks each whether it is one: which is which among the
#: types that trainers store. Everything else is taken for a mapping.
_STAND_INS = {"numpy.": _Value, "functools.partial": _Value, "collections.deque": _Items}


def _stand_in(name: str) -> tuple[type, str]:
    kinds = (kind for start, kind in _STAND_INS.items() if name.startswith(start))
    return next(kinds, _Mapping), name


def _storages(file: Path) -> dict[int, int]:
    """First byte of each storage in the file -> its size [bytes]; none that is compressed.

    What torch would unpack is small, so that it need not be told to.
    """
    with zipfile.ZipFile(file) as archive:
        records = archive.infolist()
        described = [record for record in records if record.filename.endswith("data.pkl")]
        if len(described) != 1:
            raise ConfigError(
                f"{file}: a zip archive, but not one of torch.save: "
                f"{len(described)} descriptions in it, want 1"
            )
        if described[0].file_size > _MAX_DESCRIPTION:
            raise ConfigError(
                f"{file}: its description takes {described[0].file_size} bytes, "
                f"at most {_MAX_DESCRIPTION}"
            )
        prefix = described[0].filename.removesuffix("data.pkl")
        for record in records:
            if record.filename.removeprefix(prefix) == "byteorder":
                _refuse_big_endian(file, archive, record)
    return dict(_data_starts(file, [r for r in records if r.filename.startswith(f"{prefix}data/")]))


def _refuse_big_endian(file: Path, archive: zipfile.ZipFile, record: zipfile.ZipInfo) -> None:
    if record.file_size > _MAX_NOTE or archive.read(record).strip() != b"little":
        raise ConfigError(
            f"{file}: saved on a big-endian machine; save it again on a little-endian one"
        )


def _data_starts(file: Path, records: list[zipfile.ZipInfo]) -> Iterator[tuple[int, int]]:
    with file.open("rb") as stream:
        for record in records:
            if record.compress_type != zipfile.ZIP_STORED:
                continue
            stream.seek(record.header_offset)
            header = stream.read(_LOCAL_HEADER)
            lengths = (
                int.from_bytes(header[part], "little") for part in (_NAME_LENGTH, _EXTRA_LENGTH)
            )
            yield record.header_offset + _LOCAL_HEADER + sum(lengths), record.file_size


def _mapped_at(file: Path) -> int:
    """The address where torch has mapped the file into memory."""
    path = str(file).replace("\n", "\\012")
    for line in Path("/proc/self/maps").read_text().splitlines():
        addresses, _, offset, _, _, *mapped = line.split(maxsplit=5)
        if mapped == [path] and int(offset, 16) == 0:
            return int(addresses.partition("-")[0], 16)
    raise ConfigError(f"{file}: not mapped into memory; convert it to safetensors elsewhere")


def _located(
    file: Path, name: str, tensor: Tensor, mapped: int, storages: Mapping[int, int]
) -> _View:
    plain = str(tensor.dtype).removeprefix("torch.")
    if plain not in _DTYPES:
        raise ConfigError(f"{file}: {name}: dtype {plain} is not known; want {', '.join(_DTYPES)}")
    width = tensor.element_size()
    shape, strides = tuple(tensor.shape), tuple(tensor.stride())
    start = tensor.untyped_storage().data_ptr() - mapped
    if tensor.numel() and start not in storages:
        raise ConfigError(f"{file}: {name}: its numbers are missing, compressed or moved")
    held = storages.get(start, 0) // width
    offset = tensor.storage_offset()
    # Rows that share their numbers take no room in a file, and gigabytes once they are loaded.
    if tensor.numel() and offset + max(_span(shape, strides), tensor.numel()) > held:
        raise ConfigError(
            f"{file}: {name}: shape {list(shape)} does not fit the {held} numbers stored"
        )
    return _View(_DTYPES[plain], shape, strides, start + offset * width)


def _span(shape: Shape, strides: Shape) -> int:
    """Elements from the first to the last, both included; no size is 0."""
    return 1 + sum((size - 1) * stride for size, stride in zip(shape, strides, strict=True))


def _load(file: Path, name: str, view: _View) -> Tensor:
    import torch

    dtype = getattr(torch, _TORCH[view.dtype])
    if 0 in view.shape:
        return torch.empty(view.shape, dtype=dtype)
    wanted = _span(view.shape, view.strides) * dtype.itemsize
    with file.open("rb") as stream:
        stream.seek(view.start)
        data = np.fromfile(stream, dtype=np.uint8, count=wanted)
    if data.size != wanted:
        raise ConfigError(f"{file}: {name} is cut off: {data.size} of {wanted} bytes are there")
    return torch.from_numpy(data).view(dtype).as_strided(view.shape, view.strides).contiguous()


def _said(error: Exception) -> str:
    """The reason itself: torch wraps it in advice on how to run what is in the file."""
    reason = error.__context__ or error
    first = (str(reason).strip().splitlines() or [""])[0]
    return f"{type(reason).__name__}: {first}"[:_LETTERS_SAID]
