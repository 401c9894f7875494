"""Is an input already known? Asked without loading it, by the files it was made of last time."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import msgspec

from ..config import BuildConfig
from ..intake.reads import Reads, content_digest, digest_now
from ..intake.sidecar import sidecar_paths
from ..intake.source import loaded_key
from ..registry import Entry, Registry
from ..registry.keys import build_key, failure_key
from ..runtime.store import digest_bytes, write_json

#: Files digested at once: disks and processors both gain by a few.
THREADS = 4
#: Inputs asked about ahead of whoever listens.
BATCH = 128


@dataclass(frozen=True)
class Probe:
    """One input, and its known verdict.

    Attributes:
        given: the input, as it was named.
        source: where it is, from wherever one looks.
        reads: the files that it is made of as far as is known, with their digests now.
        key: of what would be made of it.
        failure_key: of its having got no verdict.
        claim: a name for the work of making it, the same in every job.
    """

    given: Path
    source: Path
    reads: Reads
    key: str
    failure_key: str
    claim: str


def known_of(probes: Sequence[Probe], registry: Registry) -> Iterator[Entry | None]:
    """Yield the row of each, if the registry has one for exactly this."""
    rows = registry.known_keys([key for probe in probes for key in (probe.key, probe.failure_key)])
    return (rows.get(probe.key) or rows.get(probe.failure_key) for probe in probes)


class KnownReads:
    """Which files inputs were made of, by their main file and its sidecars, which lead there.

    Args:
        folder: losing it costs time only.
    """

    def __init__(self, folder: Path, config: BuildConfig) -> None:
        self._folder = folder
        self._config = config

    def probe(self, given: Path) -> Probe:
        """Look at an input; only digests are taken."""
        source = given.absolute()
        own = content_digest(source)
        names = self._names(source, own)
        reads = {name: own if name == source.name else digest_now(source, name) for name in names}
        key = build_key(loaded_key(source, reads, self._config), self._config)
        # All jobs must see one claim, whatever they know of the files beside this one.
        alone = build_key(loaded_key(source, {source.name: own}, self._config), self._config)
        return Probe(given, source, reads, key, failure_key(key, self._config), alone)

    def renewed(self, probe: Probe) -> Probe:
        """Return it, looked at again if somebody has found out since which files it is made of."""
        noted = self._names(probe.source, probe.reads[probe.source.name])
        return probe if noted == sorted(probe.reads) else self.probe(probe.given)

    def probe_all(self, sources: Iterable[Path]) -> Iterator[list[Probe]]:
        """Look at many, in order, a few at once, in batches of what a registry query may hold."""
        waiting = iter(sources)
        with ThreadPoolExecutor(THREADS, thread_name_prefix="digest") as pool:
            while batch := list(islice(waiting, BATCH)):
                yield list(pool.map(self.probe, batch))

    def note(self, source: Path, reads: Reads) -> None:
        """Remember which files an input was made of."""
        if reads.get(source.name) and sorted(reads) != self._names(source, reads[source.name]):
            path = self._path(source, reads[source.name])
            path.parent.mkdir(parents=True, exist_ok=True)
            write_json(path, sorted(reads))

    def _names(self, source: Path, digest: str) -> list[str]:
        """Return those noted; else those of an input that is a single file."""
        with suppress(OSError, msgspec.DecodeError):
            noted = msgspec.json.decode(self._path(source, digest).read_bytes(), type=list[str])
            if source.name in noted:
                return sorted(noted)
        return sorted({source.name, *(path.name for path in sidecar_paths(source))})

    def _path(self, source: Path, digest: str) -> Path:
        # The same bytes elsewhere may have another sidecar, which names other files.
        beside = [content_digest(path) for path in sidecar_paths(source)]
        name = digest_bytes(os.fsencode(" ".join([source.name, digest, *beside])))
        return self._folder / name[:2] / f"{name}.json"
