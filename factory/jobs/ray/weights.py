"""How checkpoints reach nodes: each once, told by its digest, and kept there."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from filelock import FileLock

from ...errors import ConfigError
from ...models.weights.sources import SHIPPED, fetch
from ...runtime.store import digest_file, writing
from .exchange import ExchangeError

#: How long a checkpoint may take from node to node [s].
FETCH_S = 600.0

SentWeights = list[tuple[str, str, str, list[Any]]]
"""What configurations call a checkpoint, its file's name, its SHA-256, and Ray's reference to it.

Plain, since nodes may have another package; the reference is in a list, or Ray would fetch what
a node has already.
"""


def sent_weights(ray: Any, names: Iterable[str]) -> SentWeights:
    """Put checkpoints where nodes fetch them, but the package's own and those not here."""
    found: SentWeights = []
    for name in names:
        if name in ("", SHIPPED):
            continue
        try:
            file = fetch(name)
        except ConfigError:
            # Whoever asks for it says so.
            continue
        content = np.fromfile(file, np.uint8)
        digest = hashlib.sha256(content.data).hexdigest()
        found.append((name, file.name, digest, [ray.put(content)]))
    return found


def arrived(ray: Any, sent: SentWeights) -> dict[str, Path]:
    """Return where checkpoints lie on this node, by their configured names; fetch if need be.

    Raises:
        ExchangeError: other bytes were sent.
        OSError: there is no room for it, or somebody else's folder is in its place.
        RayError: it could not be fetched.
    """
    return {name: _kept(ray, file, digest, held[0]) for name, file, digest, held in sent}


def _kept(ray: Any, name: str, digest: str, reference: Any) -> Path:
    folder = _own_folder() / digest
    folder.mkdir(exist_ok=True)
    # Checkpoints are told apart by digests; their files' names are named in manifests.
    path = folder / Path(name).name
    with FileLock(folder / ".lock"):
        if path.is_file() and _digest(path, path.stat().st_mtime_ns) == digest:
            return path
        content = ray.get(reference, timeout=FETCH_S)
        if hashlib.sha256(memoryview(content)).hexdigest() != digest:
            raise ExchangeError(f"{path.name}: not what was sent, its digest is another")
        with writing(path) as file:
            file.write(memoryview(content))
    return path


def _own_folder() -> Path:
    """Return this user's own folder; not among scratch folders, for it outlives processes."""
    folder = Path(tempfile.gettempdir()) / f"weights-of-asset-factory-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if folder.is_symlink() or folder.stat().st_uid != os.getuid():
        raise PermissionError(f"{folder}: belongs to somebody else")
    return folder


@lru_cache(maxsize=8)
def _digest(path: Path, changed: int) -> str:
    """Return a file's digest, taken once per process, unless the file changes."""
    return digest_file(path)
