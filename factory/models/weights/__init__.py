"""Checkpoints: where they come from, what they hold, and reading them without running them."""
