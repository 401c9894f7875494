"""A small labelled skin through the whole pipeline, a simulator included."""

import json

import pytest
from labelled_skins import cupboard

from asset_factory.factory.build import make_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.learn.objects import write_sample
from asset_factory.sim_checks.judge import Judge

CONFIG = BuildConfig(simulators=("mujoco",))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("skin")
    write_sample(cupboard(), folder)
    source = folder / "object.glb"
    with Judge(CONFIG.checks) as judge:
        staging = tmp_path_factory.mktemp("staging")
        cache = tmp_path_factory.mktemp("cache")
        first = make_asset(source, staging, CONFIG, cache, judge)
        again = make_asset(source, tmp_path_factory.mktemp("again"), CONFIG, cache, judge)
    return first, again


def test_it_passes_and_says_what_was_invented(made):
    product, _ = made
    assert product.entry.status == "passed", product.told.report.findings
    manifest = json.loads((product.bundle / "asset.json").read_text())
    assert {link["decomposition"] for link in manifest["links"]} == {"built"}
    invented = manifest["invented"]
    assert {"hollow", "slab back", "rim", "frame"} <= {each["kind"] for each in invented}
    for each in invented:
        assert set(each) == {"part", "kind", "rule", "thickness_m", "depth_m"}


def test_it_is_kept(made):
    product, again = made
    assert "solids" in product.done
    assert again.done == ()
    assert "solids" in again.result.reused
