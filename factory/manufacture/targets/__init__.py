"""Where robots take hold of what moves, and where they stand for it: by geometry alone."""
