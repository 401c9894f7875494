"""Convex pieces: hulls, what they may fill, how they are cut, joined and limited."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Manifold

from asset_factory.factory.manufacture.decompose.convex import depth_below, hull_of, limit_vertices
from asset_factory.factory.manufacture.decompose.cut import as_one, cut_along_faces
from asset_factory.factory.manufacture.decompose.merge import merge
from asset_factory.factory.manufacture.decompose.outside import uncovered
from asset_factory.factory.manufacture.decompose.pockets import fills_little
from asset_factory.factory.manufacture.decompose.sheets import slabs
from asset_factory.factory.manufacture.decompose.solids import OpenSurface, manifold_of_hull


def solid_box(size, at=(0, 0, 0)):
    return Manifold.cube(size).translate(at)


def round_hole(diameter):
    """What makes a round hole in a board of 0.4 x 0.3 x 0.1 m."""
    cylinder = Manifold.cylinder(0.2, diameter / 2, diameter / 2, 16)
    return cylinder.translate((0.2, 0.1, -0.05))


def hull_box(size, at=(0, 0, 0)):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size + at
    hull = hull_of(corners.astype(float))
    assert hull is not None
    return hull


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(4, 60), st.floats(-50, 50))
def test_hulls_face_outwards_and_hold_their_points(seed, count, offset):
    points = np.random.default_rng(seed).normal(size=(count, 3)) + offset
    hull = hull_of(points)
    assert depth_below(hull, points).min() >= -1e-9
    assert (hull.planes[:, :3] @ points.mean(axis=0) < hull.planes[:, 3]).all()


@pytest.mark.parametrize(
    "points", [np.zeros((0, 3)), np.eye(3), np.random.default_rng(0).random((9, 3)) * [1, 1, 0]]
)
def test_points_without_a_body_have_no_hull(points):
    assert hull_of(points) is None


def test_depth_is_the_distance_to_the_nearest_face():
    hull = hull_box((1, 1, 1))
    points = np.array([[0.5, 0.5, 0.9], [0.5, 0.5, 0.5], [0.5, 0.5, 1.25]])
    assert depth_below(hull, points) == pytest.approx([0.1, 0.5, -0.25])
    assert uncovered([hull], points) == pytest.approx(0.25)


def test_a_limited_hull_lies_inside_and_loses_little():
    sphere = hull_of(np.array(trimesh.creation.icosphere(subdivisions=3, radius=0.1).vertices))
    few = limit_vertices(sphere, 64)
    assert len(few.vertices) <= 64
    assert depth_below(sphere, few.vertices).min() >= -1e-9
    assert few.volume > 0.85 * sphere.volume
    assert limit_vertices(few, 64) is few


def test_a_hull_may_fill_dents_and_slots_within_the_error_and_nothing_wider():
    board = solid_box((0.4, 0.3, 0.1))
    for cut, allowed in (
        (solid_box((0.2, 0.2, 0.004), (0.1, 0.05, 0.096)), True),  # a wide dent, 4 mm deep
        (solid_box((0.2, 0.2, 0.02), (0.1, 0.05, 0.08)), False),  # a wide dent, 20 mm deep
        (solid_box((0.008, 0.2, 0.05), (0.1, 0.05, 0.05)), True),  # a slot 8 mm wide, 50 mm deep
        (solid_box((0.02, 0.2, 0.05), (0.1, 0.05, 0.05)), False),  # a slot 20 mm wide
        (round_hole(0.005), True),
        (round_hole(0.04), False),
    ):
        assert fills_little(hull_box((0.4, 0.3, 0.1)), board - cut, 0.005) is allowed


def test_boxes_are_exact_and_boards_are_cut_exactly():
    whole = as_one(solid_box((0.4, 0.3, 0.1)), 0.005)
    assert whole.method == "exact"
    shape = solid_box((0.4, 0.3, 0.02)) + solid_box((0.02, 0.3, 0.4))
    cut = cut_along_faces(shape, 0.005, 8)
    assert cut.method == "exact"
    assert len(cut.hulls) == 2
    assert sum(hull.volume for hull in cut.hulls) == pytest.approx(shape.volume(), rel=1e-9)


def test_a_ring_is_cut_into_its_four_bars():
    frame = solid_box((1.0, 0.05, 2.0)) - solid_box((0.8, 0.05, 1.8), (0.1, 0.0, 0.1))
    cut = cut_along_faces(frame, 0.005, 16)
    assert cut.method == "exact"
    assert len(cut.hulls) == 4
    assert sum(hull.volume for hull in cut.hulls) == pytest.approx(frame.volume(), rel=1e-9)


def test_cutting_gives_up_beyond_the_limit():
    comb = solid_box((0.5, 0.1, 0.02))
    for tooth in range(8):
        comb = comb + solid_box((0.02, 0.1, 0.2), (0.06 * tooth, 0, 0))
    assert cut_along_faces(comb, 0.005, 4) is None
    assert cut_along_faces(comb, 0.005, 32) is not None


def test_halves_of_a_board_are_joined_and_the_legs_of_a_table_are_not():
    halves = [hull_box((0.5, 0.5, 0.02)), hull_box((0.5, 0.5, 0.02), (0.5, 0, 0))]
    assert [hull.volume for hull in merge(halves, 0.005)] == pytest.approx([0.01])
    legs = [hull_box((0.05, 0.05, 0.7), (x, 0, 0)) for x in (0.0, 0.3, 0.6)]
    assert len(merge([*legs, hull_box((0.65, 0.5, 0.02), (0, 0, 0.7))], 0.005)) == 4


def test_joining_covers_whatever_was_given():
    random = np.random.default_rng(3)
    places = random.random((40, 3)) * [0.2, 0.2, 0.01]
    hulls = [hull_box((0.03, 0.03, 0.01), place) for place in places]
    merged = merge(hulls, 0.005)
    assert len(merged) < len(hulls)
    assert uncovered(merged, np.concatenate([hull.vertices for hull in hulls])) < 1e-9


def test_an_open_box_becomes_five_walls_with_room_between():
    made = trimesh.creation.box((0.4, 0.3, 0.2))
    vertices = np.array(made.vertices)
    faces = np.array(made.faces)
    lidless = faces[~(vertices[faces][:, :, 2] > 0).all(axis=1)]
    walls = slabs(OpenSurface(vertices, lidless), 0.005, 0.0015, np.zeros(3))
    assert len(walls) == 5
    outer = hull_box((0.4, 0.3, 0.2), (-0.2, -0.15, -0.1))
    assert min(depth_below(outer, wall.vertices).min() for wall in walls) > -1e-9
    inside = np.random.default_rng(0).uniform(-1, 1, (500, 3)) * [0.19, 0.14, 0.09]
    assert max(depth_below(wall, inside).max() for wall in walls) < 0.0


def test_a_flat_sheet_of_an_l_keeps_its_notch():
    outline = np.array([[0, 0], [1, 0], [1, 0.4], [0.4, 0.4], [0.4, 1], [0, 1]])
    vertices = np.column_stack([outline, np.zeros(6)])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    plates = slabs(OpenSurface(vertices, faces), 0.005, 0.0015, np.array([0.5, 0.5, -1.0]))
    assert sum(plate.volume for plate in plates) == pytest.approx(0.64 * 0.0015, rel=1e-6)
    notch = np.array([[0.8, 0.8, -0.0007]])
    assert max(depth_below(plate, notch).max() for plate in plates) < 0.0
    assert manifold_of_hull(plates[0]).volume() > 0.0
