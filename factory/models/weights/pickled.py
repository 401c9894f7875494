"""Checkpoints as torch saves them: a zip archive of numbers, and a pickle that makes tensors of it.

A pickle can call anything. torch reads it with ``weights_only``, which calls nothing but torch's
own constructors, in a child process that may be killed, since forty pairs, each of the one before
twice, take an age to hash. The child writes the tensors as safetensors, and those are read here.
Settings that a trainer stored beside its weights need no library: whatever they are made of, an
empty stand-in is made instead.
"""

from __future__ import annotations

import math
import resource
import tempfile
import time
import zipfile
from collections import Counter, OrderedDict
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from asset_factory.sim_checks.processes.isolation import Limits, run_isolated
from asset_factory.sim_checks.processes.scratch import scratch

from ...errors import ConfigError
from .safetensors import Checkpoint, Tensor, read_safetensors, write_safetensors

#: For all that the child does, importing torch and writing the tensors included [s].
_WALL_S = 300.0
#: Processor time after which reading the description hangs: an error, of which nothing is kept [s].
_READING_S = 20
#: Memory for the description, beyond what torch and the mapped file take [bytes].
_READING_BYTES = 2**30
_MAX_DESCRIPTION = 8_000_000
_MAX_NOTE = 4096
_LETTERS_SAID = 200
#: Layers may share their weights; more than this is no network's.
_MOST_SHARED = 4


class _Mapping:
    """Stands for a class that nobody here has: makes an empty mapping, which may be filled."""

    def __new__(cls, *_args: object) -> Any:
        return OrderedDict()


class _Items:
    """Stands for what holds a sequence: makes an empty list."""

    def __new__(cls, *_args: object) -> Any:
        return []


class _Value:
    """Stands for an object whose state is no mapping: takes everything, keeps nothing."""

    def __init__(self, *_args: object) -> None:
        pass

    def __setstate__(self, _state: object) -> None:
        pass


#: torch fills mappings, lists and states, and asks each whether it is one: which is which among the
#: types that trainers store. Everything else is taken for a mapping.
_STAND_INS = {"numpy.": _Value, "functools.partial": _Value, "collections.deque": _Items}


def read_pickled(file: Path) -> Checkpoint:
    """Return what a ``.pt`` or ``.ckpt`` file holds.

    The weights are the mapping under ``state_dict``, as trainers save them, or the file's own
    mapping.

    Raises:
        ConfigError: not such a file, damaged, a tensor beyond the end of its storage, or no torch.
    """
    state = file.stat()
    # A job asks several times, and importing torch in a child takes seconds.
    unpacked = _unpacked(file.resolve(), state.st_ino, state.st_size, state.st_mtime_ns)
    return replace(read_safetensors(unpacked), file=file)


@lru_cache(maxsize=4)
def _unpacked(file: Path, _inode: int, _size: int, _changed_ns: int) -> Path:
    target = Path(tempfile.mkdtemp(dir=scratch())) / "weights.safetensors"
    outcome = run_isolated(unpack, file, target, _READING_S, limits=Limits(wall_s=_WALL_S))
    if isinstance(outcome.error, ConfigError):
        raise outcome.error
    if outcome.failure is not None:
        within = f"within {_READING_S} s and {_READING_BYTES / 2**30:g} GiB"
        why = outcome.detail[:_LETTERS_SAID]
        raise ConfigError(f"{file}: its description cannot be read {within}: {why}")
    return target


def unpack(file: Path, target: Path, most_s: int) -> None:
    """Write an archive's tensors as safetensors; called in the child.

    ``file`` is its real path; its description may take ``most_s`` of processor time [s].

    Raises:
        ConfigError: as :func:`read_pickled`.
    """
    try:
        import torch
    except ImportError as error:
        advice = "pip install torch, or convert it to safetensors where there is one"
        raise ConfigError(f"{file}: what torch saved is read by torch: {advice}") from error
    size = file.stat().st_size
    try:
        stored = _stored_bytes(file)
        usual = _limit_reading(most_s, size)
        names = torch.serialization.get_unsafe_globals_in_checkpoint(file)
        with torch.serialization.safe_globals([_stand_in(name) for name in names]):
            top = torch.load(file, map_location="cpu", weights_only=True, mmap=True)
        resource.setrlimit(resource.RLIMIT_CPU, usual)
    except ConfigError:
        raise
    except (zipfile.BadZipFile, zipfile.LargeZipFile, EOFError) as error:
        why = "damaged, cut off, or not written by torch.save"
        raise ConfigError(f"{file}: {why}: {error}") from error
    except Exception as error:
        # Archives from anybody: torch and the decompressors have errors of many types.
        raise ConfigError(f"{file}: its description cannot be read: {_said(error)}") from error
    weights = top.get("state_dict", top) if isinstance(top, Mapping) else top
    if not isinstance(weights, Mapping):
        raise ConfigError(f"{file}: holds no mapping from names to tensors")
    named = ((n, t) for n, t in weights.items() if isinstance(n, str) and torch.is_tensor(t))
    tensors = {name: tensor for name, tensor in named if tensor.layout == torch.strided}
    if not tensors:
        raise ConfigError(f"{file}: holds no tensors")
    _require_stored(file, tensors, stored)
    write_safetensors(target, {name: own.clone() for name, own in tensors.items()}, {})


def _limit_reading(most_s: int, size: int) -> tuple[int, int]:
    """Limit reading beyond what torch has taken; returns the limit of processor time before."""
    with suppress(OSError):
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        # The file as it is mapped, and its tensors once more, to be written.
        most = pages * resource.getpagesize() + (1 + _MOST_SHARED) * size + _READING_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, resource.getrlimit(resource.RLIMIT_AS)[1]))
    usual = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(time.process_time()) + most_s, usual[1]))
    return usual


def _stand_in(name: str) -> tuple[type, str]:
    kinds = (kind for start, kind in _STAND_INS.items() if name.startswith(start))
    return next(kinds, _Mapping), name


def _stored_bytes(file: Path) -> Counter[int]:
    """Return how many storages there are of each size [bytes] that torch can map into memory."""
    with zipfile.ZipFile(file) as archive:
        records = archive.infolist()
        described = [record for record in records if record.filename.endswith("data.pkl")]
        if len(described) != 1:
            there = f"{len(described)} descriptions in it, want 1"
            raise ConfigError(f"{file}: a zip archive, but not one of torch.save: {there}")
        size = described[0].file_size
        if size > _MAX_DESCRIPTION:
            most = f"at most {_MAX_DESCRIPTION}"
            raise ConfigError(f"{file}: its description takes {size} bytes, {most}")
        prefix = described[0].filename.removesuffix("data.pkl")
        notes = [each for each in records if each.filename.removeprefix(prefix) == "byteorder"]
        # What is no short note is not unpacked.
        if any(n.file_size > _MAX_NOTE or archive.read(n).strip() != b"little" for n in notes):
            advice = "save it again on a little-endian one"
            raise ConfigError(f"{file}: saved on a big-endian machine; {advice}")
    plain = [record for record in records if record.compress_type == zipfile.ZIP_STORED]
    return Counter(r.file_size for r in plain if r.filename.startswith(f"{prefix}data/"))


def _require_stored(file: Path, tensors: Mapping[str, Tensor], stored: Counter[int]) -> None:
    """Refuse tensors that the file does not hold in full: torch believes the description."""
    described: dict[int, int] = {}
    for name, tensor in tensors.items():
        held = tensor.untyped_storage().nbytes()
        # Rows that share their numbers take no room in a file, and gigabytes once they are written.
        if tensor.nbytes > held:
            numbers = f"the {held // tensor.element_size()} numbers stored"
            raise ConfigError(f"{file}: {name}: shape {list(tensor.shape)} does not fit {numbers}")
        if held:
            described[tensor.untyped_storage().data_ptr()] = held
    missing = Counter(described.values()) - stored
    if missing:
        lost = f"a tensor's {min(missing)} bytes are missing, compressed or cut off"
        raise ConfigError(f"{file}: {lost}")
    total = sum(tensor.nbytes for tensor in tensors.values())
    held_bytes = sum(described.values())
    if total > _MOST_SHARED * held_bytes:
        raise ConfigError(f"{file}: its tensors take {total} bytes, but it holds {held_bytes}")


def _said(error: Exception) -> str:
    """Return the reason itself: torch wraps it in advice on how to run the file's code."""
    reason = error.__context__ or error
    first = (str(reason).strip().splitlines() or [""])[0]
    return f"{type(reason).__name__}: {first}"[:_LETTERS_SAID]
