"""Whether a robot opens registered assets: scripted episodes of the tasks.

``docs/solving.md`` describes how.
"""

from __future__ import annotations

from .attempt import Attempt
from .solve import make_episodes, replay, solve_joint

__all__ = ["Attempt", "make_episodes", "replay", "solve_joint"]
