"""The commands of ``factory``: one file each, with its flags, its help and what it does."""

from .commands import main, run

__all__ = ["main", "run"]
