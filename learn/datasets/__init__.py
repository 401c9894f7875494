"""Readers of articulated datasets: each object becomes a sample, or is skipped with a reason."""

from .cache import Prepared, prepare
from .report import SourceReport
from .settings import SourceSettings

__all__ = ["Prepared", "SourceReport", "SourceSettings", "prepare"]
