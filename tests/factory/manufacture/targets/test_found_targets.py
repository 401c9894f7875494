"""Where to hold objects of known answer, to the millimetre, and where a robot stands to do so."""

from dataclasses import replace

import numpy as np
import pytest
from plain_solids import box, cylinder, moved, parted
from scipy.spatial.transform import Rotation
from target_worlds import (
    BAR,
    BODY,
    FRONT,
    HINGE,
    KNOB,
    PANEL,
    PLAIN,
    SLIDE,
    asset_of,
    best,
    targets_of,
    world,
)

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Asset, Hull, PartBody
from asset_factory.factory.manufacture.targets.find import MOST, find_targets
from asset_factory.factory.manufacture.targets.standing import (
    BASE_RADIUS_M,
    facing_direction,
    standing_place,
)


def test_a_bar_is_grasped_in_its_middle_across_its_thickness():
    target = best(world([PANEL, *BAR]))
    assert target.kind == "grasp"
    assert target.part == 1
    np.testing.assert_allclose(target.point, [0.356, -0.062, 0.3], atol=1e-6)
    np.testing.assert_allclose(target.normal, FRONT, atol=1e-6)
    np.testing.assert_allclose(np.abs(target.fingers), [1.0, 0.0, 0.0], atol=1e-6)
    assert target.opening == pytest.approx(0.012, abs=1e-6)
    # About a hinge at (0, -0.02), the point at (0.356, -0.062) goes forwards and a little towards
    # the hinge.
    forwards = np.array([-0.042, -0.356, 0.0]) / np.hypot(0.042, 0.356)
    np.testing.assert_allclose(target.pull, forwards, atol=1e-6)
    assert target.score > 0.9


def test_a_knob_on_a_drawer_is_grasped_across_its_head_and_pulled_straight_out():
    target = best(world([PANEL, *KNOB], SLIDE))
    assert target.kind == "grasp"
    np.testing.assert_allclose(target.point, [0.2, -0.05, 0.3], atol=1e-6)
    np.testing.assert_allclose(target.pull, FRONT, atol=1e-9)
    # Across a 32-sided head, which is a little less than 30 mm between its flats.
    assert 0.030 * np.cos(np.pi / 32) - 1e-6 <= target.opening <= 0.030 + 1e-6
    assert target.score > 0.9


def test_a_knob_to_turn_is_held_about_its_axis_and_pulled_round_it():
    turn = Joint("j", JointKind.REVOLUTE, 0, 1, -FRONT, np.array([0.2, -0.01, 0.3]), 0.0, 3.0)
    target = best(world([cylinder(1, (0.3, 0.2), 0.02, (-0.03, -0.002), PLAIN, 32)], turn))
    assert target.kind == "grasp"
    np.testing.assert_allclose(target.point, [0.2, -0.03, 0.3], atol=1e-6)
    np.testing.assert_allclose(target.normal, FRONT, atol=1e-6)
    np.testing.assert_allclose(target.pull, np.cross(turn.axis, target.fingers), atol=1e-6)
    assert target.opening == pytest.approx(0.04, abs=3e-4)


def test_a_slab_that_nothing_can_hold_is_named_at_its_far_edge_as_hopeless():
    targets = targets_of(world([PANEL]))
    assert len(targets) == 1
    assert targets[0].point[0] == pytest.approx(0.4)
    assert targets[0].point[2] == pytest.approx(0.3)
    np.testing.assert_allclose(targets[0].normal, [1.0, 0.0, 0.0], atol=1e-9)
    assert 0.0 < targets[0].score <= 0.05


def test_a_slab_that_overhangs_its_body_is_hooked_or_grasped_at_the_overhang():
    targets = targets_of(world([box((0.0, 0.46), (-0.02, -0.003), (0.0, 0.6), PLAIN)]))
    assert targets[0].score > 0.4
    assert targets[0].point[0] > 0.43
    pushed = [t for t in targets if t.kind in ("hook", "push")]
    assert pushed
    assert all(t.point[1] == pytest.approx(-0.003) for t in pushed if t.score > 0.3)


def test_the_edge_of_a_hollow_in_a_drawer_front_is_hooked():
    # A front with a slot 75 mm high and 40 mm deep; a lip 14 mm thick hangs down before it.
    front = [
        box((0.0, 0.4), (-0.02, -0.003), (0.0, 0.6), PLAIN),
        box((0.0, 0.4), (-0.06, -0.02), (0.0, 0.25), PLAIN),
        box((0.0, 0.1), (-0.06, -0.02), (0.25, 0.35), PLAIN),
        box((0.3, 0.4), (-0.06, -0.02), (0.25, 0.35), PLAIN),
        box((0.0, 0.4), (-0.06, -0.02), (0.35, 0.6), PLAIN),
        box((0.1, 0.3), (-0.06, -0.046), (0.325, 0.35), PLAIN),
    ]
    hulls = [(Hull(BODY.vertices, BODY.faces),), tuple(Hull(m.vertices, m.faces) for m in front)]
    target = find_targets(world(front, SLIDE), hulls)[0]
    assert target.kind == "hook"
    assert target.score > 0.2
    # Behind the lip; the hand leans out of the hollow.
    assert 0.1 < target.point[0] < 0.3
    assert 0.325 < target.point[2] < 0.35
    assert target.point[1] == pytest.approx(-0.046)
    assert target.normal @ FRONT > 0.5


def test_a_thing_too_wide_to_grasp_is_hooked_behind():
    block = box((0.1, 0.3), (-0.09, -0.06), (0.24, 0.36), PLAIN)
    neck = box((0.19, 0.21), (-0.06, -0.02), (0.29, 0.31), PLAIN)
    targets = targets_of(world([PANEL, block, neck], SLIDE))
    assert targets[0].kind == "hook"
    assert targets[0].point[1] == pytest.approx(-0.06)
    assert abs(targets[0].normal @ FRONT) < 1e-6


def test_a_button_is_pushed_in():
    inwards = Joint("j", JointKind.PRISMATIC, 0, 1, -FRONT, np.array([0.2, -0.01, 0.3]), 0.0, 0.005)
    targets = targets_of(world([box((0.15, 0.25), (-0.012, -0.001), (0.25, 0.35), PLAIN)], inwards))
    pushes = [t for t in targets if t.kind == "push"]
    assert pushes
    np.testing.assert_allclose(pushes[0].normal, FRONT, atol=1e-9)
    np.testing.assert_allclose(pushes[0].pull, -FRONT, atol=1e-9)
    assert pushes[0].point[1] == pytest.approx(-0.012)


def test_a_window_that_slides_in_its_own_plane_is_held_by_the_handle_on_its_face():
    sideways = Joint("j", JointKind.PRISMATIC, 0, 1, [1, 0, 0], np.zeros(3), 0.0, 0.3)
    target = best(world([PANEL, *BAR], sideways))
    assert target.kind == "grasp"
    np.testing.assert_allclose(target.point, [0.356, -0.062, 0.3], atol=1e-6)
    np.testing.assert_allclose(target.normal, FRONT, atol=1e-6)


@pytest.mark.parametrize("kind", ["turned", "mirrored"])
@pytest.mark.parametrize("joint", [HINGE, SLIDE], ids=["hinge", "slide"])
def test_a_turned_or_mirrored_object_has_turned_or_mirrored_targets(kind, joint):
    matrix = np.eye(4)
    if kind == "turned":
        matrix[:3, :3] = Rotation.from_euler("z", 37.0, degrees=True).as_matrix()
        matrix[:3, 3] = [0.3, -0.2, 0.0]
    else:
        matrix[0, 0] = -1.0
    articulation = world([PANEL, *BAR], joint)
    before = targets_of(articulation)
    after = targets_of(moved(articulation, matrix))
    linear = matrix[:3, :3]
    np.testing.assert_allclose(after[0].point, linear @ before[0].point + matrix[:3, 3], atol=1e-6)
    np.testing.assert_allclose(after[0].normal, linear @ before[0].normal, atol=1e-6)
    np.testing.assert_allclose(after[0].pull, linear @ before[0].pull, atol=1e-6)
    assert abs(after[0].fingers @ linear @ before[0].fingers) == pytest.approx(1.0)
    assert after[0].opening == pytest.approx(before[0].opening, abs=1e-6)
    assert after[0].score == pytest.approx(before[0].score, abs=2e-4)


def score_at_bar(still):
    targets = targets_of(world([PANEL, *BAR], HINGE, [BODY, *still]))
    return max((target.score for target in targets if target.kind == "grasp"), default=0.0)


def test_what_stands_before_a_handle_lowers_its_score_and_what_touches_the_fingers_forbids_it():
    free = score_at_bar([])
    before_the_palm = score_at_bar([box((0.30, 0.42), (-0.16, -0.13), (0.2, 0.4), PLAIN)])
    far_away = score_at_bar([box((-0.2, 0.8), (-0.5, -0.4), (0.0, 0.8), PLAIN)])
    beside = score_at_bar([
        box((0.33, 0.347), (-0.09, -0.022), (0.0, 0.6), PLAIN),
        box((0.365, 0.38), (-0.09, -0.022), (0.0, 0.6), PLAIN),
    ])  # fmt: skip
    assert 0.0 < before_the_palm < free
    assert 0.0 < far_away < free
    assert beside < 0.5 * free


def test_collision_hulls_count_as_what_they_fill():
    articulation = world([PANEL, *BAR])
    filled = box((0.340, 0.372), (-0.062, -0.020), (0.22, 0.38), PLAIN)
    hulls = [(), (Hull(PANEL.vertices, PANEL.faces), Hull(filled.vertices, filled.faces))]
    target = next(t for t in find_targets(articulation, hulls) if t.kind == "grasp")
    assert target.opening == pytest.approx(0.032, abs=1e-6)


def test_a_part_carried_by_a_link_without_surface_is_held_for_both_joints():
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, FRONT, np.zeros(3), 0.0, 0.1)
    turn = Joint("turn", JointKind.REVOLUTE, 1, 2, HINGE.axis, HINGE.origin, 0.0, 1.0)
    parts = {"body": [BODY], "carrier": [], "front": [PANEL, *BAR]}
    targets = targets_of(parted(parts, slide, turn))
    for name in ("slide", "turn"):
        first = next(t for t in targets if t.joint == name)
        assert first.part == 2
        np.testing.assert_allclose(first.point, [0.356, -0.062, 0.3], atol=1e-6)


def test_targets_are_few_sorted_distinct_and_the_same_every_time():
    articulation = world([PANEL, *BAR])
    first = targets_of(articulation)
    second = targets_of(articulation)
    assert 1 < len(first) <= MOST
    assert [t.score for t in first] == sorted((t.score for t in first), reverse=True)
    for a, b in zip(first, second, strict=True):
        np.testing.assert_array_equal(a.point, b.point)
        assert (a.kind, a.score, a.opening) == (b.kind, b.score, b.opening)
        assert 0.0 <= a.score <= 1.0
        for unit in (a.normal, a.pull, a.fingers):
            assert np.linalg.norm(unit) == pytest.approx(1.0)
        assert abs(a.normal @ a.fingers) < 1e-6


def place_of(articulation):
    place = standing_place(asset_of(articulation), articulation.joints[0], best(articulation))
    assert place is not None
    return place


def swept(articulation):
    joint = articulation.joints[0]
    vertices = articulation.part_mesh(1).vertices
    motions = [joint.motion(value) for value in np.linspace(0, joint.upper, 200)]
    rows = [vertices @ motion[:3, :3].T + motion[:3, 3] for motion in motions]
    return np.concatenate([articulation.part_mesh(0).vertices, *rows])[:, :2]


@pytest.mark.parametrize("joint", [HINGE, SLIDE], ids=["hinge", "slide"])
def test_the_base_is_clear_of_everything_that_moves_and_faces_its_target(joint):
    articulation = world([PANEL, *BAR], joint)
    place = place_of(articulation)
    assert np.linalg.norm(swept(articulation) - place.position, axis=1).min() > BASE_RADIUS_M
    ahead = best(articulation).point[:2] - place.position
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(place.yaw, abs=1e-6)
    assert place.position[1] < -0.3


def test_a_longer_drawer_is_opened_from_farther_away():
    near = place_of(world([PANEL, *BAR], SLIDE))
    far = place_of(world([PANEL, *BAR], replace(SLIDE, upper=0.6)))
    assert np.linalg.norm(far.position) > np.linalg.norm(near.position)


def test_a_turned_object_is_opened_from_the_turned_place():
    articulation = world([PANEL, *BAR])
    turn = np.eye(4)[[1, 0, 2, 3]] * [[-1.0], [1.0], [1.0], [1.0]]
    before = place_of(articulation)
    after = place_of(moved(articulation, turn))
    np.testing.assert_allclose(after.position, turn[:2, :2] @ before.position, atol=1e-6)
    assert (after.yaw - before.yaw) % (2 * np.pi) == pytest.approx(np.pi / 2)


def test_without_room_there_is_no_place():
    front = box((-4.0, 4.0), (-4.0, -0.5), (0.0, 0.6), PLAIN)
    sides = [box(x, (-0.5, 4.0), (0.0, 0.6), PLAIN) for x in ((-4.0, -0.1), (0.5, 4.0))]
    walls = [BODY, front, *sides]
    articulation = world([PANEL, *BAR], SLIDE, walls)
    # Solids of their own, so that the space between them is not taken for one of them.
    hulls = tuple(Hull(w.vertices, w.faces) for w in walls)
    plain = asset_of(articulation).bodies
    bodies = (PartBody(hulls, plain[0].inertial), plain[1])
    asset = Asset("test", articulation, bodies)
    assert standing_place(asset, SLIDE, best(articulation)) is None


def test_a_lid_pulled_upward_is_approached_from_where_its_handle_faces():
    up = np.array([0.0, 0.0, 1.0])
    side = np.array([1.0, 0.0, 0.0])
    np.testing.assert_allclose(facing_direction(up, side), side)
    np.testing.assert_allclose(facing_direction(up, up, np.array([0.0, 1.0, 1.0])), [0, 1, 0])
    np.testing.assert_allclose(facing_direction(up, up, up), [0, -1, 0])
