"""Where robots hold moving parts, and where they stand for it: by geometry alone."""
