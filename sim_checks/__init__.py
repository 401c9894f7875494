"""JUDGES: any URDF or MJCF in, a :class:`Report` of findings out. Knows files, not the factory's types."""

from .report import Finding, Report, Severity

__all__ = ["Finding", "Report", "Severity"]
