"""Models of an object: coloured surfaces, hulls and joints; as GLB, and as pictures."""
