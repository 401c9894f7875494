"""An asset of many hulls gets fewer, around the same geometry, and says of which parts."""

from dataclasses import replace

import numpy as np
from manufactured import manufactured
from plain_solids import sized_hull
from refusing import refusal

from asset_factory.factory.config import BuildConfig, DecomposeConfig, HullsConfig
from asset_factory.factory.manufacture.decompose.fewer import fewer
from asset_factory.factory.manufacture.decompose.outside import uncovered
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.manufacture.decompose.room import NOWHERE
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store
from asset_factory.learn.objects import make_object


def joined(pieces, most, coarsest, store=None):
    hulls = HullsConfig(wanted=most, most=most, coarsest=coarsest)
    return fewer(pieces, hulls, Stages(BuildConfig(), store), lambda part: NOWHERE)


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


def made(kept, wanted, plan, most=10_000):
    config = replace(BuildConfig(), hulls=HullsConfig(wanted=wanted, most=most))
    asset, findings, _ = manufactured(make_object("fan", seed=3), kept, plan, config)
    return asset, [each for each in findings if each.code == "hulls_joined"]


def test_parts_of_many_hulls_are_joined_and_named(kept):
    plain, nothing = made(kept, 10_000, Plan())
    joined, told = made(kept, 8, Plan())
    assert not nothing
    assert joined.hull_count < plain.hull_count
    both = zip(plain.articulation.parts, plain.bodies, joined.bodies, strict=True)
    fewer = {part.name for part, had, has in both if len(has.hulls) < len(had.hulls)}
    assert {part for each in told for part in each.parts} == fewer
    assert all(each.message.endswith(("of 7.5 mm", "of 10 mm")) for each in told)


def test_hulls_that_are_to_fit_closely_stay_as_they_are(kept):
    plain, _ = made(kept, 10_000, Plan())
    closely, told = made(kept, 8, Plan(closely=True))
    assert not told
    assert closely.hull_count == plain.hull_count


def test_an_asset_that_still_has_too_many_is_joined_further_at_once(kept):
    gently, _ = made(kept, 8, Plan())
    further, told = made(kept, 8, Plan(), most=8)
    assert further.hull_count < gently.hull_count
    assert max(float(each.message.split()[-2]) for each in told) > 10.0


def test_a_part_that_still_needs_too_many_hulls_rejects_with_the_numbers(kept):
    config = BuildConfig(decompose=DecomposeConfig(max_hulls=4))
    found = refusal(manufactured, make_object("fan", seed=3), kept, Plan(), config).finding
    assert (found.code, found.limit) == ("too_many_hulls", 4.0)
    assert found.value > 4.0
