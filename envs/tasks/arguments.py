"""Arguments of ``gym.make`` or a command, checked before anything loads: one clear error each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from asset_factory.factory.errors import ConfigError

#: Observations that need no picture.
BLIND_MODES = ("state", "state_dict", "none")
#: What SAPIEN says where Vulkan is missing or finds nothing to draw with.
NO_RENDERER_SIGNS = (
    "rendering device",
    "IncompatibleDriver",
    "physical device",
    "render device",
    "Vulkan",
    "vulkan",
)


def check_robot(task: str, robot: object, supported: Sequence[str]) -> None:
    """Raise ConfigError unless ``robot`` is one that the task can place."""
    known = ", ".join(map(repr, supported))
    _require(robot in supported, task, f"robot_uids must be one of {known}, not {robot!r}")


def _require(holds: bool, task: str, words: str) -> None:
    """Raise ConfigError, with words on what the task wants, unless it holds."""
    if not holds:
        raise ConfigError(f"{task}: {words}")


def check_number(task: str, num_envs: int, sim_backend: str) -> bool:
    """Tell whether the simulation runs on a GPU; ConfigError for several environments on a CPU."""
    on_gpu = "cuda" in sim_backend or "gpu" in sim_backend
    on_gpu = on_gpu or (sim_backend == "auto" and num_envs > 1)
    makers = "asset_factory.envs.make_processes or gymnasium.vector.AsyncVectorEnv"
    advice = f"run several as processes, with {makers}"
    asked = f"with sim_backend {sim_backend!r}"
    single = f"num_envs must be 1 {asked}, not {num_envs}; {advice}"
    _require(on_gpu or num_envs <= 1, task, single)
    if on_gpu:
        import torch

        words = f"num_envs is {num_envs} {asked}, and there is no CUDA device; "
        words += f"want num_envs=1 and sim_backend='physx_cpu', or {advice}"
        _require(torch.cuda.is_available(), task, words)
    return on_gpu


def words(value: str | Sequence[str] | None) -> tuple[str, ...]:
    """Return one word, several or none, as several."""
    return () if value is None else (value,) if isinstance(value, str) else tuple(value)


def common_types(task: str, asked: Sequence[str], known: Sequence[str]) -> tuple[str, ...]:
    """Return joint types that a user asked for and the task knows; empty stands for all of them.

    Raises:
        ConfigError: there are none.
    """
    if not asked or not known:
        return tuple(asked or known)
    types = tuple(kind for kind in asked if kind in known)
    must, given = (", ".join(map(repr, kinds)) for kinds in (known, asked))
    _require(bool(types), task, f"joint_type must be {must}, not {given}")
    return types


def check_range(task: str, name: str, bounds: tuple[float, float]) -> tuple[float, float]:
    """Return the bounds of a random factor. Raises ConfigError unless ``0 <= lower <= upper``."""
    lower, upper = (float(value) for value in bounds)
    words = f"{name} must be two finite numbers, 0 <= lower <= upper, not {tuple(bounds)}"
    _require(0.0 <= lower <= upper < float("inf"), task, words)
    return lower, upper


def check_share(task: str, name: str, value: float) -> float:
    """Return a share of a joint's range. Raises ConfigError unless it lies between 0 and 1."""
    words = f"{name} must be a share of the joint's range, 0 to 1, not {value}"
    _require(0.0 <= value <= 1.0, task, words)
    return float(value)


def choose_renderer(
    task: str, obs_mode: str, render_mode: str | None, render_backend: str | None
) -> str:
    """Return ManiSkill's ``render_backend``; ``auto`` is ``none`` without pictures, else ``gpu``.

    Raises:
        ConfigError: pictures are wanted and ``render_backend`` is ``none``.
    """
    pictures = obs_mode not in BLIND_MODES or render_mode is not None
    if render_backend == "auto":
        return "gpu" if pictures else "none"
    if render_backend in (None, "none"):
        words = f"{_picture_words(obs_mode, render_mode)} needs a renderer, and render_backend is "
        words += "'none'; want 'auto', 'gpu' or 'cpu', "
        words += f"or obs_mode {BLIND_MODES[0]!r} without render_mode"
        _require(not pictures, task, words)
        return "none"
    return str(render_backend)


@contextmanager
def needing_renderer(
    task: str, obs_mode: str, render_mode: str | None, backend: str
) -> Iterator[None]:
    """Raise ConfigError where SAPIEN finds nothing to render with, and is asked to."""
    try:
        yield
    except RuntimeError as error:
        if backend == "none" or not any(sign in str(error) for sign in NO_RENDERER_SIGNS):
            raise
        raise ConfigError(
            f"{task}: {_picture_words(obs_mode, render_mode)} needs Vulkan, "
            f"and none was found ({error}); install a GPU driver, or Mesa's software Vulkan "
            "(mesa-vulkan-drivers 25 or newer, and libvulkan1); "
            f"obs_mode {BLIND_MODES[0]!r} without render_mode works without"
        ) from error


def _picture_words(obs_mode: str, render_mode: str | None) -> str:
    blind = obs_mode in BLIND_MODES
    return f"render_mode {render_mode!r}" if blind else f"obs_mode {obs_mode!r}"
