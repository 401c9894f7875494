"""Exports taken into a registry.

Nothing of them is trusted, and all of one is checked before any of it is published.
"""

from .taking import TakenIn, import_export

__all__ = ["TakenIn", "import_export"]
