"""A node's side of the Ray executor: each call in a killable child of the process Ray gives."""

from __future__ import annotations

import atexit
import pickle
import sys
import tarfile
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

from asset_factory.sim_checks.processes.isolation import Limits, Outcome, WarmChild, preload

from ..local import CALLS, RESIDENT_BYTES, tried
from .exchange import FULL, ExchangeError
from .inputs import PackedInput
from .weights import SentWeights, arrived

#: What a child imports to answer at all.
NEEDED = ("asset_factory.sim_checks.processes.isolation",)


@dataclass(frozen=True)
class Order:
    """One call, as a node is given it.

    Attributes:
        function, arguments, limits: of the call.
        retries: further tries of what crashed, hung or ran out of memory, each in a new process.
        modules: what every child needs; imported once per process of Ray's.
        input: the one sent along; ``None``: the node sees it.
        until: when it is ended, if it still runs [s since 1970].
    """

    function: Callable[..., Any]
    arguments: Mapping[str, Any]
    limits: Limits
    retries: int
    modules: tuple[str, ...] = ()
    input: PackedInput | None = None
    until: float | None = None


def carry_out(packed: bytes, data: bytes, weights: SentWeights) -> tuple[str, Any]:
    """Make one call with the files sent along; whatever it does, this returns.

    Args:
        packed: an :class:`Order`.
        data: of its input; empty if none was sent.
        weights: checkpoints that it may ask for, and that this node does not see.

    Returns:
        ``done`` and its outcome; ``full`` if this node had no room for its inputs
        or outputs; ``lost`` and why, if files did not arrive, here or from here.
    """
    import ray

    order: Order = pickle.loads(packed)  # noqa: S301 - from the one who gives the work
    try:
        with ExitStack() as stack:
            here: dict[str, Any] = {}
            if order.input is not None:
                here["source"] = stack.enter_context(order.input.unpacked(data))
            if weights:
                here["weights"] = arrived(ray, weights)
            arguments = {**order.arguments, **({"here": here} if here else {})}
            outcome: Outcome[Any] = tried(
                _child(order.modules),
                partial(order.function, **arguments),
                order.limits,
                retries=order.retries,
                until=order.until,
            )
    except OSError as error:
        return ("full", None) if _is_full(error) else ("lost", f"{type(error).__name__}: {error}")
    except (ray.exceptions.RayError, ExchangeError, tarfile.TarError) as error:
        return "lost", f"{type(error).__name__}: {error}"
    if isinstance(outcome.error, ExchangeError):
        return "lost", str(outcome.error)
    # Without a URL it may be the caller's own folder that is full.
    return ("full", None) if order.input and _is_full(outcome.error) else ("done", outcome)


def _is_full(error: BaseException | None) -> bool:
    return isinstance(error, OSError) and error.errno in FULL


@cache
def _child(modules: tuple[str, ...]) -> WarmChild:
    """Return this process's child: Ray reuses the process, so imports are paid for only once."""
    # Children would import Ray's own main program: 50 MB and seconds for each of them, and nothing
    # they need.
    vars(sys.modules["__main__"]).pop("__file__", None)
    preload((*NEEDED, *modules))
    child = WarmChild(CALLS, RESIDENT_BYTES)
    atexit.register(child.close)
    return child
