"""Triangles of any kind become solids, cavities and sheets, and these become convex pieces.

Nothing native sees anything but what passes the gate.
"""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Manifold
from plain_solids import sized_box as box
from plain_solids import sized_hull

from asset_factory.factory.config import DecomposeConfig
from asset_factory.factory.manufacture.decompose.convex import depth_below, hull_of, limit_vertices
from asset_factory.factory.manufacture.decompose.cut import cut_along_faces
from asset_factory.factory.manufacture.decompose.merge import merge
from asset_factory.factory.manufacture.decompose.openings import capped
from asset_factory.factory.manufacture.decompose.outside import uncovered
from asset_factory.factory.manufacture.decompose.pockets import fills_little
from asset_factory.factory.manufacture.decompose.sheets import slabs
from asset_factory.factory.manufacture.decompose.simplify import smoothed
from asset_factory.factory.manufacture.decompose.solids import (
    OpenSurface,
    closes,
    contains,
    gate,
    manifold_of,
    manifold_of_hull,
    triangles_of,
)


def together(*meshes):
    vertices = [own for own, _ in meshes]
    offset = np.cumsum([0, *map(len, vertices[:-1])])
    faces = [own + start for (_, own), start in zip(meshes, offset, strict=True)]
    return np.concatenate(vertices), np.concatenate(faces)


def welded(mesh):
    vertices, index = np.unique(np.round(mesh[0], 9), axis=0, return_inverse=True)
    return vertices, index.reshape(-1)[mesh[1]]


def open_box(size):
    """A box without its upper face."""
    vertices, faces = box(size)
    return vertices, faces[~(vertices[faces][:, :, 2] > 0).all(axis=1)]


def volumes(mesh):
    return sorted(round(solid.volume(), 9) for solid in gate(*mesh).solids)


def test_a_pane_at_the_corners_of_its_frame_is_a_sheet():
    # Beside a box, not in it, and hung from two of its corners.
    vertices, faces = box((1, 1, 1))
    hung = np.flatnonzero((vertices[:, 0] > 0) & (vertices[:, 1] > 0))
    vertices = np.concatenate([vertices, [[2.0, 0.5, 0.0]]])
    pane = np.array([[*hung, 8], [*hung[::-1], 8]])
    gated = gate(vertices, np.concatenate([faces, pane]))
    assert [solid.volume() for solid in gated.solids] == pytest.approx([1.0])
    assert [len(sheet.faces) for sheet in gated.sheets] == [1]


def test_boxes_that_share_welded_faces_edges_or_corners_come_apart():
    for at in ((1, 0, 0), (1, 1, 0), (1, 1, 1)):
        assert volumes(welded(together(box((1, 1, 1)), box((1, 1, 1), at)))) == [1.0, 1.0]


def test_a_grain_at_a_bodys_corner_is_nothing():
    vertices, faces = box((1, 1, 1))
    grain = 5e-5 * (vertices - vertices.min(axis=0)) + vertices.max(axis=0)
    assert volumes(welded(together((vertices, faces), (grain, faces)))) == [1.0]


def test_a_body_that_stands_out_of_another_does_not_lie_in_it_however_little_does():
    outer = Manifold.cube([1.0, 1.0, 1.0], True)
    inner = Manifold.cube([0.5, 0.5, 0.5], True)
    assert contains(outer, inner)
    assert not contains(outer, inner + Manifold.cube([0.01, 0.01, 1.2], True))


def test_an_open_box_is_a_sheet_wound_one_way():
    vertices, faces = box((1, 1, 1))
    faces = faces[faces.min(axis=1) >= 0][2:].copy()
    faces[::2] = faces[::2, ::-1]
    gated = gate(vertices, faces)
    assert not gated.solids
    assert len(gated.sheets) == 1
    corners = gated.sheets[0].vertices[gated.sheets[0].faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = np.einsum("ij,ij->i", across, corners[:, 0])
    assert abs(np.sign(outward).sum()) == len(outward)


def test_an_open_surface_is_refused_before_anything_native_sees_it():
    # Five faces of a box corner: on odd numbers of faces like these manifold3d 3.5 dies of a
    # segmentation fault.
    faces = np.array([[35, 33, 31], [33, 11, 9], [31, 9, 7], [33, 35, 11], [31, 33, 9]])
    assert not closes(faces)
    assert manifold_of(np.random.default_rng(0).normal(size=(36, 3)), faces) is None


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 9), st.integers(1, 24))
def test_any_soup_is_gated_without_a_crash_and_only_closed_positive_solids_come_out(
    seed, vertex_count, face_count
):
    random = np.random.default_rng(seed)
    faces = random.integers(0, vertex_count, size=(face_count, 3))
    faces = np.concatenate([faces, faces[random.random(face_count) < 0.5][:, ::-1]])
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    gated = gate(random.normal(size=(vertex_count, 3)), faces)
    for solid in (*gated.solids, *gated.cavities):
        assert solid.volume() > 0.0
        assert closes(triangles_of(solid)[1])


def test_a_pipe_with_hidden_open_ends_is_closed_and_a_box_without_a_lid_is_not():
    pipe = trimesh.creation.cylinder(radius=0.01, height=0.5, sections=24)
    flat = np.abs(pipe.face_normals[:, 2]) < 0.5
    solid = capped(gate(np.array(pipe.vertices), np.array(pipe.faces)[flat]).sheets[0])
    assert solid.volume() == pytest.approx(pipe.volume, rel=1e-6)
    assert capped(gate(*open_box((1, 1, 1))).sheets[0]) is None


def test_simplifying_keeps_a_closed_solid_of_nearly_the_same_volume():
    sphere = trimesh.creation.icosphere(subdivisions=4, radius=0.2)
    solid = manifold_of(np.array(sphere.vertices), np.array(sphere.faces))
    light = smoothed(solid, 0.005, DecomposeConfig(max_faces=400))
    assert light.num_tri() <= 400
    assert light.volume() == pytest.approx(solid.volume(), rel=0.03)


def solid_box(size, at=(0, 0, 0)):
    return Manifold.cube(size).translate(at)


def round_hole(diameter):
    """What makes a round hole in a board of 0.4 x 0.3 x 0.1 m."""
    cylinder = Manifold.cylinder(0.2, diameter / 2, diameter / 2, 16)
    return cylinder.translate((0.2, 0.1, -0.05))


def hull_box(size, at=(0, 0, 0)):
    return sized_hull(size, np.add(at, np.array(size) / 2.0))


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
        assert fills_little(hull_box((0.4, 0.3, 0.1)), board - cut, 0.005, 0.01) is allowed


def test_boards_and_the_bars_of_a_frame_are_cut_exactly():
    boards = solid_box((0.4, 0.3, 0.02)) + solid_box((0.02, 0.3, 0.4))
    bars = solid_box((1.0, 0.05, 2.0)) - solid_box((0.8, 0.05, 1.8), (0.1, 0.0, 0.1))
    for shape, count in ((boards, 2), (bars, 4)):
        cut = cut_along_faces(shape, 0.005, DecomposeConfig())
        assert (cut.method, len(cut.hulls)) == ("exact", count)
        assert sum(hull.volume for hull in cut.hulls) == pytest.approx(shape.volume(), rel=1e-9)


def test_cutting_gives_up_beyond_the_limit():
    comb = solid_box((0.5, 0.1, 0.02))
    for tooth in range(8):
        comb = comb + solid_box((0.02, 0.1, 0.2), (0.06 * tooth, 0, 0))
    assert cut_along_faces(comb, 0.005, DecomposeConfig(), 4) is None
    assert cut_along_faces(comb, 0.005, DecomposeConfig()) is not None


def test_halves_of_a_board_are_joined_and_the_legs_of_a_table_are_not():
    halves = [hull_box((0.5, 0.5, 0.02)), hull_box((0.5, 0.5, 0.02), (0.5, 0, 0))]
    assert [hull.volume for hull in merge(halves, 0.005)] == pytest.approx([0.01])
    legs = [hull_box((0.05, 0.05, 0.7), (x, 0, 0)) for x in (0.0, 0.3, 0.6)]
    assert len(merge([*legs, hull_box((0.65, 0.5, 0.02), (0, 0, 0.7))], 0.005)) == 4


def test_joining_covers_whatever_was_given():
    places = np.random.default_rng(3).random((40, 3)) * [0.2, 0.2, 0.01]
    hulls = [hull_box((0.03, 0.03, 0.01), place) for place in places]
    merged = merge(hulls, 0.005)
    assert len(merged) < len(hulls)
    assert uncovered(merged, np.concatenate([hull.vertices for hull in hulls])) < 1e-9


def test_an_open_box_becomes_five_walls_with_room_between():
    walls = slabs(OpenSurface(*open_box((0.4, 0.3, 0.2))), 0.005, 0.0015, np.zeros(3))
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
