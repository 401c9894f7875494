"""Exports taken into a registry.

Nothing of them is trusted, and all of one is checked before any of it is published.
"""

from .taking import TakenIn, import_export
from .unpacking import ImportLimits

__all__ = ["ImportLimits", "TakenIn", "import_export"]
