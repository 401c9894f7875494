"""Workers that draw the samples of the steps to come while the network learns from the last ones."""

from __future__ import annotations

import multiprocessing
import os
import queue
import signal
from collections.abc import Sequence
from types import TracebackType
from typing import Any

from ..errors import ConfigError
from .batches import Batch, collate, join
from .settings import TrainConfig
from .supply import Pool, Supply

_PATIENCE_S = 2.0


class Feed:
    """The batches of a run, step by step, for one of its processes.

    Args:
        config: of the run.
        pools: of its data.
        step: the first one wanted.
        rank: number of this process.
        world: how many there are; each gets every ``world``-th sample of a step.
    """

    def __init__(self, config: TrainConfig, pools: tuple[Pool, ...], step: int, rank: int = 0, world: int = 1) -> None:
        self._config, self._pools = config, pools
        self._numbers = range(rank, config.batch, world)
        lanes = sorted({number % config.lanes for number in self._numbers})
        workers = min(config.run.workers, len(lanes))
        self._shares = [
            [number for number in self._numbers if lanes.index(number % config.lanes) % workers == worker]
            for worker in range(workers)
        ]
        order = [number for share in self._shares for number in share]
        self._order = sorted(range(len(order)), key=order.__getitem__)
        self._supply = Supply(config, pools) if not workers else None
        self._workers = [_Worker(config, pools, step, share) for share in self._shares]

    def __enter__(self) -> Feed:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for worker in self._workers:
            worker.stop()

    def batch(self, step: int) -> Batch:
        """The batch of a step; steps are asked for one after another.

        Raises:
            ConfigError: a worker could not draw a sample, or died.
        """
        if self._supply is not None:
            return _drawn(self._supply, self._config, step, self._numbers)
        return join([worker.take(step) for worker in self._workers], self._order)


class _Worker:
    """One process and what it has drawn."""

    def __init__(self, config: TrainConfig, pools: tuple[Pool, ...], step: int, numbers: Sequence[int]) -> None:
        # Not forked: the trainer has threads, and a fork would copy their locks.
        context = multiprocessing.get_context("spawn")
        self._drawn: Any = context.Queue(maxsize=config.run.ahead)
        arguments = (config, pools, step, tuple(numbers), self._drawn)
        self._process = context.Process(target=_work, args=arguments, daemon=True)
        self._process.start()

    def take(self, step: int) -> Batch:
        while True:
            try:
                found_step, found = self._drawn.get(timeout=_PATIENCE_S)
                break
            except queue.Empty:
                if not self._process.is_alive():
                    code = self._process.exitcode
                    raise ConfigError(f"step {step}: a worker that draws samples died with code {code}") from None
        if isinstance(found, Batch) and found_step == step:
            return found
        raise ConfigError(f"step {step}: a worker that draws samples failed: {found}")

    def stop(self) -> None:
        self._process.kill()
        self._process.join()
        self._drawn.close()
        self._drawn.cancel_join_thread()


def _work(config: TrainConfig, pools: tuple[Pool, ...], step: int, numbers: Sequence[int], drawn: Any) -> None:
    """Draw the samples of one step after another until the trainer is gone."""
    # Interrupts go to a whole group of processes; the trainer finishes its step and then stops this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    supply = Supply(config, pools)
    while parent is not None and parent.is_alive():
        found: Batch | str
        try:
            found = _drawn(supply, config, step, numbers)
        except Exception as error:  # noqa: BLE001 - said by the trainer, in its own process
            found = f"{type(error).__name__}: {error}"
        while parent.is_alive():
            try:
                drawn.put((step, found), timeout=_PATIENCE_S)
                break
            except queue.Full:
                continue
        step += 1
        if isinstance(found, str):
            break
    if parent is None or not parent.is_alive():
        # Nobody reads any more, so the queue's thread would wait for ever.
        os._exit(1)


def _drawn(supply: Supply, config: TrainConfig, step: int, numbers: Sequence[int]) -> Batch:
    return collate([supply.sample(step, number) for number in numbers], config.network.max_parts)
