"""The transformer itself. Its modules load torch; ``shape`` alone does not."""
