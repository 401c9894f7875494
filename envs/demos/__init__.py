"""Demonstrations: what the scripted robot did, in ManiSkill's layout.

``docs/demonstrations.md`` describes how they are made.
"""

from .episodes import VERSION, Episode, Settings, Shard, Taken

__all__ = ["VERSION", "Episode", "Settings", "Shard", "Taken"]
