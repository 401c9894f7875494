"""Convex decomposition: each part of an articulation becomes convex hulls that keep its cavities.

``decompose.py`` is the stage, ``overlap.py`` and ``trim.py`` are what the repair loop asks about its result.
Nothing is imported here: the child process that runs CoACD starts faster for it.
"""
