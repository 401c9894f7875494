"""Calls on a Ray cluster: the same killable children, on whichever node has room."""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any, Generic, TypeVar

from asset_factory.sim_checks.processes.isolation import Failure, Limits, Outcome

from ...config import ParticulateConfig
from ..executor import AHEAD, Call
from .alike import LEAST_FREE, difference, looking_first, versions
from .cluster import LOCAL, ClusterLost, connected
from .exchange import FULL, Transfer, begin_transfer, make_and_send, with_own_folder
from .inputs import PackedInput, pack_input
from .network import Networks
from .nodes import FULL_S, Nodes
from .weights import sent_weights
from .worker import Order

T = TypeVar("T")

#: How long to wait for an answer before looking whether the cluster has grown [s].
LOOK_S = 2.0
#: How long an answer that is there may take to be fetched [s].
FETCH_S = 120.0
#: How often a call may be lost with its node, or with Ray's process, and is made again elsewhere.
LOSSES = 3


@dataclass(frozen=True)
class RayExecutor:
    """Worker processes on a Ray cluster's nodes; each needs this package.

    Calls name things to send by their arguments: ``staging`` is the folder that they fill,
    ``address`` where they ask a network. With a URL as exchange, ``source`` is an input that is
    sent, ``place`` where it lies for the caller, and ``weights`` where checkpoints lie on the node;
    the ``reads`` of a call's value are the files that its input was made of.

    Attributes:
        workers: calls under way at once; by default as many as the cluster has room for, also when
            it grows.
        address: ``local`` for a cluster of this machine's own; ``auto`` or ``host:port`` for one
            that runs.
        memory_bytes: that one call takes, by which Ray places it [bytes]; 0: Ray does not look.
        retries: as :class:`~.local.LocalExecutor`.
        modules: what every child needs, imported once per process of Ray's.
        exchange: URL through which folders that calls fill come back, see
            :func:`~.exchange.begin_transfer`; empty where all nodes see them; ``None`` where calls
            fill none.
        network: that calls ask; ``None`` where they ask none, or each its own.
    """

    workers: int | None = None
    address: str = LOCAL
    memory_bytes: int = 0
    retries: int = 1
    modules: tuple[str, ...] = ()
    exchange: str | None = None
    network: ParticulateConfig | None = None

    def run(
        self, function: Callable[..., T], calls: Iterable[Call], limits: Limits
    ) -> Iterator[tuple[Call, Outcome[T]]]:
        """Make every call as :class:`~.executor.Executor` promises.

        Raises:
            ConfigError: there is no such cluster.
            ClusterLost: the cluster as a whole went away, or none of its nodes can be used.
        """
        with connected(self.address, self.workers) as ray:
            tasks: _Tasks[T] = _Tasks(self, ray, function, limits)
            waiting = iter(calls)
            try:
                while True:
                    tasks.look()
                    for call in islice(waiting, max(0, tasks.most() - len(tasks))):
                        tasks.start(_Task(call))
                    if not len(tasks):
                        return
                    tasks.drop_unwanted()
                    yield from tasks.finished()
            finally:
                tasks.end()


@dataclass(frozen=True)
class _Task:
    """One try of a call."""

    call: Call
    number: int = 0
    started: float = field(default_factory=time.monotonic)
    transfer: Transfer | None = None
    node: str = ""
    input: PackedInput | None = None
    more: frozenset[str] = frozenset()
    dropped: bool = False


class _Tasks(Generic[T]):
    """Tasks that run on the cluster."""

    def __init__(
        self, executor: RayExecutor, ray: Any, function: Callable[..., T], limits: Limits
    ) -> None:
        self._executor = executor
        self._ray = ray
        self._function = function
        self._limits = limits
        self._work = ray.remote(looking_first())
        self._room_of_one: dict[str, Any] = {"num_cpus": 1, "max_retries": 0}
        if executor.memory_bytes:
            self._room_of_one["memory"] = executor.memory_bytes
        self._nodes = Nodes(ray)
        self._under_way: dict[Any, _Task] = {}
        self._failed: list[tuple[Call, Outcome[T]]] = []
        network = executor.network
        named = (network.checkpoint, network.features) if network and executor.exchange else ()
        self._weights = sent_weights(ray, named)
        self._networks = None if network is None else Networks(ray, network, self._weights)
        self._looked = -LOOK_S
        self._room = 1

    def __len__(self) -> int:
        return len(self._under_way) + len(self._failed)

    def look(self) -> None:
        """See now and then what became of the cluster."""
        if time.monotonic() - self._looked <= LOOK_S:
            return
        self._looked = time.monotonic()
        processors = self._asked(self._ray.cluster_resources).get("CPU", 0.0)
        self._room = max(1, int(processors))
        self._asked(self._nodes.require_fit)
        self._asked(self._nodes.hang_up)
        if self._networks is not None:
            self._asked(self._networks.look)

    def most(self) -> int:
        """Return how many calls may be under way now."""
        if self._executor.workers is None:
            return AHEAD * self._room
        # Ray itself starts no more than there are processors in a cluster of one's own.
        return self._executor.workers * (AHEAD if self._executor.address == LOCAL else 1)

    def start(self, task: _Task) -> None:
        """Hand a call to the cluster; one that cannot be handed over has failed."""
        executor = self._executor
        function: Callable[..., Any] = self._function
        arguments = dict(task.call.arguments)
        transfer = packed = None
        try:
            if self._networks is not None:
                arguments["address"] = self._networks.address
            if executor.exchange is not None:
                arguments = with_own_folder(arguments)
            if executor.exchange:
                arguments["place"] = arguments["source"]
                packed = pack_input(arguments["source"], task.more)
                arguments, transfer = begin_transfer(executor.exchange, function, arguments)
                function = make_and_send
            how = (self._limits, executor.retries, executor.modules)
            # A call that is lost is packed again: its bytes need not be kept until then.
            kept = None if packed is None else replace(packed, data=b"")
            order = Order(function, arguments, *how, kept, task.call.until)
            under_way = self._handed_over(order, task.node, b"" if packed is None else packed.data)
        except (TypeError, ValueError, AttributeError, pickle.PicklingError) as error:
            detail = f"cannot be sent to a node: {_sentence(error)}"
            self._failed.append((task.call, Outcome(None, Failure.RAISED, detail, "", 0.0, error)))
            return
        self._under_way[under_way] = replace(task, transfer=transfer, input=kept)

    def _handed_over(self, order: Order, node: str, data: bytes) -> Any:
        """Return Ray's reference to a call that was handed over."""
        packed = self._ray.cloudpickle.dumps(order)
        placed = self._work.options(**self._room_of_one, **self._nodes.options(node))
        return placed.remote(packed, versions(), data, self._weights)

    def drop_unwanted(self) -> None:
        """Have Ray begin none of the calls that nobody wants any more; those that run go on."""
        for under_way, task in self._under_way.items():
            if not (task.dropped or task.call.wanted()):
                # A task that runs is deaf to this, see :func:`~.alike.looking_first`.
                self._ray.cancel(under_way, force=False)
                self._under_way[under_way] = replace(task, dropped=True)

    def finished(self) -> Iterator[tuple[Call, Outcome[T]]]:
        """Yield calls that have an outcome by now; wait a moment for the first."""
        while self._failed:
            yield self._failed.pop()
        if not self._under_way:
            return
        ready, _ = self._asked(self._ray.wait, list(self._under_way), num_returns=1, timeout=LOOK_S)
        for under_way in ready:
            task = self._under_way.pop(under_way)
            outcome = self._outcome(under_way, task)
            if outcome is not None:
                yield task.call, outcome

    def end(self) -> None:
        """Kill whatever is under way, drop what it has sent, and end the networks."""
        for under_way, task in self._under_way.items():
            with suppress(Exception):
                self._ray.cancel(under_way, force=True)
            self._dropped(task)
        self._under_way.clear()
        if self._networks is not None:
            self._networks.close()

    def _outcome(self, under_way: Any, task: _Task) -> Outcome[T] | None:
        """Return the outcome of a try that is over; ``None`` if it was lost and is made again."""
        errors = self._ray.exceptions
        try:
            return self._answered(under_way, task)
        except ClusterLost:
            raise
        except errors.RayTaskError as error:
            # Our own function returns whatever happens, so its arguments did not arrive as they
            # were sent.
            detail = f"cannot be made on a node: {_sentence(error.cause)}"
            return Outcome(None, Failure.RAISED, detail, "", self._age(task))
        except OSError as error:
            if error.errno in FULL:
                # Here, that is: nobody else's disk would do.
                return Outcome(None, Failure.RAISED, str(error), "", self._age(task), error)
            why = _sentence(error)
        except errors.RayError as error:
            why = _sentence(error)
        except Exception as error:  # noqa: BLE001 - some answers pickle and do not unpickle
            detail = f"its answer cannot be read: {_sentence(error)}"
            return Outcome(None, Failure.RAISED, detail, "", self._age(task), error)
        self._dropped(task)
        if task.node:
            self._nodes.died(task.node, task.call.name)
        if task.number < LOSSES:
            node = self._asked(self._nodes.next)
            self.start(replace(task, number=task.number + 1, node=node))
            return None
        detail = f"lost {task.number + 1} times on the cluster, the last time: {why}"
        return Outcome(None, Failure.CRASHED, detail, "", self._age(task), None, task.number + 1)

    def _answered(self, under_way: Any, task: _Task) -> Outcome[T] | None:
        """Return what a node says; ``None`` if the call is made again. Raises what loses a try."""
        try:
            word, node, answer = self._ray.get(under_way, timeout=FETCH_S)
        except self._ray.exceptions.TaskCancelledError:
            self._dropped(task)
            return Outcome(None, None, "", "", self._age(task))
        if word == "lost":
            raise OSError(answer)
        if word != "done":
            self._refused(task, word, node, answer)
            return None
        outcome: Outcome[Any] = answer
        if task.input is not None and outcome.value is not None:
            # What a node missed, and should have been sent along.
            lacking = task.input.lacking(outcome.value.value.reads)
            if lacking:
                self._dropped(task)
                self.start(replace(task, more=task.more | lacking))
                return None
        return outcome if task.transfer is None else task.transfer.opened(outcome)

    def _refused(self, task: _Task, word: str, node: str, answer: Any) -> None:
        """Have another node make a call that one would not do for."""
        self._dropped(task)
        same = "; install the same versions everywhere"
        if word == "absent":
            self._nodes.set_aside(node, f"asset-factory cannot be imported: {answer}{same}")
        elif word == "other":
            self._nodes.set_aside(node, f"it has {difference(versions(), answer)}{same}")
        else:
            room = f"{answer / 1e6:.0f} MB are free for temporary files"
            few = answer < LEAST_FREE
            want = f"want {LEAST_FREE / 1e6:.0f}" if few else "too few for an input"
            self._nodes.set_aside(node, f"{room}, {want}", FULL_S)
        self.start(replace(task, node=""))

    def _dropped(self, task: _Task) -> None:
        """Drop what a try has sent."""
        if task.transfer is not None:
            task.transfer.drop()

    def _age(self, task: _Task) -> float:
        return time.monotonic() - task.started

    def _asked(self, ask: Callable[..., Any], *args: Any, **settings: Any) -> Any:
        try:
            return ask(*args, **settings)
        except (self._ray.exceptions.RayError, ConnectionError) as error:
            cluster = f"the Ray cluster at {self._executor.address!r}"
            raise ClusterLost(f"{cluster} does not answer any more: {error}") from error


def _sentence(error: BaseException) -> str:
    """Return the first line of an error; Ray explains at length, and in colour."""
    lines = str(error).strip().splitlines()
    return f"{type(error).__name__}: {lines[0][:300]}" if lines else type(error).__name__
