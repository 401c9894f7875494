"""Demonstrations: what the scripted robot did, in ManiSkill's layout.

``docs/demonstrations.md`` describes how they are made.
"""

from __future__ import annotations

from .episodes import VERSION, Episode, Settings, Shard, Taken

__all__ = ["VERSION", "Episode", "Settings", "Shard", "Taken"]
