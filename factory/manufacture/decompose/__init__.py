"""Convex decomposition: each part of an articulation becomes convex hulls that keep its cavities.

``decompose.py`` is the stage and ``part.py`` its order of attempts: what is convex stays whole,
boards are cut along their own faces, open surfaces become slabs, and only what is left goes down
the ladder to CoACD in a child process.
Nothing is imported here: the child starts faster for it.
"""
