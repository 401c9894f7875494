"""Readers of articulated datasets: each object becomes a sample, or is skipped with a reason."""

from .cache import prepare
from .report import SourceReport
from .settings import SourceSettings

__all__ = ["SourceReport", "SourceSettings", "prepare"]
