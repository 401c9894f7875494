"""The trainer of the articulation network."""
