"""One input as it lies on the disk: loaded, with every file that it was made of."""

from __future__ import annotations

from pathlib import Path

from .config import BuildConfig
from .errors import InputRejected
from .keys import build_key, failure_key, input_key
from .load import load
from .mesh.intake import Intake
from .mesh.naming import safe_name
from .mesh.reads import Reads, content_digest, recorded, unchanged
from .store import digest_bytes

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
    """

    def __init__(self, path: Path, config: BuildConfig) -> None:
        self.path, self._config = path, config
        self.reads: Reads = {}
        self._torn = False

    def load(self) -> Intake:
        """Read it.

        Raises:
            InputRejected: with a reason code; ``input_changed`` if it was another one each time it was looked at.
        """
        for _ in range(MOST_READINGS):
            try:
                with recorded(self.path) as reads:
                    intake = load(self.path, self._config.intake)
            except InputRejected:
                self.reads = {self.path.name: content_digest(self.path), **reads}
                if unchanged(self.path, reads):
                    raise
                continue
            self.reads = reads
            # Files read one after the other may be of two versions.
            if unchanged(self.path, reads):
                return intake
        self._torn = True
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
        return "" if self._torn or not self.reads else build_key(self.loaded_key, self._config)

    @property
    def failure_key(self) -> str:
        """Of everything that its having no verdict follows from; empty if it did not keep still."""
        return failure_key(self.build_key, self._config) if self.build_key else ""

    @property
    def unloaded_id(self) -> str:
        """Id while it has not been loaded: from its name and its own bytes only."""
        return unloaded_id(self.path)


def asset_id(name: str, digest: str) -> str:
    """``name`` and the first digits of the input's digest: the same input has the same id anywhere."""
    return f"{name}-{digest[:ID_DIGITS]}"


def unloaded_id(path: Path) -> str:
    """Id of an input that could not be loaded: from its name and its own bytes only."""
    return asset_id(safe_name(path), content_digest(path) or digest_bytes(str(path).encode()))
