"""What dead processes left, and what the cache need not keep."""

from __future__ import annotations

import os
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
    staging = _remove_staging(root / STAGING)
    unfinished = _remove_unfinished(root)
    store = Store(root / CACHE)
    trimmed = store.trim(older_than_s=older_than_s, keep_bytes=keep_bytes)
    return Freed(staging, unfinished, trimmed, store.size())


def _remove_staging(staging: Path) -> Trimmed:
    freed = Trimmed()
    for folder in sorted(staging.iterdir()) if staging.is_dir() else ():
        descriptor = abandoned(folder)
        if descriptor is None:
            continue
        try:
            freed = Trimmed(freed.files + 1, freed.bytes + _size(folder))
            remove(folder)
        finally:
            os.close(descriptor)
    return freed


def _remove_unfinished(root: Path) -> Trimmed:
    """Return the files that are still to get their name; whoever writes one has it locked."""
    freed = Trimmed()
    pattern = f"{WRITING_PREFIX}*"
    places = (
        root.glob(pattern),
        (root / NOTES).glob(pattern),
        (root / CACHE).rglob(pattern),
        (root / INPUTS).rglob(pattern),
    )
    for path in chain.from_iterable(places):
        descriptor = abandoned(path)
        if descriptor is not None:
            freed = Trimmed(freed.files + 1, freed.bytes + os.fstat(descriptor).st_size)
            remove(path)
            os.close(descriptor)
    return freed


def _size(folder: Path) -> int:
    total = 0
    for parent, _, names in os.walk(folder):
        for name in names:
            with suppress(OSError):
                total += os.lstat(os.path.join(parent, name)).st_size
    return total
