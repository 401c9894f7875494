"""Demonstrations: what the scripted robot did, in ManiSkill's layout. ``docs/demonstrations.md`` tells how."""

from __future__ import annotations

from .episodes import VERSION, Episode, Settings, Shard, Taken

__all__ = ["VERSION", "Episode", "Settings", "Shard", "Taken"]
