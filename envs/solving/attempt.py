"""What came of trying to open a joint."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

#: What says how an episode is solved, for keys of what came of it.
SOLVER = ("asset_factory.envs.solving", "asset_factory.envs.tasks")


@dataclass(frozen=True)
class Attempt:
    """One episode in which a robot tried to open a joint; the best of several attempts.

    ``actions`` from ``reset(seed=seed, options=options)`` in the environment that ``make_episodes``
    makes give exactly this episode again; ``replay`` does so.

    Attributes:
        asset, digest: which asset, and the SHA-256 of its manifest.
        joint, robot: the joint to open, and the robot that tried.
        seed: of the reset, as :attr:`options` are.
        solved: the task's own ``success`` was true after the last action.
        reason, message: why not, a code of ``docs/solving.md`` and a sentence with a number; empty
            when solved.
        open_fraction: of the joint's range, at the end.
        peak_force, mean_force: that the wrist carries while the robot touches the object [N]; the
            peak is the greatest mean over a quarter of a second.
        steps: control steps taken.
        target: number of the asset's interaction target that was used first; -1 for a place found
            on its surface.
        kinds: how it was held, one after the other: ``grasp``, ``push``, ``drag``.
        tries: episodes it took.
        actions: float32, shape [steps, action].
        seconds: wall-clock time [s], of all tries.
    """

    asset: str
    digest: str
    joint: str
    robot: str
    seed: int
    solved: bool
    reason: str = ""
    message: str = ""
    open_fraction: float = 0.0
    peak_force: float = 0.0
    mean_force: float = 0.0
    target: int = -1
    kinds: tuple[str, ...] = ()
    tries: int = 0
    actions: npt.NDArray[np.float32] = field(
        default_factory=lambda: np.zeros((0, 0), np.float32), repr=False, compare=False
    )
    seconds: float = 0.0

    @property
    def options(self) -> dict[str, Any]:
        """Return the options of the reset; a rebuilt scene keeps nothing of an earlier episode."""
        return {"asset": self.asset, "joint": self.joint, "reconfigure": True}

    @property
    def steps(self) -> int:
        """Control steps taken."""
        return len(self.actions)
