"""How much an export may bring."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import RegistryError


@dataclass(frozen=True)
class ImportLimits:
    """At most so much.

    Attributes:
        total_bytes: of all files together [bytes].
        file_bytes: of one file [bytes].
        files: how many.
    """

    total_bytes: int = 200_000_000_000
    file_bytes: int = 4_000_000_000
    files: int = 5_000_000


class Tally:
    """Counts files against limits."""

    def __init__(self, source: str, limits: ImportLimits) -> None:
        self._source = source
        self._limits = limits
        self._files = self._bytes = 0

    def add(self, name: str, size: int) -> None:
        """Count one more file. Raises RegistryError if it is too large, or one too many."""
        limits = self._limits
        self._files = self._files + 1
        self._bytes = self._bytes + size
        if not 0 <= size <= limits.file_bytes:
            raise RegistryError(
                f"{self._source}: {name!r} has {size} bytes, want at most {limits.file_bytes}"
            )
        if self._files > limits.files:
            raise RegistryError(f"{self._source}: more than {limits.files} files")
        if self._bytes > limits.total_bytes:
            raise RegistryError(
                f"{self._source}: more than {limits.total_bytes / 1e9:g} GB; --max-gb allows more"
            )

    @property
    def bytes(self) -> int:
        """Return the bytes counted so far."""
        return self._bytes
