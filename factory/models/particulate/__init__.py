"""The Part Articulation Transformer: points on a surface in, parts and how they move out."""
