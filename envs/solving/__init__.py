"""Whether a robot opens what was registered: scripted episodes of the tasks.

``docs/solving.md`` describes how.
"""

from .attempt import REASONS, Attempt
from .solve import make_episodes, replay, solve_joint

__all__ = ["REASONS", "Attempt", "make_episodes", "replay", "solve_joint"]
