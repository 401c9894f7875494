"""One input as it lies on the disk: loaded, with every file that it was made of."""

from __future__ import annotations

import os
from pathlib import Path

from ..config import BuildConfig
from ..errors import InputRejected
from ..keys import build_key, failure_key, input_key
from ..runtime.store import digest_bytes
from .intake import Intake
from .load import load
from .naming import full_name, safe_name
from .reads import Reads, content_digest, recorded, unchanged
from .sizes import guess_category

#: How often an input is read that somebody is writing at the same time.
MOST_READINGS = 3
ID_DIGITS = 10


class Source:
    """A mesh, URDF or MJCF file, and what it refers to.

    Args:
        path: of the file.
        config: how it is read.

    Attributes:
        path: as given.
        reads: every file it was made of, by :meth:`load`: path relative to its folder -> digest.
        digest: of all of them, once all were read.
        keyed: whether what becomes of it holds for these files, and is not done again.
    """

    def __init__(self, path: Path, config: BuildConfig) -> None:
        self.path, self._config = path, config
        self.reads: Reads = {}
        self.digest, self.keyed = "", True

    def load(self) -> Intake:
        """Read it.

        Raises:
            InputRejected: with a reason code; ``input_changed`` if it was another one each time it
                was looked at.
        """
        for _ in range(MOST_READINGS):
            try:
                with recorded(self.path) as reads:
                    intake = load(self.path, self._config.intake)
            except InputRejected as rejection:
                self.digest = rejection.digest
                self.reads = {self.path.name: content_digest(self.path), **reads}
                if unchanged(self.path, reads):
                    raise
                continue
            self.reads, self.digest = reads, intake.provenance.digest
            # Files read one after the other may be of two versions.
            if unchanged(self.path, reads):
                return intake
        self.digest, self.keyed = "", False
        message = (
            f"{self.path.name}: somebody wrote its files each of the {MOST_READINGS} times that they were read; "
            "build it again when they are at rest"
        )
        raise InputRejected("input_changed", message, value=float(MOST_READINGS), unit="readings")

    @property
    def loaded_key(self) -> str:
        """Of what :meth:`load` gave."""
        return input_key(self.path, self.reads, self._config)

    @property
    def build_key(self) -> str:
        """Of everything that follows from it; empty if it did not keep still."""
        return "" if not (self.keyed and self.reads) else build_key(self.loaded_key, self._config)

    @property
    def failure_key(self) -> str:
        """Of everything that its having no verdict follows from; empty if it did not keep still."""
        return failure_key(self.build_key, self._config) if self.build_key else ""

    @property
    def id(self) -> str:
        """The same input has the same id anywhere, another one another.

        What was not read to its end has one from its name and its own bytes; where it has more
        files than one, one that is no asset's, for the same bytes with other files beside them may
        have passed.
        """
        if self.digest:
            return asset_id(safe_name(self.path), self._told_apart(self.digest))
        return self.unloaded_ids[sum(map(bool, self.reads.values())) != 1]

    @property
    def unloaded_ids(self) -> tuple[str, ...]:
        """Ids of an input that was not read to its end: as a single file, as one of several, as one without rights."""
        place = digest_bytes(os.fsencode(self.path))
        own = content_digest(self.path) or place
        digests = (own, *(digest_bytes(f"unread {digest}".encode()) for digest in (own, place)))
        return tuple(asset_id(safe_name(self.path), self._told_apart(digest)) for digest in digests)

    def _told_apart(self, digest: str) -> str:
        """The digest, and what else two inputs of the same bytes and the same safe name may differ in."""
        by_folder = guess_category(self.path.stem, self.path.absolute().parent.name)
        other = [full_name(self.path)] if full_name(self.path) != safe_name(self.path) else []
        other += [by_folder or ""] if by_folder != guess_category(self.path.stem) else []
        return digest_bytes(os.fsencode(" ".join([digest, *other]))) if other else digest


def asset_id(name: str, digest: str) -> str:
    """``name`` and the first digits of the input's digest."""
    return f"{name}-{digest[:ID_DIGITS]}"
