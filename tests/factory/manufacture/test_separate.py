"""Hulls are cut apart where a real joint has clearance, never where that would hide a fault."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from held_parts import CONFIG, PAIR, cut, cut_free, cylinder
from held_parts import box as box_between
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import parted
from plain_solids import sized_box as box
from plain_solids import sized_hull as hull

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Hull
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.decompose.outside import outside
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.manufacture.separate import separate
from asset_factory.factory.manufacture.separate.budget import SeenSurface
from asset_factory.factory.manufacture.separate.clip import (
    clipped,
    cut_apart,
    meeting,
    volumes_below,
)
from asset_factory.factory.manufacture.separate.separate import with_hulls
from asset_factory.factory.mesh import Mesh


def solid(size, center=(0, 0, 0)):
    return Mesh.from_triangles(*box(size, center))


SLIDE = Joint("slide", JointKind.PRISMATIC, 0, 1, [1, 0, 0], [0, 0, 0], 0.0, 0.3)
TURN = Joint("turn", JointKind.REVOLUTE, 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 1.0)


def pieces_of(*hulls):
    return tuple(SolidPieces((one,), "exact") for one in hulls)


def gap(result):
    first, second = (piece.hulls[0] for piece in result.pieces[:2])
    return -meeting(first, second, np.eye(4)).depth


def test_what_decomposition_added_is_taken_off():
    # The meshes are 4 mm apart; the base's hull bulges 7 mm.
    meshes = {"body": [solid((1, 1, 0.1))], "mover": [solid((1, 1, 0.1), (0, 0, 0.104))]}
    tree = parted(meshes, SLIDE)
    bulging = pieces_of(hull((1, 1, 0.114)), hull((1, 1, 0.1), (0, 0, 0.104)))
    assert gap(separate(tree, bulging, [], CONFIG, 64)) == pytest.approx(-0.003)
    result = separate(tree, bulging, [PAIR[::-1]], CONFIG, 64)
    assert gap(result) == pytest.approx(CONFIG.clearance_m, abs=1e-9)
    assert result.refused == {}
    assert result.hidden == {}


def test_hulls_that_are_apart_are_not_touched():
    _, before, result = cut([solid((1, 1, 0.1))], [solid((1, 1, 0.1), (0, 0, 0.2))], SLIDE)
    assert all(a is b for a, b in zip(result.pieces, before, strict=True))


def stem_in_a_block(sunk):
    """A stem of 20 mm, 200 mm long, that turns in a block it reaches into."""
    stem = solid((0.02, 0.02, 0.2), (0, 0, 0.15 - sunk))
    return cut([solid((0.3, 0.3, 0.1))], [stem], TURN)[2]


def test_a_stem_loses_the_little_that_is_hidden_in_its_socket_and_the_depth_is_told():
    result = stem_in_a_block(sunk=0.006)
    assert result.hidden[PAIR] == pytest.approx(0.006, abs=0.002)
    assert result.pieces[0].hulls[0].volume == pytest.approx(0.009, rel=1e-6)
    assert gap(result) >= CONFIG.clearance_m - 1e-9


def test_a_stem_of_which_much_is_hidden_is_kept_whole_in_a_socket():
    result = stem_in_a_block(sunk=0.03)
    (stem,) = result.pieces[1].hulls
    assert stem.volume == pytest.approx(0.02 * 0.02 * 0.2, rel=1e-6)
    around = result.pieces[0].hulls
    for angle in np.linspace(0.0, 1.0, 9):
        pose = np.eye(4)
        pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        depths = [meeting(one, stem, pose).depth for one in around]
        assert max(depths) <= -CONFIG.clearance_m + 1e-4
    socket = 0.009 - sum(one.volume for one in result.pieces[0].hulls)
    assert 0.02 * 0.02 * 0.03 < socket < 0.05 * 0.05 * 0.05


def test_a_round_stem_that_nearly_fills_its_column_is_kept_whole_in_a_socket():
    # A spout in its base: walls of four pieces would leave the column's own surface bare.
    column, stem = cylinder(0.05, 0.0, 0.2, sections=24), cylinder(0.03, 0.05, 0.5, sections=24)
    turn = Joint("turn", JointKind.CONTINUOUS, 0, 1, [0, 0, 1], [0, 0, 0], -np.pi, np.pi)
    _, _, result = cut_free([column], [stem], turn)
    assert result.trimmed == {}
    assert result.pieces[1].hulls[0].volume == pytest.approx(stem.volume, rel=1e-6)


def test_a_slot_in_something_large_may_be_as_deep_as_it_is_large():
    # A toaster of three metres: its lever's tongue is 100 mm wide, the slot in its front 50.
    sides = [
        box_between((-1.5, 0.0, 0.0), (-0.025, 3.0, 3.0)),
        box_between((0.025, 0.0, 0.0), (1.5, 3.0, 3.0)),
    ]
    tongue = box_between((-0.05, -0.2, 1.5), (0.05, 0.25, 1.6))
    down = Joint("slide", JointKind.PRISMATIC, 0, 1, [0, 0, -1], [0, 0, 0], 0.0, 0.4)
    _, _, result = cut(sides, [tongue], down)
    assert result.refused == {}
    assert result.pieces[1].hulls[0].volume == pytest.approx(tongue.volume, rel=1e-6)
    (slot,) = result.trimmed[PAIR]
    assert slot.deepest_m == pytest.approx(0.025 + CONFIG.clearance_m, abs=1e-4)
    assert slot.area < 0.01


def test_parts_that_get_deeper_along_the_joint_are_left_alone():
    # A drawer that slides 0.3 m towards a wall 0.1 m away.
    _, before, result = cut([solid((0.1, 1, 1), (0.65, 0, 0))], [solid((1, 0.5, 0.5))], SLIDE)
    assert "deeper than at rest" in result.refused[PAIR].reason
    assert result.pieces == before


def test_overlap_without_a_joint_between_is_left_alone():
    # Two neighbours, overlapping by 8 mm, both held by the base.
    shapes = [((2, 2, 0.1), (0, 0, -2))]
    shapes += [((0.5, 0.5, 0.5), (0, y, 0)) for y in (0, 0.492)]
    meshes = {name: [solid(*shape)] for name, shape in zip((*PAIR, "third"), shapes, strict=True)}
    other = Joint("other", JointKind.PRISMATIC, 0, 2, [0, 0, 1], [0, 0, 0], 0.0, 0.3)
    tree = parted(meshes, SLIDE, other)
    pieces = pieces_of(*(hull(*shape) for shape in shapes))
    result = separate(tree, pieces, [("mover", "third")], CONFIG, 64)
    assert "overlap by 8.00 mm at rest and no joint" in result.refused[("mover", "third")].reason


def test_sheets_that_cross_at_a_slight_angle_are_not_cut_to_knife_s_edges():
    # Two flaps of a carton, hinged at sides that meet in a corner; one plane takes all of either.
    joints = (
        Joint("front", JointKind.REVOLUTE, 0, 1, [1, 0, 0], [0, -0.15, 0], 0.0, 1.5),
        Joint("side", JointKind.REVOLUTE, 0, 2, [0, -1, 0], [-0.2, 0, 0], 0.0, 1.5),
    )
    meshes = {
        "carton": [solid((0.4, 0.3, 0.1), (0, 0, -0.06))],
        "front": [solid((0.4, 0.15, 0.001), (0, -0.075, 0))],
        "side": [solid((0.15, 0.3, 0.001), (-0.125, 0, 0))],
    }
    flat = parted(meshes, *joints)
    crossed = posed(flat, dict.fromkeys(("front", "side"), np.radians(0.5))).mesh
    tree = replace(flat, mesh=crossed)
    meshes = [tree.part_mesh(part) for part in range(3)]
    pieces = pieces_of(*(Hull(mesh.vertices, mesh.faces) for mesh in meshes))
    result = separate(tree, pieces, [("front", "side")], CONFIG, 64)
    for mesh, piece in zip(meshes, result.pieces, strict=True):
        bare = outside(piece.hulls, SeenSurface.of(mesh).points[:1500])
        assert float((bare > 0.01).mean()) < 0.1


def test_a_cut_that_would_take_too_much_is_refused():
    # Planes take the stem; a pit for all of its turn would be as wide as so slim a base.
    stem = solid((0.02, 0.02, 0.05), (0, 0, 0.04))
    for width, refused in ((0.032, True), (0.06, False)):
        _, _, result = cut([solid((width, width, 0.1))], [stem], TURN)
        assert (PAIR in result.refused) == refused


def test_what_sticks_out_on_the_other_side_is_not_cut_off():
    # A rod through a board: neither half of it may go, only what is in the board.
    _, _, result = cut([solid((0.3, 0.3, 0.02), (0, 0, 0.1))], [solid((0.02, 0.02, 0.4))], TURN)
    assert result.refused == {}
    rods = result.pieces[1].hulls
    assert sum(each.volume for each in rods) == pytest.approx(0.02**2 * (0.4 - 0.025))
    lengths = sorted(float(np.ptp(each.vertices[:, 2])) for each in rods)
    assert lengths == pytest.approx([0.0875, 0.2875])


def random_hull(generator, count, size, at=0.0):
    """The convex hull of so many points about a place [m]."""
    made = trimesh.convex.convex_hull(generator.normal(size=(count, 3)) * size + at)
    return Hull(made.vertices, made.faces)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000), st.floats(-0.05, 0.05))
def test_clipping_keeps_exactly_one_side(seed, offset):
    generator = np.random.default_rng(seed)
    whole = random_hull(generator, 20, 0.1)
    normal = generator.normal(size=3)
    normal /= np.linalg.norm(normal)
    below = clipped(whole, normal, offset)
    above = clipped(whole, -normal, -offset)
    volumes = [piece.volume if piece else 0.0 for piece in (below, above)]
    assert sum(volumes) == pytest.approx(whole.volume, rel=1e-3, abs=1e-7)
    if below is not None:
        assert (below.vertices @ normal).max() <= offset + 1e-9 or below is whole


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000))
def test_two_hulls_cut_apart_have_the_gap_and_take_no_room(seed):
    generator = np.random.default_rng(seed)
    solids = [random_hull(generator, 16, 0.05, [shift, 0, 0]) for shift in (0.0, 0.12)]
    pose = np.eye(4)
    met = meeting(*solids, pose)
    first, second = cut_apart(*solids, pose, met, 0.002)
    for before, after in zip(solids, (first, second), strict=True):
        if after is not None:
            inside = before.planes[:, :3] @ after.vertices.T - before.planes[:, 3:]
            assert inside.max() < 1e-9
    if met.depth > -0.002 and first is not None and second is not None:
        assert meeting(first, second, pose).depth <= -0.002 + 1e-6


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000))
def test_what_a_plane_would_leave_of_a_hull_is_known_before_it_is_cut(seed):
    generator = np.random.default_rng(seed)
    one = random_hull(generator, 16, 1.0, generator.normal(size=3))
    # Planes through corners as well, and planes beside the hull.
    normals = np.concatenate([generator.normal(size=(4, 3)), np.eye(3)])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    heights = one.vertices @ normals.T
    offsets = heights.min(axis=0) + generator.uniform(-0.2, 1.2, 7) * np.ptp(heights, axis=0)
    offsets[:2] = heights[3, :2]
    left = [clipped(one, *plane) for plane in zip(normals, offsets, strict=True)]
    volumes = [0.0 if hull is None else hull.volume for hull in left]
    assert volumes_below(one, normals, offsets) == pytest.approx(volumes, abs=1e-9 * one.volume)


PANEL = SolidPieces((hull((0.3, 0.3, 0.02)),), "exact")
#: The panel in nine tiles, without the one in the middle.
PLACES = [(x, y, 0.0) for x in (-0.1, 0.0, 0.1) for y in (-0.1, 0.0, 0.1) if (x, y) != (0.0, 0.0)]
TILES = [hull((0.1, 0.1, 0.02), place) for place in PLACES]


def test_tiles_around_a_hole_become_four_walls_and_the_hole_stays_open():
    after = with_hulls(PANEL, TILES, 64)
    assert len(after.hulls) == 4
    assert sum(hull.volume for hull in after.hulls) == pytest.approx(8 * 0.1 * 0.1 * 0.02)
    hole = np.random.default_rng(0).uniform(-0.0499, 0.0499, (500, 3)) * [1.0, 1.0, 0.2]
    assert max(depth_below(hull, hole).max() for hull in after.hulls) < 0.0


def test_tiles_further_apart_than_rounding_stay_apart():
    apart = [hull((0.1, 0.1, 0.02)), hull((0.1, 0.1, 0.02), (0.101, 0.0, 0.0))]
    assert len(with_hulls(PANEL, apart, 64).hulls) == 2
