"""PartField's encoder: a feature for every point that tells parts apart. Its modules load torch; ``shape`` does not."""
