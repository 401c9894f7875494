"""What can go wrong, as a tree.

::

    AssetFactoryError
    ├── InputRejected         this mesh cannot become an asset: data, not a bug; has a reason code
    ├── Unjudged              a clock or somebody stopped a step: no verdict, to be tried again
    ├── InvalidArticulation   somebody tried to construct a kinematic tree that is not one
    ├── InvalidAsset          hulls or inertias that no simulator should be given
    ├── ConfigError           a preset, flag or sidecar says something that cannot be
    ├── RegistryError         the output directory is not a registry, or an id is not in it
    │   └── DamagedDatabaseError   its database is broken (registry/database.py)
    └── ClusterLost           the Ray cluster went away in the middle of a job (jobs/ray/cluster.py)
        └── NoNodeLeft        none of its nodes can be used (jobs/ray/nodes.py)

A bad asset is data and ends in a report; every other exception is a broken program.
"""

from __future__ import annotations

from enum import IntEnum

from asset_factory.sim_checks import Finding, Severity


class Exit(IntEnum):
    """Exit codes that all commands share."""

    OK = 0
    """Done."""
    REJECTED = 1
    """Something was rejected, and the caller asked to be told so."""
    USAGE = 2
    """Wrong usage, or a place that cannot be written to."""
    UNJUDGED = 3
    """Something could not be validated."""
    PIPE_CLOSED = 141
    """Whoever read the output had seen enough, as shells count it."""
    INTERRUPTED = 130
    """Stopped by the user, as shells count it."""
    TERMINATED = 143
    """Stopped by whoever ends processes."""


class AssetFactoryError(Exception):
    """Base of everything this package raises on purpose."""


class InputRejected(AssetFactoryError):
    """An input that cannot be used. Ends as a rejected asset; the job goes on.

    Attributes:
        code: stable reason code, e.g. ``unreadable``, ``empty``, ``too_large``.
        message: one sentence: what, where, what would work.
        finding: both, and the number behind the sentence, where there is one.
        digest: SHA-256 over all files of the input, where all were read before it was rejected.
    """

    def __init__(
        self,
        code: str,
        message: str,
        *,
        value: float | None = None,
        unit: str | None = None,
        limit: float | None = None,
        digest: str = "",
    ) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.finding = Finding(code, Severity.ERROR, message, value=value, unit=unit, limit=limit)
        self.digest = digest

    @classmethod
    def of(cls, finding: Finding, digest: str = "") -> InputRejected:
        """Return the rejection for a finding."""
        number = {"value": finding.value, "limit": finding.limit}
        return cls(finding.code, finding.message, unit=finding.unit, **number, digest=digest)

    def __reduce__(self) -> tuple[object, ...]:
        # Keyword-only arguments do not survive the default pickling between worker processes.
        return InputRejected.of, (self.finding, self.digest)


class Unjudged(AssetFactoryError):
    """A step that hung, or that somebody ended. Ends as unjudged; the next job tries again.

    Attributes:
        finding: the step that was stopped, and the limit.
    """

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding.message)
        self.finding = finding

    def __reduce__(self) -> tuple[object, ...]:
        return Unjudged, (self.finding,)


class InvalidArticulation(AssetFactoryError, ValueError):
    """The parts and joints given do not form one valid kinematic tree."""


class InvalidAsset(AssetFactoryError, ValueError):
    """Hulls, masses or inertias that are not physically valid."""


class ConfigError(AssetFactoryError, ValueError):
    """A preset, a flag or a sidecar file that cannot be understood."""


class RegistryError(AssetFactoryError, LookupError):
    """No registry there, or no such asset in it."""
