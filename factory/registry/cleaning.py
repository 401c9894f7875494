"""What dead processes left, and what the cache need not keep."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from asset_factory.sim_checks.processes.scratch import abandoned, sweep

from ..runtime.layout import CACHE, CLAIMS, INPUTS, NOTES, STAGING
from ..runtime.store import WRITING_PREFIX, Store, Trimmed
from .claims import drop_abandoned
from .placing import remove


@dataclass(frozen=True)
class Freed:
    """The files removed.

    Attributes:
        staging: folders of processes that are dead; ``files`` counts them.
        unfinished: files that nobody finished writing.
        cache: results that can be computed again.
        kept: of these, those that stay.
    """

    staging: Trimmed
    unfinished: Trimmed
    cache: Trimmed
    kept: Trimmed = Trimmed()  # noqa: RUF009 - frozen

    @property
    def bytes(self) -> int:
        """Return the size of all that was removed [bytes]."""
        return self.staging.bytes + self.unfinished.bytes + self.cache.bytes


def collect_garbage(
    root: Path, *, older_than_s: float | None = None, keep_bytes: int | None = None
) -> Freed:
    """Remove what nobody needs: never anything published, nor what a living process holds.

    Args:
        root: the registry's folder.
        older_than_s: what of the cache nobody used for so long goes [s]; ``None``: it does not go
            for its age.
        keep_bytes: how much of the cache may stay [bytes]; ``None``: any amount.
    """
    sweep()
    drop_abandoned(root / CLAIMS)
    made = root / STAGING
    staging = _remove_abandoned(sorted(made.iterdir()) if made.is_dir() else ())
    pattern = f"{WRITING_PREFIX}*"
    flat = (folder.glob(pattern) for folder in (root, root / NOTES))
    deep = (folder.rglob(pattern) for folder in (root / CACHE, root / INPUTS))
    unfinished = _remove_abandoned(chain(*flat, *deep))
    store = Store(root / CACHE)
    trimmed = store.trim(older_than_s=older_than_s, keep_bytes=keep_bytes)
    return Freed(staging, unfinished, trimmed, store.size())


def _remove_abandoned(paths: Iterable[Path]) -> Trimmed:
    """Remove files and folders, but those that a process has locked, as it works on them."""
    freed = Trimmed()
    for path in paths:
        descriptor = abandoned(path)
        if descriptor is None:
            continue
        try:
            freed = Trimmed(freed.files + 1, freed.bytes + _size(path))
            remove(path)
        finally:
            os.close(descriptor)
    return freed


def _size(path: Path) -> int:
    """Return the size of a file, or of all that a folder holds [bytes]."""
    inside = (os.path.join(parent, name) for parent, _, names in os.walk(path) for name in names)
    total = 0
    for file in inside if path.is_dir() else (path,):
        with suppress(OSError):
            total += os.lstat(file).st_size
    return total
