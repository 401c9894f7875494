"""A procedural generator of household objects with exact ground truth."""

from .catalog import CATEGORIES, make_object
from .examples import write_example_meshes
from .generated import generated_like

__all__ = ["CATEGORIES", "generated_like", "make_object", "write_example_meshes"]
