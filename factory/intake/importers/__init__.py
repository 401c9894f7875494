"""Inputs with joints of their own: URDF, MJCF and prediction files as annotated meshes."""
