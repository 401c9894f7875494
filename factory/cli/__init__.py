"""What can be typed after ``factory``: one command per file, its flags, its help and what it does."""

from .main import main, run

__all__ = ["main", "run"]
