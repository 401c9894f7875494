"""Where to take hold: on the surface, and pulling there opens; makers' handles are the best."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from plain_solids import box, parted
from scipy.spatial.transform import Rotation
from target_worlds import BODY, HINGE, PANEL, PLAIN, SLIDE, world
from trimesh.triangles import closest_point

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.geometry.posing import rotated
from asset_factory.factory.manufacture.targets.find import find_targets
from asset_factory.factory.manufacture.targets.handles import find_handle
from asset_factory.factory.mesh import Material
from asset_factory.learn.objects import fused_like, make_object
from asset_factory.learn.objects.catalog import DEMO_CATEGORIES
from asset_factory.learn.objects.kinds import openings
from asset_factory.learn.objects.kit import casework

SEEDS = (0, 1, 2, 3)


def distance(triangles, point):
    """From the nearest of some triangles [m]."""
    near = closest_point(triangles, np.tile(point, (len(triangles), 1)))
    return float(np.linalg.norm(near - point, axis=1).min())


def check_target(articulation, joint):
    handle = find_handle(articulation, joint.child)
    mesh = articulation.part_mesh(joint.child)
    assert distance(mesh.vertices[mesh.faces], handle.point) < 1e-9
    assert np.linalg.norm(handle.normal) == pytest.approx(1.0)
    assert np.linalg.norm(handle.pull) == pytest.approx(1.0)
    step = 1e-6
    moved = joint.motion(step)[:3, :3] @ handle.point + joint.motion(step)[:3, 3]
    velocity = (moved - handle.point) / np.linalg.norm(moved - handle.point)
    np.testing.assert_allclose(velocity, handle.pull, atol=1e-4)
    assert np.isin(handle.faces, articulation.parts[joint.child].faces).all()


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("category", DEMO_CATEGORIES)
def test_every_moving_part_has_a_point_on_its_surface_where_pulling_opens(category, seed):
    articulation = make_object(category, seed)
    for joint in articulation.movable_joints:
        check_target(articulation, joint)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("category", ["cabinet", "fridge", "oven", "microwave", "dishwasher"])
def test_the_handles_of_doors_and_drawers_are_found(category, seed):
    articulation = make_object(category, seed)
    for joint in articulation.movable_joints:
        if "knob" in joint.name:
            continue
        handle = find_handle(articulation, joint.child)
        assert handle.source == "protrusion", joint.name
        assert handle.normal[1] < -0.9
        gripped = articulation.mesh.submesh(handle.faces)
        part = articulation.part_mesh(joint.child)
        assert gripped.bounds[0][1] == part.bounds[0][1]
        assert gripped.extents.max() < 0.85 * part.extents.max()
        assert gripped.extents[1] < 0.05


@pytest.mark.parametrize("category", ["laptop", "chest", "trash_can"])
def test_lids_are_taken_at_the_edge_far_from_the_hinge(category):
    articulation = make_object(category, 0)
    handle = find_handle(articulation, 1)
    assert handle.source == "far_edge"
    assert handle.point[1] < articulation.part_mesh(1).bounds[0][1] + 0.005
    assert abs(handle.point[0]) < 0.01
    assert handle.pull[2] > 0.9


def test_knobs_are_taken_at_their_rim():
    articulation = make_object("oven", 0)
    joint = articulation.joint("knob_0_joint")
    handle = find_handle(articulation, joint.child)
    assert handle.source == "rim"
    assert np.linalg.norm(np.cross(joint.axis, handle.point - joint.origin)) > 0.02


def test_handles_are_found_on_a_fused_surface():
    original = make_object("fridge", 0)
    articulation = fused_like(original, 0)
    for joint in articulation.movable_joints:
        check_target(articulation, joint)
        handle = find_handle(articulation, joint.child)
        wanted = find_handle(original, joint.child)
        assert handle.source == "protrusion"
        assert np.linalg.norm((handle.point - wanted.point)[[0, 1]]) < 0.02


def test_a_plain_door_is_taken_at_its_far_edge_and_a_plain_drawer_in_its_middle():
    """Where nothing sticks out the handle is the flat patch that is taken hold of."""
    articulation = world([PANEL])
    hinged = find_handle(articulation, 1)
    assert hinged.source == "far_edge"
    assert hinged.point[0] == pytest.approx(0.4)
    assert hinged.point[2] == pytest.approx(0.3)
    patch = articulation.mesh.submesh(hinged.faces)
    np.testing.assert_allclose(patch.bounds, [[0.4, -0.02, 0.0], [0.4, -0.003, 0.6]])
    sliding = find_handle(world([PANEL], SLIDE), 1)
    assert sliding.source == "front"
    np.testing.assert_allclose(sliding.point, [0.2, -0.02, 0.3], atol=1e-9)
    np.testing.assert_allclose(sliding.normal, [0.0, -1.0, 0.0], atol=1e-9)
    assert len(sliding.faces) == 2


def test_of_two_protrusions_the_one_far_from_the_hinge_is_the_handle():
    hinge = box((0.01, 0.05), (-0.06, -0.02), (0.5, 0.55), PLAIN)
    grip = box((0.35, 0.38), (-0.06, -0.02), (0.25, 0.35), PLAIN)
    handle = find_handle(world([PANEL, hinge, grip]), 1)
    assert handle.source == "protrusion"
    assert handle.point[0] > 0.34
    assert len(handle.faces) == 12


def test_a_handle_fixed_to_the_door_as_a_part_of_its_own_is_found():
    grip = box((0.35, 0.38), (-0.06, -0.02), (0.25, 0.35), PLAIN)
    fixed = Joint("f", JointKind.FIXED, 1, 2, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    articulation = parted({"body": [BODY], "front": [PANEL], "grip": [grip]}, HINGE, fixed)
    handle = find_handle(articulation, 1)
    # Those looking for a handle on the link that moves find the patch of it that lies nearest.
    np.testing.assert_array_equal(handle.faces, [16, 17, *range(24, 36)])


def test_the_root_and_fixed_parts_have_no_handle():
    articulation = world([PANEL])
    assert find_handle(articulation, 0) is None
    fixed = Joint("f", JointKind.FIXED, 0, 1, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    assert find_handle(replace(articulation, joints=(fixed,)), 1) is None


@pytest.mark.parametrize("category", ["cabinet", "oven"])
def test_turning_the_object_turns_its_handles(category):
    articulation = make_object(category, 0)
    rotation = Rotation.from_euler("zyx", [70.0, 0.0, 0.0], degrees=True).as_matrix()
    turned = rotated(articulation, rotation)
    for joint in articulation.movable_joints:
        before = find_handle(articulation, joint.child)
        after = find_handle(turned, joint.child)
        assert after.source == before.source
        np.testing.assert_array_equal(after.faces, before.faces)


#: A handle under whose material every maker's grips are found again.
MARK = Material("grip", (1.0, 0.0, 1.0, 1.0))
OBJECTS = {"kitchen": 0, "nightstand": 1, "wardrobe": 0, "sideboard": 0}
OBJECTS |= {"desk": 2, "door": 1, "window": 3}
#: A plate set flush into a front gives nothing to hold.
FLUSH = ("recess", "none")


def marked(add_pull, part, pull, *args):
    add_pull(part, pull if pull.kind in FLUSH else replace(pull, look=MARK), *args)


def grips(articulation):
    """Triangles of each moving part's own grip, by joint."""
    mesh = articulation.mesh
    of_grip = np.array([m.name == MARK.name for m in mesh.materials])[mesh.face_material]
    found = {}
    for joint in articulation.movable_joints:
        faces = articulation.parts[joint.child].faces
        if of_grip[faces].any():
            found[joint.name] = mesh.vertices[mesh.faces[faces[of_grip[faces]]]]
    return found


def test_the_best_target_lies_on_the_makers_handle(monkeypatch):
    for module in (casework, openings):
        monkeypatch.setattr(module, "add_pull", partial(marked, module.add_pull))
    on_handle = []
    for category, seed in OBJECTS.items():
        articulation = make_object(category, seed)
        targets = find_targets(articulation, [()] * len(articulation.parts))
        first = {target.joint: target for target in reversed(targets)}
        assert set(first) == {joint.name for joint in articulation.movable_joints}
        for name, triangles in grips(articulation).items():
            on_handle.append(distance(triangles, first[name].point) < 1e-3)
    assert len(on_handle) >= 12
    assert np.mean(on_handle) >= 0.9
