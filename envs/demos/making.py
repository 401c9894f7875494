"""Making shards: only missing ones, in processes that may die."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs import LocalExecutor
from asset_factory.factory.jobs.executor import Call
from asset_factory.sim_checks.processes.isolation import Failure, Limits, Outcome

from .episodes import Episode, Settings, Shard, Taken
from .files import WAITING, clear_unfinished, forget_episodes, kept_episode, read_shard, write_shard
from .printing import show_episode
from .recording import record


@dataclass(frozen=True)
class Making:
    """One run.

    Attributes:
        registry: as it was given.
        target: folder of shards.
        settings: of all episodes.
        workers: episodes made at once.
        timeout_s: longest that one may take [s].
    """

    registry: str
    target: Path
    settings: Settings
    workers: int = 1
    timeout_s: float = 600.0

    def run(self, shards: Sequence[Shard]) -> Iterator[tuple[Shard, tuple[Taken, ...]]]:
        """Make the missing shards; yields those that existed, then the others as they finish.

        Raises:
            ConfigError: the environment cannot be made like this.
        """
        clear_unfinished(self.target)
        missing = []
        for shard in shards:
            found = read_shard(self.target, shard, self.settings)
            if found is None:
                missing.append(shard)
            else:
                yield shard, found
        yield from self._make(missing)
        clear_unfinished(self.target)

    def _make(self, shards: Sequence[Shard]) -> Iterator[tuple[Shard, tuple[Taken, ...]]]:
        waiting = self.target / WAITING
        waiting.mkdir(exist_ok=True)
        owners = {episode: shard for shard in shards for episode in shard.episodes}
        tried = {each: kept_episode(waiting, self.settings, each) for each in owners}
        kept = [taken for taken in tried.values() if taken is not None]
        missing = [episode for episode, taken in tried.items() if taken is None]
        gathered: dict[Episode, Taken] = {}
        for taken in chain(kept, self._episodes(missing, waiting)):
            gathered[taken.episode] = taken
            shard = owners[taken.episode]
            if gathered.keys() >= set(shard.episodes):
                yield shard, self._finish(shard, [gathered.pop(each) for each in shard.episodes])

    def _finish(self, shard: Shard, taken: Sequence[Taken]) -> tuple[Taken, ...]:
        waiting = self.target / WAITING
        write_shard(self.target, waiting, shard, taken, self.settings, self.registry)
        # What is tried again by the next run needs the others once more.
        if all(each.judged for each in taken):
            forget_episodes(waiting, self.settings, shard)
        return tuple(taken)

    def _episodes(self, wanted: Sequence[Episode], waiting: Path) -> Iterator[Taken]:
        """Make episodes, in processes that may die."""
        shared = {"registry": self.registry, "settings": self.settings, "folder": str(waiting)}
        named = ((f"{each.asset} {each.joint} {each.seed}", each) for each in wanted)
        calls = (Call(name, {**shared, "episode": each}) for name, each in named)
        executor = LocalExecutor(self.workers, retries=0)
        limits = Limits(wall_s=self.timeout_s)
        for count, (call, outcome) in enumerate(executor.run(record, calls, limits), 1):
            taken = answered(outcome, call.arguments["episode"])
            show_episode(count, len(wanted), taken, outcome.seconds)
            yield taken


def answered(outcome: Outcome[Taken], episode: Episode) -> Taken:
    """Return what a child running :func:`~.recording.record` said, or how it failed.

    Raises what the user got wrong.
    """
    if outcome.failure is None:
        return outcome.unwrap()
    if isinstance(outcome.error, ConfigError):
        raise outcome.error
    reason = "failed" if outcome.failure is Failure.RAISED else outcome.failure
    return Taken(episode, False, reason, outcome.detail)
