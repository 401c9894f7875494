"""Bodies for parts that have none: panels, hollows, drawers and lids, convex as they are made.

``skin.py`` says which parts are patches of a skin, ``plates.py`` which are fronts with nothing
behind them; ``build.py`` is the step. ``views.py`` and ``lattice.py`` look at the skin,
``panel.py`` and ``bump.py`` say what a part is, ``cavity.py`` what is hollow behind it,
``pieces.py`` cuts ``matter.py`` into convex pieces, ``seam.py`` and ``surfaces.py`` make what is
seen.
"""
