"""What comes with joints of its own: a URDF, an MJCF or a prediction file becomes a mesh with an annotation."""
