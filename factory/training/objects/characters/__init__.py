"""Characters: the same labelled object with the surface that files of a certain origin have."""

from .artist import artist_like
from .fused import fused_like
from .placed import mirrored, stretched

__all__ = ["artist_like", "fused_like", "mirrored", "stretched"]
