"""Validation: any URDF or MJCF in, a :class:`Report` of findings out.

Knows files, not the factory's types.
"""

from .judge import Judge, run_checks
from .report import Disagreement, Finding, Report, Severity, Status

__all__ = ["Disagreement", "Finding", "Judge", "Report", "Severity", "Status", "run_checks"]
