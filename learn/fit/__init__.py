"""Fits the small networks that the maker ships: one command writes each, and its card."""
