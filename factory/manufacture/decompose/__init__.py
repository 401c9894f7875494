"""Convex decomposition: each part of an articulation becomes convex hulls that keep its cavities.

``decompose.py`` is the stage and ``part.py`` its order of attempts: convex solids stay whole,
boards are cut along their own faces, open surfaces become slabs, and only the rest goes down
the ladder to CoACD in a child process.
Nothing is imported here: the child starts faster for it.
"""
