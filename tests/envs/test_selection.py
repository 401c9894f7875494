"""Filters and splits, and what they say when nothing is left."""

import json
from dataclasses import replace

import pytest
from export_samples import box, boxes_asset
from openable_samples import cabinet, oven, valve, write_registry

from asset_factory.envs.assets import read_registry
from asset_factory.envs.loading import warn_of_hulls
from asset_factory.envs.selection import Wanted, select, verdicts_of
from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.registry.entry import TEST_SHARE, split_of


@pytest.fixture
def assets(tmp_path):
    stone = boxes_asset([box([0, 0, 0], [1, 1, 1])], (), name="stone")
    read = read_registry(write_registry(tmp_path, cabinet(), oven(), valve(), stone))
    called = {key: "furniture" if key == "cabinet" else "other" for key in read}
    manifests = {key: replace(read[key].manifest, category=word) for key, word in called.items()}
    return {key: replace(asset, manifest=manifests[key]) for key, asset in read.items()}


def names(assets):
    return {key: [joint.name for joint in asset.openable] for key, asset in assets.items()}


@pytest.mark.parametrize(
    ("wanted", "left"),
    [
        # What cannot be moved is left out.
        (Wanted(), {"cabinet": ["hinge", "slide"], "oven": ["door"], "valve": ["wheel"]}),
        (Wanted(categories=("furniture",)), {"cabinet": ["hinge", "slide"]}),
        (Wanted(joint_types=("prismatic",)), {"cabinet": ["slide"]}),
        (
            Wanted(joint_types=("revolute", "continuous"), min_lever=0.3),
            {"cabinet": ["hinge"], "oven": ["door"]},
        ),
        (Wanted(asset="oven"), {"oven": ["door"]}),
        (Wanted(joint="door"), {"oven": ["door"]}),
    ],
)
def test_a_filter_keeps_what_passes_it(assets, wanted, left):
    assert names(select(assets, wanted)) == left


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        (
            Wanted(asset="fridge"),
            "no asset 'fridge' in the registry; there are 'cabinet', 'oven', 'stone', 'valve'",
        ),
        (
            Wanted(asset="stone"),
            "asset 'stone': no joint to move; assets with one: 'cabinet', 'oven', 'valve'",
        ),
        (
            Wanted(categories=("car",)),
            "4 assets: none with category 'car'; there are 'furniture', 'other'",
        ),
        (
            Wanted(asset="oven", joint_types=("prismatic",)),
            "asset 'oven': no prismatic joint to move; there are 'revolute' joints; "
            "assets with one: 'cabinet'",
        ),
        (
            Wanted(joint="lid"),
            "4 assets: no joint 'lid' to move; there are 'door', 'hinge', 'slide', 'wheel'",
        ),
        (Wanted(verdict="clean"), "4 assets: none with verdict 'clean'; there are 'passed'"),
    ],
)
def test_an_empty_choice_names_what_there_is(assets, wanted, message):
    with pytest.raises(RegistryError, match=message):
        select(assets, wanted)


@pytest.mark.parametrize(
    "filters", [{"split": "val"}, {"verdict": "good"}, {"joint_types": ("planar",)}]
)
def test_a_filter_that_means_nothing_is_refused_with_those_that_do(filters):
    with pytest.raises(ConfigError, match="must be one of"):
        Wanted(**filters)


def test_an_assets_split_never_changes_and_about_a_fifth_is_for_testing():
    ids = [f"asset-{number}" for number in range(2000)]
    share = sum(split_of(name) == "test" for name in ids) / len(ids)
    assert share == pytest.approx(TEST_SHARE, abs=0.03)
    # Written down: another rule would move assets that somebody has trained on.
    expected = ["train", "test", "train", "train", "test", "train"]
    assert [split_of(name) for name in ids[:6]] == expected


def test_the_two_splits_share_nothing_and_leave_nothing_out(assets):
    sides = []
    for split in ("train", "test"):
        try:
            sides.append(set(select(assets, Wanted(split=split))))
        except RegistryError:
            sides.append(set())
    assert not sides[0] & sides[1]
    assert sides[0] | sides[1] == set(select(assets, Wanted()))


def test_an_asset_judged_without_a_finding_is_clean(assets):
    asset = assets["oven"]
    assert verdicts_of(asset) == ("passed",)
    for findings, verdicts in (([], ("passed", "clean")), ([{"code": "x"}], ("passed",))):
        report = {"passed": True, "findings": findings}
        (asset.folder / "report.json").write_text(json.dumps(report))
        assert verdicts_of(asset) == verdicts


def test_hulls_that_a_gpu_does_not_take_are_told_as_the_validator_found_them(assets, recwarn):
    for name, code in (("oven", "oblong_hull"), ("cabinet", "low_mass")):
        report = {"passed": True, "findings": [{"code": code}]}
        (assets[name].folder / "report.json").write_text(json.dumps(report))
    warn_of_hulls(assets[name] for name in sorted(assets) if name != "oven")
    assert not recwarn
    with pytest.warns(UserWarning, match=f"1 of {len(assets)} assets have hulls.* is 'oven'"):
        warn_of_hulls(assets.values())
