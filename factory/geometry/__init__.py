"""What any step asks of a mesh: areas, components, cleaning, other poses of the same object."""
