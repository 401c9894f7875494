"""Robots that succeed at once: episodes as recorded."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from asset_factory.envs.demos.episodes import Episode, Settings, Taken
from asset_factory.envs.demos.files import keep_episode
from asset_factory.sim_checks.processes.isolation import Failure, Outcome


def write_trajectory(path: Path, seed: int, steps: int = 5) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        group = file.create_group("traj_0", track_order=True)
        group.create_dataset("actions", data=np.full((steps, 8), seed, dtype=np.float32))
        group.create_dataset("success", data=np.arange(steps) == steps - 1)


def fake_record(registry: str, episode: Episode, settings: Settings, folder: str) -> Taken:
    """Hinges open; slides do not."""
    taken = Taken(episode, episode.joint != "slide", steps=5)
    if not taken.success:
        taken = replace(taken, reason="stuck", message="not moved by 50 N")
        keep_episode(Path(folder), settings, taken, None)
        return taken
    reset = {"seed": episode.seed, "options": {"asset": episode.asset, "joint": episode.joint}}
    info = {"episode_id": 0, "elapsed_steps": 5, "reset_kwargs": reset, "success": True}
    taken = replace(taken, info=info)
    path = Path(folder) / f"{episode.key(settings)}-recording.h5"
    write_trajectory(path, episode.seed)
    keep_episode(Path(folder), settings, taken, path)
    return taken


class Answers:
    """In place of the executor: answers in this process, and dies on the way if it is told to."""

    asked: list[Episode]
    dies_after: int
    slow: frozenset[int]

    def __init__(self, workers: int, retries: int) -> None:
        pass

    def run(self, function, calls, limits):
        for call in calls:
            if len(self.asked) == self.dies_after:
                raise KeyboardInterrupt
            registry, settings, folder, episode = call.arguments.values()
            self.asked.append(episode)
            if episode.seed in self.slow:
                yield call, Outcome(None, Failure.TIMEOUT, "no answer within 600 s", "", 600.0)
            else:
                record = fake_record(registry, episode, settings, folder)
                yield call, Outcome(record, None, "", "", 1.0)
