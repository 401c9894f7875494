"""A registry's assets at a URL: whole files first, the index last, and only missing ones."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

from ..errors import AssetFactoryError, ConfigError, RegistryError
from ..runtime.layout import ASSETS, NOTES, REJECTED
from ..runtime.remote import located, shown, stored_md5, told
from .export.contents import SUMS_NAME, TOP_NAMES

#: Files sent at once: most of the time is waiting.
AT_ONCE = 8
#: How often a file is sent that did not arrive as it was.
_TRIES = 3
#: Is there while files are on their way: whoever reads meanwhile may find old beside new ones.
UNFINISHED = ".unfinished"
_BEFORE_INDEX = (ASSETS, REJECTED, NOTES)


@dataclass
class Synced:
    """What a synchronisation came to.

    Attributes:
        files: at the URL now.
        sent: of those, sent this time.
        removed: that were there and are none of the registry's any more.
        bytes: sent [bytes].
    """

    files: int = 0
    sent: int = 0
    removed: int = 0
    bytes: int = 0


def sync(files: Iterable[tuple[str, bytes]], url: str) -> Synced:
    """Make a URL hold these files and no others of a registry's; files already there stay.

    Each file's digest at the URL is compared with the one here: by the MD5 that the store keeps
    where it says one, else by reading it again. The index follows once all others are there whole;
    what it does not name any more goes after that. A synchronisation that was cut off, at whatever
    moment, leaves the old index or the new one; the next goes on with missing files.

    Raises:
        RegistryError: it cannot be read or written, or holds something else; names no secret.
        ConfigError: what fsspec needs is not installed.
    """
    try:
        system, path = located(url)
        root = path.rstrip("/")
        system.makedirs(root, exist_ok=True)
        there = _listed(system, root)
        if there and not there.keys() & {SUMS_NAME, UNFINISHED}:
            raise ConfigError(f"{shown(url)}: holds other files; name a folder that is empty")
        system.pipe_file(f"{root}/{UNFINISHED}", b"")
        synced = _Sync(system, root, there).run(files)
        system.rm_file(f"{root}/{UNFINISHED}")
        return synced
    except AssetFactoryError:
        raise
    except Exception as error:  # noqa: BLE001 - each file system has errors of its own
        why = f"{told(error, url)}; the same command goes on with what is missing"
        raise RegistryError(f"{shown(url)}: cannot be synchronised: {why}") from None


@dataclass
class _Sync:
    """One run.

    Attributes:
        system, root: where files go.
        there: files at first: path below the root -> entry of the listing.
    """

    system: Any
    root: str
    there: dict[str, dict[str, Any]]
    synced: Synced = field(default_factory=Synced)
    _made: set[str] = field(default_factory=set)

    def run(self, files: Iterable[tuple[str, bytes]]) -> Synced:
        named = set()
        with ThreadPoolExecutor(AT_ONCE, thread_name_prefix="sync") as pool:
            under_way: set[Future[int]] = set()
            try:
                for name, data in files:
                    named.add(name)
                    # Nothing is named before it is there.
                    is_index = PurePosixPath(name).parts[0] not in _BEFORE_INDEX
                    under_way = self._left(under_way, 0 if is_index else 2 * AT_ONCE - 1)
                    under_way.add(pool.submit(self._sent, name, data))
                self._left(under_way, 0)
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        for name in sorted(self.there.keys() - named):
            if PurePosixPath(name).parts[0] in TOP_NAMES:
                self.system.rm_file(f"{self.root}/{name}")
                self.synced.removed += 1
        return self.synced

    def _left(self, under_way: set[Future[int]], most: int) -> set[Future[int]]:
        """Wait until so many are left, and count the others; returns those."""
        while len(under_way) > most:
            done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
            for each in done:
                size = each.result()
                self.synced.files += 1
                self.synced.sent += size >= 0
                self.synced.bytes += max(size, 0)
        return under_way

    def _sent(self, name: str, data: bytes) -> int:
        """Have one file there; its size if it had to be sent [bytes], else -1."""
        path = f"{self.root}/{name}"
        if name in self.there and self._is_same(path, data, self.there[name]):
            return -1
        self._make(path.rpartition("/")[0])
        for _ in range(_TRIES):
            self.system.pipe_file(path, data)
            self.system.invalidate_cache(path.rpartition("/")[0])
            if self._is_same(path, data, self.system.info(path)):
                return len(data)
        raise OSError(f"{name}: is not what was sent (SHA-256), {_TRIES} times")

    def _make(self, folder: str) -> None:
        if folder not in self._made:
            self.system.makedirs(folder, exist_ok=True)
            self._made.add(folder)

    def _is_same(self, path: str, data: bytes, details: dict[str, Any]) -> bool:
        if details.get("size") != len(data):
            return False
        kept = stored_md5(details)
        if kept and kept == hashlib.md5(data, usedforsecurity=False).hexdigest():
            return True
        # A file that was sent in pieces has another tag.
        content: bytes = self.system.cat_file(path)
        return content == data


def _listed(system: Any, root: str) -> dict[str, dict[str, Any]]:
    """Return every file below a folder, read anew."""
    system.invalidate_cache()
    if not system.exists(root):
        return {}
    found = system.find(root, detail=True)
    return {path.removeprefix(root).strip("/"): details for path, details in found.items()}
