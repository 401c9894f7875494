"""What turns is cut by surfaces of revolution about its axis, and keeps more than by planes."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from held_parts import PAIR, held, hulls_of

from asset_factory.factory.articulation import Joint, rotation_about
from asset_factory.factory.config import SeparateConfig
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.manufacture.poses import relative_poses
from asset_factory.factory.manufacture.separate import separate
from asset_factory.factory.manufacture.separate.along import cut_apart_along, hull_depth
from asset_factory.factory.manufacture.separate.budget import SeenSurface
from asset_factory.factory.manufacture.separate.hung import ROUND_SHARE, seat_roundness
from asset_factory.factory.manufacture.separate.pair import PartPair, Workpieces
from asset_factory.factory.manufacture.separate.separate import finer_cuts
from asset_factory.factory.manufacture.separate.turned import Turned
from asset_factory.factory.mesh import Mesh, concatenate

#: Few poses: planes would need more, surfaces of revolution do not.
CONFIG = SeparateConfig(poses=13)
CLEARANCE = CONFIG.clearance_m
SIDES = 8
RADIUS = 0.1
UP = np.array([0.0, 0.0, 1.0])
ALONG = np.array([1.0, 0.0, 0.0])
TURN = Joint("turn", "revolute", 0, 1, UP, [0.0, 0.0, 0.0], -0.6, 0.6)


def turned(solid, angle):
    solid.apply_transform(trimesh.transformations.rotation_matrix(angle, UP))
    return solid


#: A knob of eight sides, 1 mm from the ring of as many boards around it.
KNOB = [trimesh.creation.cylinder(RADIUS, 0.06, sections=SIDES)]
INNER = RADIUS * np.cos(np.pi / SIDES) + 0.001
WIDTH = INNER * np.tan(np.pi / SIDES)
BOARD = trimesh.creation.box(bounds=[(INNER, -WIDTH, -0.02), (INNER + 0.02, WIDTH, 0.0)])
ANGLES = 2.0 * np.pi * (np.arange(SIDES) + 0.5) / SIDES
RING = [turned(BOARD.copy(), angle) for angle in ANGLES]
FLOOR = [trimesh.creation.box(bounds=[(-0.3, -0.3, -0.2), (0.3, 0.3, -0.06)])]


PIECES = tuple(SolidPieces(hulls_of(each), "exact") for each in ([*RING, *FLOOR], KNOB))


def object_of(joint):
    return held([*RING, *FLOOR], KNOB, joint)


def deepest(tree, body, knob, gap=0.0):
    return max(hull_depth(body, knob, pose, gap) for pose in relative_poses(tree, 0, 1, 60))


def volume(hulls):
    return sum(hull.volume for hull in hulls)


def test_a_knob_is_clear_at_every_angle_and_keeps_more_than_planes_leave():
    tree = object_of(TURN)
    poses = relative_poses(tree, 0, 1, CONFIG.poses)
    body, knob = hulls_of([*RING, *FLOOR]), hulls_of(KNOB)
    assert deepest(tree, body, knob) > 0.001
    after = Turned(TURN)(body, knob, poses, CLEARANCE)
    assert deepest(tree, *after, gap=CLEARANCE) < -0.9 * CLEARANCE
    by_planes = cut_apart_along(body, knob, poses, CLEARANCE)
    assert sum(map(volume, after)) > sum(map(volume, by_planes))
    # Its corners are cut by a cylinder, whose sides are alike.
    (round_one,) = after[1]
    low = round_one.vertices[round_one.vertices[:, 2] < -0.02 + 1e-6]
    assert np.ptp(np.linalg.norm(low[:, :2], axis=1)) < 0.005


def test_what_lies_on_a_panel_is_cut_across_the_axis():
    sunk = FLOOR[0].copy()
    sunk.apply_translation([0.0, 0.0, 0.032])
    body, knob = hulls_of([sunk]), hulls_of(KNOB)
    poses = relative_poses(object_of(TURN), 0, 1, CONFIG.poses)
    (panel,), (left,) = Turned(TURN)(body, knob, poses, CLEARANCE)
    gap = left.vertices[:, 2].min() - panel.vertices[:, 2].max()
    assert gap == pytest.approx(CLEARANCE)


def test_a_knob_in_a_ring_of_flat_boards_is_cut_free():
    tree = object_of(TURN)
    result = separate(tree, PIECES, [PAIR], CONFIG, 64)
    assert result.refused == {}
    assert deepest(tree, *(list(piece.hulls) for piece in result.pieces)) == 0.0


TILTED = rotation_about(ALONG, np.radians(10.0)) @ UP
TWINS = {
    "shifted": replace(TURN, origin=0.05 * 0.7 * ALONG),
    "tilted": replace(TURN, axis=TILTED, lower=0.0, upper=0.5),
    "lying": replace(TURN, axis=ALONG),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_knob_that_turns_about_another_axis_is_not_cut_free(name):
    tree = object_of(TWINS[name])
    result = separate(tree, PIECES, [PAIR], CONFIG, 64)
    assert PAIR in result.refused
    assert deepest(tree, *(list(piece.hulls) for piece in result.pieces)) > 0.001


def roundness(solids, seat):
    mesh = concatenate([Mesh.from_triangles(each.vertices, each.faces) for each in solids])
    return seat_roundness(SeenSurface.of(mesh), TURN, hulls_of(seat), CLEARANCE)


def test_a_knob_has_a_round_seat_and_a_lid_on_a_box_has_none():
    # About an axis across it a lid could be cut free as well: nobody turns it so.
    lid = trimesh.creation.box(bounds=[(-0.15, -0.1, -0.002), (0.15, 0.1, 0.02)])
    box = trimesh.creation.box(bounds=[(-0.15, -0.1, -0.1), (0.15, 0.1, 0.0)])
    assert roundness(KNOB, RING) > ROUND_SHARE
    assert 0.3 < roundness([lid], [box]) < ROUND_SHARE


def is_turned(joint, deep_m):
    """Whether surfaces of revolution are tried about a joint of a knob that stands so deep."""
    hulls = [list(hulls_of([*RING, *FLOOR])), list(hulls_of(KNOB))]
    pair = PartPair.of(Workpieces(object_of(joint), hulls, CONFIG), PAIR)
    return any(isinstance(cut, Turned) for cut in finer_cuts(pair, deep_m))


@pytest.mark.parametrize(
    ("off", "deep_m", "turned_free"),
    [(0.0, 0.0, True), (0.2, 0.0, False), (0.2, 0.003, True), (0.5, 0.003, False)],
)
def test_a_hub_that_stands_deep_in_its_holder_may_sit_less_in_the_middle(off, deep_m, turned_free):
    joint = replace(TURN, origin=off * RADIUS * ALONG)
    assert is_turned(joint, deep_m) == turned_free


def test_a_hub_about_a_crooked_axis_has_to_sit_in_the_middle():
    axis = rotation_about(ALONG, np.radians(10.0)) @ UP
    joint = replace(TURN, axis=axis, origin=0.2 * RADIUS * ALONG)
    assert not is_turned(joint, 0.003)
