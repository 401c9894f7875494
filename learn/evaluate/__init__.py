"""How well an articulator's answer agrees with the truth over the same mesh, per object set."""
