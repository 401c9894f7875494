"""An asset of many hulls has them joined, and says of which parts, unless it is to fit closely."""

from dataclasses import replace

from manufactured import manufactured
from refusing import refusal

from asset_factory.factory.config import BuildConfig, DecomposeConfig, HullsConfig
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.learn.objects import make_object


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
    found = refusal(manufactured, make_object("fan", seed=3), kept, Plan(), config)
    assert (found.code, found.limit) == ("too_many_hulls", 4.0)
    assert found.value > 4.0
