"""Making shards: only missing ones, in processes that may die."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
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
        gathered: dict[str, dict[Episode, Taken]] = {}
        for shard in shards:
            kept = (kept_episode(waiting, self.settings, episode) for episode in shard.episodes)
            gathered[shard.name] = {taken.episode: taken for taken in kept if taken is not None}
        owners = {episode: shard for shard in shards for episode in shard.episodes}
        missing = [each for each, shard in owners.items() if each not in gathered[shard.name]]
        for shard in shards:
            if len(gathered[shard.name]) == len(shard.episodes):
                yield shard, self._finish(shard, gathered.pop(shard.name))
        for taken in self._episodes(missing, waiting):
            shard = owners[taken.episode]
            gathered[shard.name][taken.episode] = taken
            if len(gathered[shard.name]) == len(shard.episodes):
                yield shard, self._finish(shard, gathered.pop(shard.name))

    def _finish(self, shard: Shard, gathered: dict[Episode, Taken]) -> tuple[Taken, ...]:
        waiting = self.target / WAITING
        taken = tuple(gathered[episode] for episode in shard.episodes)
        write_shard(self.target, waiting, shard, taken, self.settings, self.registry)
        # What is tried again by the next run needs the others once more.
        if all(each.judged for each in taken):
            forget_episodes(waiting, self.settings, shard)
        return taken

    def _episodes(self, episodes: Iterable[Episode], waiting: Path) -> Iterator[Taken]:
        """Make episodes, in processes that may die."""
        wanted = list(episodes)
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
