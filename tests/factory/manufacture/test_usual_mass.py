"""An object weighs what is usual of its category, unless somebody says what it is made of."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.intake.categories import usual_of
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.manufacture.stage import manufacture
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store
from asset_factory.learn.objects import make_object


@pytest.fixture(scope="module")
def whole():
    return make_object("microwave", seed=1)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return tmp_path_factory.mktemp("masses")


def mass(whole, kept, **known):
    provenance = Provenance("thing.glb", "0" * 64, **known)
    intake = Intake("thing", whole.mesh, np.arange(len(whole.mesh.faces)), np.eye(4), provenance)
    asset, _ = manufacture(whole, Plan(), intake, Stages(BuildConfig(), Store(kept)))
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
