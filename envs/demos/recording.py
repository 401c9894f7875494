"""One episode: solved, then acted again before ManiSkill's recorder, in a process that may die."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from ..solving.attempt import Attempt
from ..solving.solve import SolveTask, attempted, replay
from .episodes import SOLVED_IN, Episode, Settings, Taken
from .files import keep_episode


def record(registry: str, episode: Episode, settings: Settings, folder: str) -> Taken:
    """Solve an episode and keep its trajectory in ``folder``, which must exist.

    Raises:
        RegistryError, ConfigError: as the environment does.
    """
    what = (episode.asset, episode.joint)
    attempt = attempted(SolveTask(registry, *what, settings.robot, episode.seed, settings.tries))
    why = attempt.reason, attempt.message
    opened = round(attempt.open_fraction, 6)
    taken = Taken(episode, attempt.solved, *why, opened, attempt.steps)
    if attempt.solved or (settings.keep_failures and attempt.steps):
        return act_again(registry, taken, attempt, settings, Path(folder))
    keep_episode(Path(folder), settings, taken, None)
    return taken


def act_again(
    registry: str, taken: Taken, attempt: Attempt, settings: Settings, folder: Path
) -> Taken:
    """Act an attempt before the recorder, and keep what it wrote."""
    from mani_skill.utils.io_utils import load_json
    from mani_skill.utils.wrappers import RecordEpisode

    name = f"{taken.episode.key(settings)}-recording"
    written = folder / f"{name}.h5"
    described = folder / f"{name}.json"
    unasked = {"save_video": False, "save_on_reset": False, "clean_on_close": False}
    made = _make(registry, settings)
    environment = RecordEpisode(made, str(folder), trajectory_name=name, **unasked)
    try:
        success = _act(environment, registry, attempt, settings)
        environment.flush_trajectory()
    finally:
        environment.close()
    info = load_json(described)["episodes"][0]
    taken = _judged(taken, success, info, settings)
    keep_episode(folder, settings, taken, written if taken.info is not None else None)
    for path in (written, described):
        path.unlink(missing_ok=True)
    return taken


def _make(registry: str, settings: Settings) -> Any:
    import gymnasium

    info = settings.env_info(registry)
    return gymnasium.make(info["env_id"], **info["env_kwargs"])


def _act(environment: Any, registry: str, attempt: Attempt, settings: Settings) -> bool:
    """Reset and act; whether the task said ``success`` after the last action."""
    if settings.control_mode == SOLVED_IN:
        return replay(environment, attempt)[0]
    from .converting import act_converted

    reset: dict[str, Any] = {"seed": attempt.seed, "options": attempt.options}
    environment.reset(**reset)
    original = _make(registry, replace(settings, control_mode=SOLVED_IN, obs_mode="none"))
    try:
        original.reset(**reset)
        return act_converted(settings.control_mode, attempt.actions, original, environment)
    finally:
        original.close()


def _judged(taken: Taken, success: bool, info: dict[str, Any], settings: Settings) -> Taken:
    """Return what the trajectory that was recorded is worth."""
    if bool(info["success"]) != success:
        raise RuntimeError(f"the recorder wrote success {info['success']}, the task said {success}")
    steps = int(info["elapsed_steps"])
    if success:
        return replace(taken, success=True, reason="", message="", steps=steps, info=info)
    if taken.success:
        reason = "unconvertible"
        how = "actions did not open it"
        if settings.control_mode == SOLVED_IN:
            reason = "irreproducible"
            how = "same actions did not open it again"
        message = f"solved in {taken.steps} steps, and as {settings.control_mode} the {how}"
        taken = replace(taken, success=False, reason=reason, message=message)
    return replace(taken, steps=steps, info=info if settings.keep_failures else None)
