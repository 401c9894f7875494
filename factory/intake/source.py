"""One input as it lies on the disk: loaded, with every file that it was made of."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from asset_factory.sim_checks import Finding, Severity
from asset_factory.sim_checks.report import KILLED, OUT_OF_TIME

from ..config import BuildConfig
from ..errors import InputRejected, Unjudged
from ..runtime.store import digest_bytes
from .categories import guess_category
from .intake import Intake
from .load import LOAD, load
from .naming import full_name, safe_name
from .reads import ReadLog, Reads, content_digest, unchanged

#: How often an input is read that somebody is writing at the same time.
MOST_READINGS = 3
ID_DIGITS = 10


class Source:
    """A mesh, URDF or MJCF file, and what it refers to.

    Args:
        place: where it lies for whoever registers it, if that is elsewhere; folder and file are
            called the same.

    Attributes:
        path, config, place: as given.
        reads: every file it was made of, by :meth:`load`: path relative to its folder -> digest.
        digest: of all of them, once all were read.
        keyed: whether what becomes of it holds for these files, and is not done again.
    """

    def __init__(self, path: Path, config: BuildConfig, place: Path | None = None) -> None:
        self.path = path
        self.config = config
        self.place = place or path
        self.reads: Reads = {}
        self.digest = ""
        self.keyed = True

    def load(self) -> Intake:
        """Read it.

        Raises:
            InputRejected: with a reason code; ``input_changed`` if it was another one each time it
                was looked at.
            Unjudged: what reads it hung, or somebody ended it.
        """
        for _ in range(MOST_READINGS):
            log = ReadLog()
            try:
                intake = load(self.path, self.config.intake, log)
            except InputRejected as rejection:
                self.digest = rejection.digest
                reads = log.reads_of(self.path)
                self.reads = {self.path.name: content_digest(self.path), **reads}
                if unchanged(self.path, reads):
                    raise
                continue
            except (TimeoutError, ChildProcessError) as error:
                self.reads = {self.path.name: content_digest(self.path), **log.reads_of(self.path)}
                raise _unjudged(error) from error
            self.reads = log.reads_of(self.path)
            self.digest = intake.provenance.digest
            # Files read one after the other may be of two versions.
            if unchanged(self.path, self.reads):
                return intake
        self.digest = ""
        self.keyed = False
        when = f"each of the {MOST_READINGS} times that they were read"
        advice = "build it again when they are at rest"
        message = f"{self.path.name}: somebody wrote its files {when}; {advice}"
        raise InputRejected("input_changed", message, value=float(MOST_READINGS), unit="readings")

    def with_up(self, up: str) -> Source:
        """Return the same input, read with another axis up."""
        intake = replace(self.config.intake, up=up)
        return Source(self.path, replace(self.config, intake=intake), self.place)

    @property
    def loaded_key(self) -> str:
        """Return the key of what :meth:`load` gave."""
        return loaded_key(self.path, self.reads, self.config)

    @property
    def id(self) -> str:
        """Return an id: of the same input the same anywhere, of another one another.

        An input not read to its end has one from its name and its own bytes; where it has more
        files than one, one that is no asset's, for the same bytes with other files beside them may
        have passed.
        """
        if self.digest:
            return asset_id(safe_name(self.path), self._told_apart(self.digest))
        return self.unloaded_ids[sum(map(bool, self.reads.values())) != 1]

    @property
    def unloaded_ids(self) -> tuple[str, ...]:
        """Return ids of an input not read in full: a single file, one of several, or unlicensed."""
        place = digest_bytes(os.fsencode(self.place))
        own = content_digest(self.path) or place
        digests = (own, *(digest_bytes(f"unread {digest}".encode()) for digest in (own, place)))
        return tuple(asset_id(safe_name(self.path), self._told_apart(digest)) for digest in digests)

    def _told_apart(self, digest: str) -> str:
        """Return the digest, with what tells apart inputs of the same bytes and safe name."""
        by_folder = guess_category(self.path.stem, self.path.absolute().parent.name)
        other = [full_name(self.path)] if full_name(self.path) != safe_name(self.path) else []
        other += [by_folder or ""] if by_folder != guess_category(self.path.stem) else []
        return digest_bytes(os.fsencode(" ".join([digest, *other]))) if other else digest


def _unjudged(error: OSError) -> Unjudged:
    """Say which of the two ends of a reader was no verdict."""
    hung = isinstance(error, TimeoutError)
    code = "reading_timeout" if hung else "reading_killed"
    cause = OUT_OF_TIME if hung else KILLED
    return Unjudged(Finding(code, Severity.ERROR, str(error), cause=cause))


def loaded_key(path: Path, reads: Reads, config: BuildConfig) -> str:
    """Return the key of what loading gives: an input's files, its name, and how it is read."""
    # The same files are another input under another name, for that becomes the asset's; their
    # folder only matters as far as it tells the category.
    names = [safe_name(path), path.suffix.lower(), _category(path.stem, path.parent.name)]
    return LOAD.key(config, names, sorted(reads.items()))


# An input's key is asked for a few times in a row, and looking through all categories takes a
# millisecond.
_category = lru_cache(maxsize=1024)(guess_category)


def asset_id(name: str, digest: str) -> str:
    """Return ``name`` and the first digits of the input's digest."""
    return f"{name}-{digest[:ID_DIGITS]}"
