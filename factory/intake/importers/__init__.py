"""Existing descriptions, lifted: a URDF or MJCF file becomes a mesh with an annotation."""

from .load import load_description
from .prediction import read_prediction

__all__ = ["load_description", "read_prediction"]
