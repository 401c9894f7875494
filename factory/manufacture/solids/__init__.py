"""Bodies for parts that have none: panels, hollows, drawers and lids, convex as they are made.

``skin.py`` says which parts are patches of a one-piece mesh, or fronts with nothing behind them;
``build.py`` is the step. ``panel.py``, ``bump.py`` and ``lattice.py`` measure the mesh,
``cavity.py`` finds hollows behind a panel, ``pieces.py`` cuts ``matter.py`` into convex
pieces, ``seam.py`` and ``surfaces.py`` make visible surfaces.
"""
