"""PartField's encoder: a feature per point that tells parts apart; all but ``shape`` load torch."""
