"""Where robots take hold of what moves, and where they stand to do so: found in the geometry alone."""
