"""An asset of many hulls gets fewer, around the same geometry."""

import numpy as np
from plain_solids import sized_hull

from asset_factory.factory.config import BuildConfig, HullsConfig
from asset_factory.factory.manufacture.decompose.fewer import fewer
from asset_factory.factory.manufacture.decompose.outside import uncovered
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store


def joined(pieces, most, coarsest, store=None):
    hulls = HullsConfig(wanted=most, most=most, coarsest=coarsest)
    return fewer(pieces, hulls, Stages(BuildConfig(), store))


def comb(teeth, gap_m):
    """Bars of 20 mm side by side, so far apart."""
    pitch = 0.02 + gap_m
    hulls = [sized_hull((0.02, 0.02, 0.3), (number * pitch, 0, 0)) for number in range(teeth)]
    return SolidPieces(tuple(hulls), "exact")


def test_few_hulls_stay_as_they_are():
    pieces = (comb(10, 0.012), comb(3, 0.012))
    assert joined(pieces, 13, 16.0) == (pieces, {})


def test_too_many_are_joined_where_most_are():
    # Slots of 12 mm: filled from an error of 6 mm on.
    pieces = (comb(10, 0.012), comb(3, 0.012))
    (many, few), errors_m = joined(pieces, 8, 16.0)
    assert errors_m == {0: 0.015}
    assert few is pieces[1]
    assert len(many.hulls) < 5
    corners = np.concatenate([hull.vertices for hull in pieces[0].hulls])
    assert uncovered(many.hulls, corners) < 1e-9


def test_what_would_fill_too_much_stays_open(tmp_path):
    # Slots of 100 mm are no matter of a few millimetres.
    pieces = (comb(10, 0.1),)
    store = Store(tmp_path)
    first, nothing = joined(pieces, 4, 16.0, store)
    assert not nothing
    assert len(first[0].hulls) == 10
    again, _ = joined(pieces, 4, 16.0, store)
    for one, other in zip(first[0].hulls, again[0].hulls, strict=True):
        assert one.vertices.tolist() == other.vertices.tolist()


def test_slots_stay_open_while_the_error_is_small_and_a_small_error_leaves_many():
    # Slots of 12 mm are wider than twice the decomposition's error.
    pieces = (comb(10, 0.012),)
    assert joined(pieces, 4, 2.0) == (pieces, {})
    assert len(joined(pieces, 4, 3.0)[0][0].hulls) < 10
    narrow = (comb(10, 0.008),)
    assert len(joined(narrow, 4, 2.0)[0][0].hulls) < 10
