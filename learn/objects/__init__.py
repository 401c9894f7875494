"""A procedural generator of household objects with exact ground truth."""

from ..surfaces import artist_like, fused_like
from .catalog import CATEGORIES, make_object
from .export import write_sample
from .mixture import MixtureSettings, sample_object

__all__ = [
    "CATEGORIES", "MixtureSettings", "artist_like", "fused_like", "make_object", "sample_object",
    "write_sample",
]  # fmt: skip
