"""An object weighs what is usual of its category, unless somebody says what it is made of."""

from dataclasses import replace

import pytest
from manufactured import manufactured

from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.intake.categories import usual_of
from asset_factory.learn.objects import make_object


@pytest.fixture(scope="module")
def whole():
    return make_object("microwave", seed=1)


def mass(whole, kept, **known):
    asset, *_ = manufactured(whole, kept, **known)
    return sum(body.inertial.mass for body in asset.bodies)


def test_it_weighs_what_is_usual_of_its_category(whole, kept):
    box = closed(whole).mesh.extents.prod()
    want = usual_of("microwave").bulk * box
    assert mass(whole, kept, category="microwave") == pytest.approx(want)
    seen = replace(whole, looks_like="microwave")
    assert mass(seen, kept) == pytest.approx(want)
    assert mass(seen, kept, category="cabinet") == pytest.approx(mass(whole, kept))


def test_a_stated_density_counts_for_more(whole, kept):
    plain = mass(whole, kept)
    stated = mass(whole, kept, category="microwave", density=1300.0)
    assert stated == pytest.approx(2.0 * plain, rel=0.01)
