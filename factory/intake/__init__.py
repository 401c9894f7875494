"""Mesh intake: any mesh file becomes a :class:`Mesh` in metres, z up, or a rejection with a reason code."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from .mesh import Material, Mesh, Texture, concatenate

if TYPE_CHECKING:
    from .discover import find_inputs
    from .intake import Intake, Provenance
    from .loading import Visual, load_mesh, load_visual

__all__ = [
    "Intake",
    "Material",
    "Mesh",
    "Provenance",
    "Texture",
    "Visual",
    "concatenate",
    "find_inputs",
    "load_mesh",
    "load_visual",
]

# Articulations are built on Mesh, and an Intake may carry the annotation of one: resolved on first use,
# the two rooms import in either order.
_LATER = {
    "find_inputs": ".discover",
    "Intake": ".intake",
    "Provenance": ".intake",
    "Visual": ".loading",
    "load_mesh": ".loading",
    "load_visual": ".loading",
}


def __getattr__(name: str) -> object:
    if name in _LATER:
        return getattr(import_module(_LATER[name], __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
