"""A door without room for its edge is cut free; a door that is hung wrongly never is."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from held_parts import CONFIG, PAIR, box, cut, cut_free, deepest, hulls_of, mesh_of, require_refused
from plain_solids import carcass, parted

from asset_factory.factory.articulation import Joint, Part, rotation_about
from asset_factory.factory.asset import Hull
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.manufacture.poses import relative_poses
from asset_factory.factory.manufacture.separate import separate
from asset_factory.factory.manufacture.separate.clip import meeting

#: Boards of a cabinet, and the space between its sides, in which its door lies.
BOARD = 0.02
THICK = 0.018
WIDTH, HEIGHT, DEPTH = 0.5, 0.7, 0.4
GAP = 0.003
SHELF = box((BOARD, THICK + 0.02, 0.36), (WIDTH + BOARD, DEPTH - BOARD, 0.38))
CASE = [*carcass(WIDTH + 2 * BOARD, DEPTH, HEIGHT + 2 * BOARD), SHELF]
LEFT = BOARD + GAP
#: The door's own hinge: in the middle of its edge, so that its corner needs half its thickness.
HINGE = Joint("hinge", "revolute", 0, 1, [0, 0, -1], [LEFT, THICK / 2, HEIGHT / 2], 0.0, 1.6)
DOOR = box((LEFT, 0, LEFT), (BOARD + WIDTH - GAP, THICK, BOARD + HEIGHT - GAP))
DIAGONAL = float(np.linalg.norm(np.ptp(DOOR.vertices, axis=0)))


def test_a_hinge_in_the_edge_gets_the_room_that_its_corner_needs():
    _, _, result = cut_free(CASE, [DOOR], HINGE, poses=200)
    trimmed = result.trimmed[PAIR]
    # Half the thickness and the clearance, less the gap that is there, off either.
    assert 0.005 < sum(each.deepest_m for each in trimmed) < THICK / 2 + CONFIG.clearance_m
    assert all(each.area < CONFIG.planed_area for each in trimmed)


@pytest.mark.parametrize(
    ("left", "right", "at"),
    [(0.006, 0.006, BOARD), (0.0, GAP + 0.004, LEFT)],
    ids=["3 mm in its frame at both sides", "4 mm in it across from its hinge"],
)
def test_a_door_that_is_too_wide_for_its_frame_is_cut_free(left, right, at):
    wide = box(DOOR.bounds[0] - [left, 0.0, 0.0], DOOR.bounds[1] + [right, 0.0, 0.0])
    cut_free(CASE, [wide], replace(HINGE, origin=[at, 0.0, HEIGHT / 2]), poses=200)


SHIFT = 0.05 * DIAGONAL
SIDE = np.array([1.0, 0.0, 0.0])
FRONT = np.array([0.0, -1.0, 0.0])


def tilted(about, degrees):
    return replace(HINGE, axis=rotation_about(about, np.radians(degrees)) @ HINGE.axis)


TWINS = {
    "flipped": replace(HINGE, axis=-HINGE.axis),
    "swapped": replace(HINGE, lower=-HINGE.upper, upper=0.0),
    "shifted inwards": replace(HINGE, origin=HINGE.origin + SHIFT * SIDE),
    "shifted backwards": replace(HINGE, origin=HINGE.origin - SHIFT * FRONT),
    "tilted sideways": tilted(FRONT, 10.0),
    "tilted the other way": tilted(FRONT, -10.0),
    "tilted backwards": tilted(SIDE, 10.0),
    "tilted forwards": tilted(SIDE, -10.0),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_door_that_is_hung_wrongly_is_not_cut_free(name):
    require_refused(CASE, [DOOR], TWINS[name])


def test_neighbours_whose_edges_overlap_are_cut_apart_and_broad_overlaps_are_not():
    back = box((0, 0.1, 0), (1, 0.12, 0.6))
    for overlap, refused in ((0.006, False), (0.06, True)):
        left = box((0, 0, 0), (0.5 + overlap / 2, 0.018, 0.6))
        right = box((0.5 - overlap / 2, 0, 0), (1, 0.018, 0.6))
        way = ([0, -1, 0], [0, 0, 0], 0.0, 0.2)
        joints = (Joint("one", "prismatic", 0, 1, *way), Joint("two", "prismatic", 0, 2, *way))
        boxes = {"back": [back], "left": [left], "right": [right]}
        tree = parted({name: [mesh_of(own)] for name, own in boxes.items()}, *joints)
        pieces = tuple(SolidPieces(hulls_of(own), "exact") for own in boxes.values())
        result = separate(tree, pieces, [("left", "right")], CONFIG, 64)
        assert (("left", "right") in result.refused) == refused


def test_a_cap_that_turns_and_lifts_is_held_by_its_bottle():
    # It lies 7 mm in the neck, with nothing but a link without a body between.
    neck = box((-0.1, -0.1, 0), (0.1, 0.1, 0.3))
    cap = box((-0.04, -0.04, 0.293), (0.04, 0.04, 0.34))
    lift = Joint("lift", "prismatic", 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 0.05)
    apart, before, _ = cut([neck], [cap], lift)
    turn = Joint("turn", "continuous", 1, 2, [0, 0, 1], [0, 0, 0], -np.pi, np.pi)
    parts = (apart.parts[0], Part("carrier", np.arange(0)), apart.parts[1])
    tree = replace(apart, parts=parts, joints=(lift, turn))
    pieces = (before[0], SolidPieces((), "none"), before[1])
    result = separate(tree, pieces, [PAIR], CONFIG, 64)
    assert result.refused == {}
    assert result.hidden[PAIR] == pytest.approx(0.007)
    assert deepest(tree, result) == 0.0


@pytest.mark.parametrize(("travel", "dug"), [(0.004, True), (0.03, False)])
def test_a_button_digs_a_pit_for_itself_and_what_is_no_button_does_not(travel, dug):
    panel = box((-0.2, -0.2, -0.02), (0.2, 0.2, 0))
    button = box((-0.01, -0.01, 0), (0.01, 0.01, 0.006))
    press = Joint("press", "prismatic", 0, 1, [0, 0, -1], [0, 0, 0], 0.0, travel)
    tree, _, result = cut([panel], [button], press)
    assert (PAIR not in result.refused) is dug
    if dug:
        assert deepest(tree, result) == 0.0
        assert result.pieces[1].hulls[0].volume > 0.5 * button.volume


def test_a_sheet_that_lies_on_a_rim_gives_way_and_stays():
    rim, lid = box((-0.5, -0.5, -0.2), (0.5, 0.5, 0)), box((-0.5, -0.5, 0), (0.5, 0.5, 0.0015))
    thin = box((-0.5, -0.5, -0.0015), (0.5, 0.5, 0))
    lift = Joint("lift", "prismatic", 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 0.05)
    for base in ([rim], [thin]):
        _, _, result = cut_free(base, [lid], lift)
        assert [len(piece.hulls) for piece in result.pieces] == [1, 1]


def test_a_hinge_that_turns_half_a_turn_keeps_its_clearance_all_the_way():
    tree, _, result = cut(CASE, [DOOR], replace(HINGE, upper=np.pi))
    sides, door = (piece.hulls for piece in result.pieces)
    pairs = product(sides, door, relative_poses(tree, 0, 1, 150))
    assert min(-meeting(*each).depth for each in pairs) > 0.0022


def test_what_a_slide_passes_between_two_poses_is_cut_too():
    # A front of 1.5 mm reaches 1.5 mm above a lip that it is past after one step of 9 mm.
    floor = box((-0.4, -0.1, -0.05), (0.4, 0.1, -0.02))
    lip = box((0.004, -0.1, 0.0985), (0.006, 0.1, 0.2))
    front = box((0.0, -0.1, 0.0), (0.0015, 0.1, 0.1))
    slide = Joint("slide", "prismatic", 0, 1, [1, 0, 0], [0, 0, 0], 0.0, 0.45)
    cut_free([floor, lip], [front], slide)
    # One that reaches 30 mm further is no lip.
    require_refused([floor, box((0.004, -0.1, 0.067), (0.03, 0.1, 0.2))], [front], slide)


def swung_over(post):
    """A thin arm of two metres that swings over the floor, past a post that stands there."""
    arm = box((0.0, -0.005, 0.1), (2.0, 0.0, 0.2))
    floor = box((-0.1, -2.5, -0.1), (2.5, 2.5, 0.0))
    hinge = Joint("hinge", "revolute", 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 1.5)
    tree, _, result = cut([floor, post], [arm], hinge)
    return -deepest(tree, result, poses=1000, gap=CONFIG.clearance_m)


@pytest.mark.parametrize(
    ("reach_m", "least_m", "most_m"),
    [(2.001, 0.75 * CONFIG.clearance_m, np.inf), (1.95, -np.inf, -0.0005)],
    ids=["what is just beyond it is clear", "what is in its way is left to the judge"],
)
def test_between_the_poses_that_a_long_arm_is_cut_at(reach_m, least_m, most_m):
    # Half way between two poses of the arm, so far from its hinge.
    post = box((reach_m, -0.004, 0.12), (reach_m + 0.05, -0.001, 0.18))
    turn = rotation_about([0, 0, 1], 10.5 * 1.5 / (CONFIG.poses - 1))
    assert least_m < swung_over(Hull(post.vertices @ turn.T, post.faces)) < most_m
