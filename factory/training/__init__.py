"""Training data and, one day, the trainer."""
