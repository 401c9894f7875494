"""Workers that draw the next steps' samples while the network learns from the last ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import lru_cache
from itertools import chain, count
from multiprocessing.reduction import ForkingPickler

import numpy as np

from asset_factory.factory.errors import ConfigError
from asset_factory.sim_checks.processes.isolation import Limits, WarmChild

from ..samples.batches import Batch, join
from .dataset import Dataset, Pool
from .settings import TrainConfig

_PATIENT = Limits(wall_s=1e6)


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
        self._numbers = range(rank, config.batch, world)
        workers = min(config.run.workers, len(self._numbers))
        # A worker draws the same places of every step: it makes each procedural object once.
        shares = [self._numbers[first::workers] for first in range(workers)]
        self._order = np.argsort(list(chain.from_iterable(shares)))
        self._supply = Dataset(config, pools) if not workers else None
        given = bytes(ForkingPickler.dumps((config, pools)))
        ahead = config.run.ahead
        self._workers = [_Worker(given, ahead, step, share, say) for share in shares]

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
            return self._supply.batch(step, self._numbers)
        return join([worker.take() for worker in self._workers], self._order)


class _Worker:
    """One process and what it draws ahead; another takes its place when it dies."""

    def __init__(
        self, given: bytes, ahead: int, step: int, numbers: range, say: Callable[[str], None]
    ) -> None:
        self._given = given
        self._numbers = tuple(numbers)
        self._say = say
        self._child = WarmChild()
        self._asking = ThreadPoolExecutor(1, thread_name_prefix="drawing")
        self._steps = count(step)
        self._drawn = deque(self._ask() for _ in range(ahead))

    def _ask(self) -> Future[Batch]:
        return self._asking.submit(self._draw, next(self._steps))

    def take(self) -> Batch:
        self._drawn.append(self._ask())
        return self._drawn.popleft().result()

    def _draw(self, step: int) -> Batch:
        """Have the process draw; a sample follows from its step and number, whoever draws it."""
        here = f"step {step}: a worker that draws samples"
        outcome = self._child.call(draw_share, self._given, step, self._numbers, limits=_PATIENT)
        if outcome.value is None:
            wanted = "" if outcome.error else "; it may want more memory, or fewer workers"
            raise ConfigError(f"{here} failed: {outcome.detail}{wanted}")
        if outcome.tries > 1:
            self._say(f"{here} died; another one takes its place")
        return outcome.value

    def stop(self) -> None:
        self._child.abandon()
        self._asking.shutdown(cancel_futures=True)
        self._child.close()


def draw_share(given: bytes, step: int, numbers: Sequence[int]) -> Batch:
    """Draw a worker's share of a step, in its process, which keeps its data set for the next."""
    return _dataset(given).batch(step, numbers)


@lru_cache(maxsize=1)
def _dataset(given: bytes) -> Dataset:
    return Dataset(*ForkingPickler.loads(given))
