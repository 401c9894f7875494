"""Articulation -> Asset: convex hulls, inertias, handles, and targets for robots."""
