"""A scene moves as the asset's own articulation says, and comes back from its GLB unchanged."""

import io
import json
import struct
from dataclasses import fields, replace

import numpy as np
import pytest
import trimesh
from export_samples import box, boxes_asset, cabinet, hull_of, image

from asset_factory.factory.display.glb import KEYS, glb_of, scene_from
from asset_factory.factory.display.made import scene_of
from asset_factory.factory.display.scene import SceneGraph, SceneJoint
from asset_factory.factory.mesh import Material

TEXTURED = Material("oak", (1.0, 0.9, 0.8, 1.0), image((120, 80, 40)))


@pytest.fixture(scope="module")
def scene():
    return scene_of(cabinet((TEXTURED, Material("red", (0.8, 0.1, 0.1, 1.0)), TEXTURED)))


def test_links_are_where_the_articulation_puts_them(scene):
    articulation = cabinet().articulation
    for values in ({}, {"hinge": 1.2}, {"hinge": 0.4, "slide": 0.2}):
        poses = scene.poses(values)
        for part, motion in enumerate(articulation.poses(values)):
            frame = np.append(articulation.link_frame(part), 1.0)
            assert np.allclose(poses[part][:3, 3], (motion @ frame)[:3])
            assert np.allclose(poses[part][:3, :3], motion[:3, :3])


def test_a_glb_says_the_whole_scene(scene):
    again = scene_from(glb_of(scene))
    assert (again.name, again.links) == (scene.name, scene.links)
    assert (len(scene.visuals), len(scene.hulls), len(again.hulls)) == (3, 4, 4)
    surfaces = [(*each.visuals, *each.hulls) for each in (scene, again)]
    for before, after in zip(*surfaces, strict=True):
        for field in fields(before):
            one, other = getattr(before, field.name), getattr(after, field.name)
            if isinstance(one, np.ndarray):
                assert np.allclose(one, other, atol=1e-7)
            elif field.name != "color":
                assert one == other
    assert again.poses({"hinge": 1.0}) == pytest.approx(scene.poses({"hinge": 1.0}))
    assert glb_of(scene) == glb_of(scene)
    assert glb_of(again) == glb_of(scene)


def test_hulls_that_repairs_replaced_are_shown_where_they_rested():
    before = cabinet()
    thinner = hull_of(box([0.0, -0.21, 0.25], [0.56, 0.016, 0.46]))
    bodies = list(before.bodies)
    bodies[1] = replace(bodies[1], hulls=(thinner, *bodies[1].hulls[1:]))
    scene = scene_of(replace(before, bodies=tuple(bodies)), before)
    (gone,) = scene.replaced
    frame = before.articulation.link_frame(1)
    assert gone.link == 1
    assert gone.vertices + frame == pytest.approx(before.bodies[1].hulls[0].vertices, abs=1e-6)
    assert len(scene.hulls) == 4
    again = scene_from(glb_of(scene))
    assert len(again.replaced) == 1
    assert np.array_equal(again.replaced[0].vertices, gone.vertices)
    assert glb_of(again) == glb_of(scene)


def test_a_part_that_is_no_more_leaves_its_hulls_on_the_root():
    before = cabinet()
    whole = boxes_asset([box([0.0, 0.0, 0.4], [0.6, 0.4, 0.8])], ())
    scene = scene_of(whole, before)
    assert {surface.link for surface in scene.replaced} == {0}
    low = min(surface.vertices[:, 1].min() for surface in scene.replaced)
    assert low + whole.articulation.link_frame(0)[1] == pytest.approx(-0.252, abs=1e-6)


def test_other_readers_see_the_same_object(scene):
    low, high = trimesh.load_scene(io.BytesIO(glb_of(scene)), file_type="glb").bounds
    # A reader that has y up sees the height of 0.8 m there.
    assert high - low == pytest.approx([0.6, 0.8, 0.452], abs=1e-6)


def test_the_animation_turns_and_slides_links_about_their_joints(scene):
    data = glb_of(scene)
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    (animation,) = document["animations"]
    targets = [each["target"] for each in animation["channels"]]
    paths = {(each["path"], document["nodes"][each["node"]]["name"]) for each in targets}
    assert paths == {("rotation", "part_1"), ("translation", "part_2")}
    assert all(document["accessors"][s["output"]]["count"] == KEYS for s in animation["samplers"])


def test_a_follower_goes_with_its_leader():
    pose = np.eye(4)
    axis = np.array([0.0, 0.0, 1.0])
    leader = SceneJoint("a", "revolute", 0, 1, pose, axis, 0.0, 1.0)
    follower = SceneJoint("b", "revolute", 0, 2, pose, axis, 0.0, 1.0, "a", -2.0, 0.1)
    scene = SceneGraph("pair", ("root", "one", "two"), (leader, follower), ())
    assert scene.completed({"a": 0.3}) == pytest.approx({"a": 0.3, "b": -0.5})
    assert set(scene.opened(1.0)) == {"a"}


@pytest.mark.parametrize("cut", [0, 3, 19, 40, 700])
def test_a_damaged_file_is_refused(scene, cut):
    with pytest.raises(ValueError, match=r"\w"):
        scene_from(glb_of(scene)[:cut])


def test_a_scene_is_a_tree():
    joint = SceneJoint("a", "fixed", 1, 0, np.eye(4), np.array([0.0, 0.0, 1.0]))
    with pytest.raises(ValueError, match="no tree"):
        SceneGraph("loop", ("root", "one"), (joint,), ())
    with pytest.raises(ValueError, match="hang on no joint"):
        SceneGraph("loose", ("root", "one"), (), ())
