"""One input's stages: how long each took, and which were answered from the cache."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from asset_factory.sim_checks import Finding

from ..config import BuildConfig
from ..errors import InputRejected
from .clock import Stopwatch
from .packing import pack, unpack
from .store import Store

T = TypeVar("T")


class Stages:
    """The stages of one build, remembered by their inputs.

    Args:
        config: of every stage.
        store: where results are kept; without one everything is done each time.

    Attributes:
        clock: told how long each stage takes.
        reused: stages that were answered from the store at least once, in order.
        done: stages that were done at least once, in order.
    """

    def __init__(self, config: BuildConfig, store: Store | None = None) -> None:
        self.config = config
        self.store = store
        self.clock = Stopwatch()
        self.reused: list[str] = []
        self.done: list[str] = []

    def recall(
        self,
        stage: str,
        kind: type[T],
        key: str,
        make: Callable[[], T],
        worth: Callable[[T], bool] = lambda value: True,
    ) -> T:
        """Return the value kept under ``key``, else that of ``make``, which is then kept.

        Args:
            stage: its name.
            kind: type of the result; see :mod:`~.packing`.
            key: of everything that the result depends on; see :func:`~.store.stage_key`.
            make: does it; a rejection is kept like a result.
            worth: whether a result may be kept: not one that another try might better.

        Raises:
            InputRejected: as ``make`` does, or did.
        """
        with self.clock.stage(stage):
            kept = self._kept(kind, key)
        if kept is None:
            return self._made(stage, key, make, worth)
        _add(self.reused, stage)
        if isinstance(kept, InputRejected):
            raise kept
        return kept

    def _kept(self, kind: type[T], key: str) -> T | InputRejected | None:
        arrays = None if self.store is None else self.store.load(key)
        if arrays is None:
            return None
        try:
            if "refused" in arrays:
                return InputRejected.of(unpack(Finding, arrays))
            return unpack(kind, arrays)
        except ValueError:
            return None

    def _made(self, stage: str, key: str, make: Callable[[], T], worth: Callable[[T], bool]) -> T:
        _add(self.done, stage)
        try:
            with self.clock.stage(stage):
                value = make()
        except InputRejected as error:
            if self.store is not None:
                self.store.save(key, {**pack(error.finding), "refused": pack(True)["text"]})
            raise
        if self.store is not None and worth(value):
            self.store.save(key, pack(value))
        return value


def _add(names: list[str], name: str) -> None:
    if name not in names:
        names.append(name)
