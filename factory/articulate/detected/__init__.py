"""Parts that a trained network sees on the sides of an object."""
