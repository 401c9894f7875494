"""A disposable, content-addressed cache: results of expensive stages, by what went into them."""

from __future__ import annotations

import hashlib
import io
import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt


def digest_bytes(data: bytes) -> str:
    """SHA-256 of some bytes, as hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def digest_file(path: Path) -> str:
    """SHA-256 of a file's content, as hexadecimal. Raises OSError if it cannot be read."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def stage_key(stage: str, version: int, *inputs: object) -> str:
    """The name under which a stage's result is kept.

    Args:
        stage: e.g. ``decompose``.
        version: the stage's ``VERSION``: raised when the same settings would give another output.
        inputs: everything the result depends on: arrays, dataclasses, strings, numbers, library versions.
    """
    digest = hashlib.sha256(f"{stage}/{version}".encode())
    for item in inputs:
        digest.update(_fingerprint(item))
    return f"{stage}-{digest.hexdigest()}"


def _fingerprint(item: object) -> bytes:
    if isinstance(item, np.ndarray):
        header = f"array {item.dtype.str} {item.shape} ".encode()
        return header + np.ascontiguousarray(item).tobytes()
    if is_dataclass(item) and not isinstance(item, type):
        item = asdict(item)
    return f"json {json.dumps(item, sort_keys=True)} ".encode()


def write_whole(path: Path, data: bytes) -> None:
    """Write a file such that a reader sees all of it or what was there before. Its folder must exist."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".writing-")
    with os.fdopen(handle, "wb") as file:
        file.write(data)
    os.replace(temporary, path)


class Store:
    """Arrays by key, in one folder. Losing it costs time, never data.

    Args:
        root: created when first written to.
    """

    def __init__(self, root: Path) -> None:
        self.root = root

    def load(self, key: str) -> dict[str, npt.NDArray[Any]] | None:
        """The arrays kept under ``key``; ``None`` if there are none or the file is damaged."""
        try:
            with self._path(key).open("rb") as file, np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        except (OSError, ValueError, zipfile.BadZipFile, EOFError):
            return None

    def save(self, key: str, arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        """Keep ``arrays`` under ``key``. A reader sees all of it or nothing."""
        path = self._path(key)
        path.parent.mkdir(parents=True, exist_ok=True)
        buffer = io.BytesIO()
        np.savez(buffer, allow_pickle=False, **dict(arrays))
        write_whole(path, buffer.getvalue())

    def _path(self, key: str) -> Path:
        return self.root / key[-2:] / f"{key}.npz"
