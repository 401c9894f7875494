"""A procedural generator of household objects with exact ground truth."""
