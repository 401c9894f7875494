"""What the tasks read from a registry, and what is refused as altered since; no simulator."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from openable_samples import cabinet, oven, valve, write_registry

from asset_factory.envs.assets import check_unaltered, read_registry
from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry.report_file import file_digests


def edited(registry, asset, change):
    """The registry, after ``change`` was applied to an asset's manifest."""
    path = registry / "assets" / asset / "asset.json"
    data = json.loads(path.read_text())
    change(data)
    path.write_text(json.dumps(data))
    return registry


def test_every_asset_is_read_in_order_of_id_with_its_joints(tmp_path):
    read = read_registry(write_registry(tmp_path, oven(), cabinet(), valve()))
    assert list(read) == ["cabinet", "oven", "valve"]
    assert [joint.name for joint in read["cabinet"].openable] == ["hinge", "slide"]
    assert read["cabinet"].urdf.is_file()
    # One without end gets a quarter turn.
    wheel = read["valve"].joint("wheel")
    assert (wheel.lower, wheel.upper) == (0.0, np.pi / 2)
    # A lever is the distance of the hold from the axis.
    assert read["cabinet"].joint("hinge").lever == pytest.approx(np.hypot(0.5, 0.04))
    assert read["cabinet"].joint("slide").lever == 0.0
    assert wheel.lever == pytest.approx(0.1)


@pytest.mark.parametrize("ends", [(0.0, float("inf")), (0.0, None), (0.3, 0.0)])
def test_a_joint_with_impossible_limits_is_no_target_and_says_why(tmp_path, ends):
    def change(data):
        data["joints"][1]["lower"], data["joints"][1]["upper"] = ends

    asset = read_registry(edited(write_registry(tmp_path, cabinet()), "cabinet", change))["cabinet"]
    assert [joint.name for joint in asset.openable] == ["hinge"]
    told = r"no joint 'slide' to open \(its limits are .*finite.*there are 'hinge'"
    with pytest.raises(RegistryError, match=told):
        asset.joint("slide")


def test_the_surest_interaction_target_is_held_rather_than_the_handle(tmp_path):
    def change(data):
        grasp = {"joint": "slide", "part": "part_2", "kind": "grasp", "opening_m": 0.03}
        grasp |= {"fingers": [1, 0, 0], "normal": [0, -1, 0], "pull": [0, -1, 0]}
        scores = {0.1: 0.4, 0.2: 0.9, 0.3: 0.1}
        data["targets"] = [
            grasp | {"point": [x, -0.01, 0.1], "score": score} for x, score in scores.items()
        ]

    asset = read_registry(edited(write_registry(tmp_path, cabinet()), "cabinet", change))["cabinet"]
    slide = asset.joint("slide")
    assert slide.point.tolist() == [0.2, -0.01, 0.1]
    assert np.allclose(slide.rest_point, [0.2, -0.222, 0.75])
    assert slide.handle_link == "part_2"


def test_what_is_no_registry_and_a_damaged_manifest_are_told(tmp_path):
    with pytest.raises(RegistryError, match="no registry here"):
        read_registry(tmp_path)
    (tmp_path / "assets").mkdir()
    with pytest.raises(RegistryError, match="a registry without assets"):
        read_registry(tmp_path)
    registry = write_registry(tmp_path, oven())
    (registry / "assets/oven/asset.json").write_text(json.dumps({"joints": []}))
    with pytest.raises(RegistryError, match=r"oven.asset\.json: not a manifest.*missing"):
        read_registry(registry)


def spoil(path):
    path.write_text(path.read_text().replace("v ", "v 1", 1))


def extend(path):
    path.write_text(path.read_text() + " ")


@pytest.mark.parametrize(
    ("place", "change", "told"),
    [
        (".", shutil.rmtree, r"'oven': .*asset\.json is gone.*there are 'cabinet'"),
        ("asset.json", extend, r"asset\.json changed since the registry was read"),
        ("meshes/collision/{hull}", spoil, "{hull}' not as registered"),
        ("meshes/collision/{hull}", Path.unlink, "{hull}' not as registered"),
        ("meshes/collision/more.obj", Path.touch, "more.obj' not as registered"),
    ],
)
def test_what_is_not_as_registered_or_gone_is_named(tmp_path, place, change, told):
    asset = read_registry(write_registry(tmp_path, cabinet(), oven()))["oven"]
    check_unaltered(asset)
    (asset.folder / "report.json").write_text(json.dumps({"files": file_digests(asset.folder)}))
    check_unaltered(asset)
    hull = sorted(path.name for path in (asset.folder / "meshes/collision").iterdir())[0]
    change(asset.folder / place.format(hull=hull))
    with pytest.raises(RegistryError, match=told.format(hull=hull)):
        check_unaltered(asset)
