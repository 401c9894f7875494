"""Mesh -> Articulation: one file per articulator, behind one Protocol."""
