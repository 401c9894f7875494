"""Asset -> Bundle: a folder that simulators can open."""

from .bundle import Bundle, export_bundle

__all__ = ["Bundle", "export_bundle"]
