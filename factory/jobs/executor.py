"""The one interface behind which every way of running many calls stands."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from asset_factory.sim_checks.processes.isolation import Limits, Outcome

T = TypeVar("T")

#: Calls taken but not yet answered are at most this many times the workers: enough that none of
#: them waits.
AHEAD = 2


@dataclass(frozen=True)
class Call:
    """One thing to do.

    Attributes:
        name: tells it from others in logs.
        arguments: of the function, by name; they must pickle.
        until: when it is ended, if it still runs [s since 1970]; ``None``: by the limits alone.
        wanted: asked on this machine before it is begun, if it was not handed to another.
    """

    name: str
    arguments: Mapping[str, Any]
    until: float | None = None
    wanted: Callable[[], bool] = lambda: True


@dataclass(frozen=True)
class UnderWay:
    """A call that is being made: its name, and where its work is, empty if that is not known."""

    name: str
    place: str


class Executor(Protocol):
    """Makes many calls, each isolated: a crash, hang or memory shortage harms no other."""

    def run(
        self, function: Callable[..., T], calls: Iterable[Call], limits: Limits
    ) -> Iterator[tuple[Call, Outcome[T]]]:
        """Make every call; give each with its outcome, in order of completion.

        Calls are taken from ``calls`` as workers come free, in the caller's thread and never more
        than :data:`AHEAD` times the workers ahead: a million of them need no more memory than ten.
        Closing the iterator kills running builds.

        The function is importable by name, and its results pickle; calls may be lazy.

        Returns:
            Every call once, a failed one with the failed outcome of its last try, and one that was
            not wanted or not done in time with neither value nor failure. Nothing that a call does
            raises.
        """
