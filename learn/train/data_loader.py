"""Workers that draw the next steps' samples while the network learns from the last ones."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Sequence
from queue import Empty, Queue
from threading import Thread
from typing import Any

from asset_factory.factory.errors import ConfigError
from asset_factory.sim_checks.processes.threads import one_thread

from ..samples.batches import Batch, collate, join
from .dataset import Dataset, Pool
from .settings import TrainConfig

_DEATHS = 3
"""A worker that dies so often without a single batch in between is not started again."""


class DataLoader:
    """The batches of a run from a step on, for one of its processes; tells of workers that died.

    Of a step's samples, each of ``world`` processes gets every ``world``-th, from its ``rank`` on.
    """

    def __init__(
        self,
        config: TrainConfig,
        pools: tuple[Pool, ...],
        step: int,
        rank: int = 0,
        world: int = 1,
        say: Callable[[str], None] = lambda _line: None,
    ) -> None:
        self._config = config
        self._pools = pools
        self._numbers = range(rank, config.batch, world)
        lanes = sorted({number % config.lanes for number in self._numbers})
        workers = min(config.run.workers, len(lanes))
        self._shares: list[list[int]] = [[] for _ in range(workers)]
        for number in self._numbers if workers else ():
            self._shares[lanes.index(number % config.lanes) % workers].append(number)
        order = [number for share in self._shares for number in share]
        self._order = sorted(range(len(order)), key=order.__getitem__)
        self._supply = Dataset(config, pools) if not workers else None
        self._workers = [_Worker(config, pools, step, share, say) for share in self._shares]

    def __enter__(self) -> DataLoader:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.stop()

    def batch(self, step: int) -> Batch:
        """Return the batch of a step; steps are asked for one after another.

        Raises:
            ConfigError: a worker could not draw a sample, or died again and again.
        """
        if self._supply is not None:
            return _drawn(self._supply, self._config, step, self._numbers)
        return join([worker.take(step) for worker in self._workers], self._order)


class _Worker:
    """One process and what it has drawn; another takes its place when it dies."""

    def __init__(
        self,
        config: TrainConfig,
        pools: tuple[Pool, ...],
        step: int,
        numbers: Sequence[int],
        say: Callable[[str], None],
    ) -> None:
        self._config = config
        self._pools = pools
        self._numbers = tuple(numbers)
        self._say = say
        self._deaths = 0
        self._start(step)

    def _start(self, step: int) -> None:
        # Not forked: the trainer has threads, and a fork would copy their locks.
        context = multiprocessing.get_context("spawn")
        self._pipe, writing = context.Pipe(duplex=False)
        arguments = (self._config, self._pools, step, self._numbers, writing)
        self._process = context.Process(target=_work, args=arguments, daemon=True)
        with one_thread():
            self._process.start()
        # With the worker's end open nowhere else, its death ends what is read, even within a batch.
        writing.close()
        self._drawn: Queue[tuple[int, Batch | str] | None] = Queue(self._config.run.ahead)
        self._reader = Thread(target=_read, args=(self._pipe, self._drawn), daemon=True)
        self._reader.start()

    def take(self, step: int) -> Batch:
        while (drawn := self._drawn.get()) is None:
            self.stop()
            self._deaths += 1
            code = self._process.exitcode
            died = f"step {step}: a worker that draws samples died with code {code}"
            if self._deaths >= _DEATHS:
                wanted = "it may want more memory, or fewer workers"
                raise ConfigError(f"{died}, {_DEATHS} times in a row; {wanted}")
            # A sample follows from its step and number alone: another worker draws the same.
            self._say(f"{died}; another one takes its place")
            self._start(step)
        found_step, found = drawn
        if isinstance(found, Batch) and found_step == step:
            self._deaths = 0
            return found
        raise ConfigError(f"step {step}: a worker that draws samples failed: {found}")

    def stop(self) -> None:
        self._process.kill()
        self._process.join()
        while self._reader.is_alive():
            try:
                self._drawn.get(timeout=0.01)
            except Empty:
                continue
        self._pipe.close()


def _read(pipe: Any, drawn: Queue[tuple[int, Batch | str] | None]) -> None:
    """Pass on what a worker sends, and ``None`` after its end."""
    try:
        while True:
            drawn.put(pipe.recv())
    except (EOFError, OSError):
        drawn.put(None)


def _work(
    config: TrainConfig, pools: tuple[Pool, ...], step: int, numbers: Sequence[int], pipe: Any
) -> None:
    """Draw the samples of one step after another until the trainer is gone."""
    # Interrupts go to all processes; the trainer finishes its step and then stops this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    dataset = Dataset(config, pools)
    found: Batch | str | None = None
    while not isinstance(found, str):
        try:
            found = _drawn(dataset, config, step, numbers)
        except Exception as error:  # noqa: BLE001 - said by the trainer, in its own process
            found = f"{type(error).__name__}: {error}"
        try:
            pipe.send((step, found))
        except OSError:  # Nobody reads any more.
            return
        step += 1


def _drawn(dataset: Dataset, config: TrainConfig, step: int, numbers: Sequence[int]) -> Batch:
    return collate([dataset.sample(step, number) for number in numbers], config.network.max_parts)
