"""What the tasks read from a registry, and where they put robots; no simulator."""

from __future__ import annotations

import json

import numpy as np
import pytest
from openable_samples import assemble, box, cabinet, oven, valve, write_registry

from asset_factory.factory.errors import RegistryError

pytest.importorskip("mani_skill", reason="mani_skill is not installed")
pytestmark = pytest.mark.filterwarnings("ignore:Failed to find system libvulkan:UserWarning")


@pytest.fixture
def assets():
    """The module under test; importing its package imports ManiSkill, which warns."""
    from asset_factory.envs import assets

    return assets


@pytest.fixture
def placement():
    from asset_factory.envs import placement

    return placement


def test_every_asset_with_a_joint_is_read_in_order_of_id(assets, tmp_path) -> None:
    registry = write_registry(tmp_path, oven(), cabinet(), valve())
    read = assets.read_registry(registry)
    assert list(read) == ["cabinet", "oven", "valve"]
    assert [joint.name for joint in read["cabinet"].openable] == ["hinge", "slide"]
    assert read["cabinet"].urdf.is_file()


def test_an_asset_without_joints_is_left_out(assets, tmp_path) -> None:
    registry = write_registry(tmp_path, oven(), assemble("stone", [box([0, 0, 0], [1, 1, 1])], (), {}))
    assert list(assets.read_registry(registry)) == ["oven"]


def test_a_joint_without_end_gets_a_quarter_turn(assets, tmp_path) -> None:
    wheel = assets.read_registry(write_registry(tmp_path, valve()))["valve"].joint("wheel")
    assert (wheel.lower, wheel.upper) == (0.0, np.pi / 2)


def test_no_registry_is_said_so(assets, tmp_path) -> None:
    with pytest.raises(RegistryError, match="no registry here"):
        assets.read_registry(tmp_path)


def test_a_registry_with_nothing_to_open_is_said_so(assets, tmp_path) -> None:
    (tmp_path / "assets").mkdir()
    with pytest.raises(RegistryError, match="0 assets, none with a joint to open"):
        assets.read_registry(tmp_path)


def test_a_damaged_manifest_is_named(assets, tmp_path) -> None:
    registry = write_registry(tmp_path, oven())
    (registry / "assets/oven/asset.json").write_text(json.dumps({"joints": []}))
    with pytest.raises(RegistryError, match=r"oven.asset\.json: not a manifest.*urdf"):
        assets.read_registry(registry)


def test_an_unknown_asset_or_joint_lists_what_there_is(assets, tmp_path) -> None:
    read = assets.read_registry(write_registry(tmp_path, oven(), cabinet()))
    with pytest.raises(RegistryError, match="no asset 'fridge' to open; there are 'cabinet', 'oven'"):
        assets.select_assets(read, "fridge", None)
    with pytest.raises(RegistryError, match="asset 'cabinet': no joint 'lid' to open; there are 'hinge', 'slide'"):
        read["cabinet"].joint("lid")
    with pytest.raises(RegistryError, match="2 assets: no joint 'lid' to open; there are 'door', 'hinge', 'slide'"):
        assets.select_assets(read, None, "lid")


def test_a_joint_name_alone_selects_the_assets_that_have_it(assets, tmp_path) -> None:
    read = assets.read_registry(write_registry(tmp_path, oven(), cabinet()))
    assert list(assets.select_assets(read, None, "door")) == ["oven"]


def test_a_robot_stands_where_the_handle_is_pulled_to_and_looks_at_it(placement) -> None:
    bounds = np.array([[-0.3, -0.25, 0.0], [0.3, 0.2, 0.8]])
    point, front = np.array([0.2, -0.25, 0.6]), np.array([0.0, -1.0, 0.0])
    direction = placement.facing_direction(point, front, front, bounds)
    place, yaw = placement.standing_place(point, direction, bounds, reach=0.6, mobile=False)
    assert np.allclose(place, [0.2, -0.25 - 0.72, 0.25])
    heading = np.array([np.cos(yaw), np.sin(yaw)])
    assert np.allclose(heading, [0.0, 1.0])


def test_a_lid_pulled_upward_is_approached_from_where_its_handle_faces(placement) -> None:
    bounds = np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]])
    up, side = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    assert np.allclose(placement.facing_direction(np.array([1.0, 0.0, 1.0]), up, side, bounds), side)
    assert np.allclose(placement.facing_direction(np.array([0.0, 1.0, 1.0]), up, up, bounds), [0.0, 1.0, 0.0])


def test_a_robot_never_stands_inside_the_object(placement) -> None:
    bounds = np.array([[-2.0, -2.0, 0.0], [2.0, 2.0, 1.0]])
    front = np.array([0.0, -1.0, 0.0])
    for mobile in (False, True):
        place, _ = placement.standing_place(np.zeros(3), front, bounds, reach=0.6, mobile=mobile)
        assert place[1] <= -2.2 + 1e-9
