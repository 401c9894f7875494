"""Mesh intake: any mesh file becomes a :class:`Mesh` in metres, z up, or a rejection with a reason code."""

from .mesh import Material, Mesh, Texture, concatenate

__all__ = ["Material", "Mesh", "Texture", "concatenate"]
