"""Sides of an object: seams, handles, knobs; cuts along them, and how what they bound opens."""
