"""A node's side of the Ray executor: each call in a killable child of the process Ray gives."""

from __future__ import annotations

import atexit
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from asset_factory.sim_checks.processes.isolation import (
    Failure,
    Limits,
    Outcome,
    WarmChild,
    preload,
)

from ..local import worth_another_try

T = TypeVar("T")

#: What a child imports to answer at all.
NEEDED = ("asset_factory.sim_checks.processes.isolation",)


@dataclass(frozen=True)
class WorkerSettings:
    """How calls are made on a node.

    Attributes:
        retries: further tries of a call that crashed, hung or ran out of memory, each in a new
            process.
        calls: after so many a child is replaced by a new one.
        resident_bytes: a child that holds more memory than this after a call is replaced at once
            [bytes].
        modules: what every child needs; imported once per process of Ray's.
    """

    retries: int
    calls: int
    resident_bytes: int
    modules: tuple[str, ...]


_children: dict[WorkerSettings, WarmChild] = {}


def work(
    function: Callable[..., T],
    arguments: Mapping[str, Any],
    limits: Limits,
    settings: WorkerSettings,
) -> Outcome[T]:
    """Make one call; whatever it does, this returns."""
    child = _child(settings)
    tries = 0
    deaths: tuple[str, ...] = ()
    while True:
        try:
            outcome = child.call(function, limits=limits, **arguments)
        except Exception as error:  # noqa: BLE001 - no process, no folder, no pickle: this call's failure alone
            return Outcome(
                None, Failure.RAISED, f"{type(error).__name__}: {error}", "", 0.0, None, tries + 1
            )
        tries += outcome.tries
        deaths += outcome.deaths
        if tries > settings.retries or not worth_another_try(outcome):
            return replace(outcome, tries=tries, deaths=deaths)
        child.close()


def _child(settings: WorkerSettings) -> WarmChild:
    """This process's child: Ray reuses the process, so imports are paid for only once."""
    if settings not in _children:
        # Children would import Ray's own main program: 50 MB and seconds for each of them, and
        # nothing they need.
        vars(sys.modules["__main__"]).pop("__file__", None)
        preload((*NEEDED, *settings.modules))
        _children[settings] = WarmChild(settings.calls, settings.resident_bytes)
        atexit.register(_children[settings].close)
    return _children[settings]
