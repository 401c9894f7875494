"""Where links and hulls are, and where robots are put; no simulator."""

import numpy as np
import pytest
from export_samples import frames
from hypothesis import given
from hypothesis import strategies as st
from openable_samples import cabinet, oven, train, valve, write_registry

from asset_factory.envs.assets import read_registry
from asset_factory.envs.geometry import carried_links, handle_path, hull_boxes, links_of
from asset_factory.envs.placement import MARGIN, find_place
from asset_factory.envs.robots import ROBOTS


@pytest.fixture(scope="module")
def assets(tmp_path_factory):
    root = tmp_path_factory.mktemp("placement")
    return read_registry(write_registry(root, cabinet(lower=-0.1), oven(), valve(), train()))


@given(hinge=st.floats(0.0, 1.6), slide=st.floats(-0.1, 0.2))
def test_links_move_as_the_factorys_own_kinematics_say(assets, hinge, slide):
    values = {"hinge": hinge, "slide": slide}
    _, tree = links_of(assets["cabinet"])
    found = tree.link_poses(values)
    for name, pose in frames(cabinet(lower=-0.1).articulation, values).items():
        assert np.allclose(found[name], pose, atol=1e-8)


def test_boxes_are_those_of_the_hulls_standing_on_the_ground_and_move_with_their_joints(assets):
    boxes = hull_boxes(assets["cabinet"], {"slide": 0.1}, frozenset({"part_2"}))
    assert np.allclose(boxes, [[[-0.28, -0.322, 0.52], [0.28, -0.302, 0.78]]])
    train = assets["train"]
    assert carried_links(train, train.joint("rear")) == {"part_1"}
    assert carried_links(train, train.joint("front")) == {"part_2"}


def test_a_doors_handle_swings_about_its_hinge(assets):
    asset = assets["cabinet"]
    hinge = asset.joint("hinge")
    path = handle_path(asset, hinge, np.linspace(0.0, 1.0, 5))
    arms = np.linalg.norm((path - hinge.origin)[:, :2], axis=1)
    assert np.allclose(arms, arms[0])
    assert np.allclose(path[0], [0.22, -0.252, 0.25])


@pytest.mark.parametrize("robot", ["panda", "fetch"])
@pytest.mark.parametrize("start", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(
    ("name", "joint"), [("cabinet", "hinge"), ("cabinet", "slide"), ("oven", "door")]
)
def test_a_robot_stands_clear_within_reach_and_looks_at_the_handle(
    assets, robot, name, joint, start
):
    asset = assets[name]
    target = asset.joint(joint)
    place = find_place(asset, target, ROBOTS[robot], start=start, spread=0.1)
    handle = handle_path(asset, target, np.array([start]))[0]
    heading = np.array([np.cos(place.yaw), np.sin(place.yaw)])
    ahead = handle[:2] - place.position[:2]
    assert heading @ ahead == pytest.approx(float(np.linalg.norm(ahead)))
    assert place.clearance > MARGIN - 0.02
    assert place.stretch < 0.15
    assert place.position[2] == 0.0 or not ROBOTS[robot].mobile


def test_no_moving_part_reaches_the_base(assets):
    asset = assets["oven"]
    place = find_place(asset, asset.joint("door"), ROBOTS["fetch"])
    for value in np.linspace(0.0, 1.5, 20):
        (box,) = hull_boxes(asset, {"door": value}, frozenset({"part_1"}))
        nearest = np.clip(place.position[:2], box[0, :2], box[1, :2])
        assert np.linalg.norm(nearest - place.position[:2]) > ROBOTS["fetch"].body[0]
