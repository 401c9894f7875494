"""An asset of too many hulls gets fewer, around the same geometry, and says so."""

import numpy as np
import trimesh

from asset_factory.factory.asset import Hull
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.manufacture.decompose.convex import uncovered
from asset_factory.factory.manufacture.decompose.decompose import PartHulls
from asset_factory.factory.manufacture.decompose.fewer import fewer
from asset_factory.factory.runtime.store import Store

CONFIG = BuildConfig()


def comb(teeth, gap_m):
    """Bars of 20 mm side by side, so far apart."""
    hulls = []
    for number in range(teeth):
        made = trimesh.creation.box((0.02, 0.02, 0.3))
        shift = [number * (0.02 + gap_m), 0, 0]
        hulls.append(Hull(np.asarray(made.vertices) + shift, np.asarray(made.faces)))
    return PartHulls(tuple(hulls), "exact", (), True)


def test_few_hulls_stay_as_they_are():
    pieces = (comb(10, 0.012), comb(3, 0.012))
    assert fewer(pieces, 13, CONFIG) == pieces


def test_too_many_are_joined_where_most_are_and_told():
    # Slots of 12 mm: filled from an error of 6 mm on.
    pieces = (comb(10, 0.012), comb(3, 0.012))
    many, few = fewer(pieces, 8, CONFIG)
    assert few is pieces[1]
    assert len(many.hulls) < 5
    assert not many.exact
    assert "10 hulls joined to" in many.degraded[0]
    corners = np.concatenate([hull.vertices for hull in pieces[0].hulls])
    assert uncovered(many.hulls, corners) < 1e-9


def test_what_would_fill_too_much_stays_open(tmp_path):
    # Slots of 100 mm are no matter of a few millimetres.
    pieces = (comb(10, 0.1),)
    store = Store(tmp_path)
    first = fewer(pieces, 4, CONFIG, store)
    assert len(first[0].hulls) == 10
    again = fewer(pieces, 4, CONFIG, store)
    assert again[0].degraded == first[0].degraded
