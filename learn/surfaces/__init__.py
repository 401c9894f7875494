"""Characters: the same labelled object with the surface that files of a certain origin have."""

from .artist import artist_like, stretched
from .fused import fused_like
from .skins import coloured_skin, skin_like

__all__ = ["artist_like", "coloured_skin", "fused_like", "skin_like", "stretched"]
