"""What may be tried next: one file per repair."""
