"""A solved episode as a video."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .attempt import Attempt
from .solve import make_episodes, replay

#: Pictures per second; the tasks take as many control steps.
RATE = 20


def film(registry: str, attempt: Attempt, path: str) -> None:
    """Take an attempt's actions again before the task's camera, and write an MP4.

    Raises:
        ConfigError: nothing here can render; it names the missing package.
    """
    import imageio.v2 as imageio

    environment = make_episodes(registry, attempt.robot, render_mode="rgb_array")
    try:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        writer: Any = imageio.get_writer(path, fps=RATE, macro_block_size=8)
        with writer:
            replay(environment, attempt, lambda: writer.append_data(_picture(environment)))
    finally:
        environment.close()


def _picture(environment: Any) -> Any:
    return environment.render()[0].cpu().numpy()
