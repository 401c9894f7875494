"""Each step of making solids against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from labelled_skins import SIZE, box_skin, chest, cupboard, labelled, with_more
from plain_solids import box_between, parted

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part, rotation_about
from asset_factory.factory.config import SolidsConfig
from asset_factory.factory.geometry import posing
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import areas_of, doubled_normals
from asset_factory.factory.manufacture.decompose.convex import depth_below, hull_of
from asset_factory.factory.manufacture.separate.clip import SHEET_M
from asset_factory.factory.manufacture.solids.boards import BOTTOM_M, HEIGHT, STOP_M, drawer_box
from asset_factory.factory.manufacture.solids.box import Box
from asset_factory.factory.manufacture.solids.build import solids
from asset_factory.factory.manufacture.solids.bump import APART_M, find_bump
from asset_factory.factory.manufacture.solids.cavity import hollow
from asset_factory.factory.manufacture.solids.frame import working_frame
from asset_factory.factory.manufacture.solids.lattice import Lattice, enclosed
from asset_factory.factory.manufacture.solids.matter import PATH, Matter
from asset_factory.factory.manufacture.solids.pieces import convex_pieces, filled
from asset_factory.factory.manufacture.solids.reach import FAR_M, reaching
from asset_factory.factory.manufacture.solids.seam import CutSkin, cut
from asset_factory.factory.manufacture.solids.skin import border, parts_to_build, skin_parts
from asset_factory.factory.manufacture.solids.surfaces import boundary, inside_of, outside_of, plate
from asset_factory.factory.manufacture.solids.sweep import CLEAR_M
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.views.raster import Side

UNIT = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]])


def lattice(planes=((), (), ()), cells=20):
    return Lattice.over(UNIT, cells, [list(each) for each in planes])


def test_parts_that_are_patches_of_one_surface_are_told_from_bodies():
    assert skin_parts(cupboard()) == (1,)
    assert skin_parts(chest()) == (1, 2)
    body = box_between((-0.3, -0.25, -0.4), (0.3, 0.25, 0.4))
    door = box_between((-0.2, -0.27, -0.3), (0.2, -0.25, 0.3))
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 1.0)
    assert skin_parts(parted({"body": [body], "door": [door]}, hinge)) == ()


@pytest.mark.parametrize(
    ("depth", "framed", "built"), [(0.02, True, (1,)), (0.4, True, ()), (0.4, False, (1,))]
)
def test_a_drawer_deeper_than_high_keeps_its_own_box(depth, framed, built):
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, [0, -1, 0], [0, -0.25, 0.1], 0.0, 0.3)
    ends = depth - SIZE[1] / 2.0
    given = labelled(*box_skin(), [lambda at: (at[:, 2] < 0.2) & (at[:, 1] < ends)], [slide])
    if framed:
        # Sheets of a frame at the same edges: what they divide are pieces of their own.
        edges, _ = border(given.mesh, face_parts(given))
        inner = np.full((len(edges), 1, 3), [0.0, 0.1, 0.5])
        corners = np.concatenate([given.mesh.vertices[edges], inner], axis=1).reshape(-1, 3)
        given = with_more(given, 0, corners, np.arange(len(corners)).reshape(-1, 3))
    assert skin_parts(given) == (1,)
    assert parts_to_build(given) == built


@pytest.mark.parametrize("axis", range(3))
def test_wanted_planes_are_lines_exactly(axis):
    planes = [[], [], []]
    planes[axis] = [0.3333, 0.3339]
    lines = lattice(planes).lines
    assert {0.3333, 0.3339} <= set(lines[axis].tolist())
    assert all((np.diff(line) > 0.0).all() for line in lines)


def test_planes_at_the_ends_split_off_no_layer_of_nothing():
    x, _, z = lattice(([0.001, 0.31], [], [0.999])).lines
    assert 0.31 in x
    assert min(np.diff(x).min(), np.diff(z).min()) > 0.005


@pytest.mark.parametrize("holed", [False, True])
def test_what_a_skin_encloses_survives_a_hole(holed):
    ball = trimesh.creation.icosphere(4, 0.4)
    faces = ball.faces[np.linalg.norm(ball.triangles_center - [0, 0, 0.4], axis=1) > 0.1 * holed]
    mesh = Mesh.from_triangles(ball.vertices + 0.5, faces)
    cells = Lattice.over(mesh.bounds, 40, [[], [], []])
    volume = float((cells.volumes * enclosed(mesh, cells)).sum())
    assert volume == pytest.approx(4.0 / 3.0 * np.pi * 0.4**3, rel=0.05)


@given(st.integers(0, 2), st.floats(-0.24, 0.24))
def test_a_cut_keeps_the_surface_and_leaves_nothing_across_the_plane(axis, offset):
    vertices, faces = box_skin(fine=0.2)
    mesh = Mesh.from_triangles(vertices, faces)
    skin = CutSkin.of(mesh, np.zeros(len(faces), dtype=int))
    normal = np.eye(3)[axis]
    height = offset + (0.4 if axis == 2 else 0.0)
    halves = cut(skin, normal, height, np.ones(len(faces), dtype=bool))
    area = areas_of(halves.corners).sum()
    want = 2.0 * (SIZE[0] * SIZE[1] + SIZE[1] * SIZE[2] + SIZE[2] * SIZE[0])
    assert area == pytest.approx(want, rel=1e-9)
    side = halves.corners @ normal - height
    assert not ((side.min(axis=1) < -1e-6) & (side.max(axis=1) > 1e-6)).any()
    whole = mesh.vertices[mesh.faces][halves.face]
    assert np.allclose(np.einsum("nkc,ncd->nkd", halves.weights, whole), halves.corners)


@pytest.mark.parametrize("side", [Side.FRONT, Side.TOP, Side.RIGHT])
def test_a_hollow_is_the_largest_box_in_what_may_be_hollowed(side):
    cells = lattice(cells=50)
    room = np.zeros(cells.shape, dtype=bool)
    room[cells.span(Box(np.full(3, 0.1), np.full(3, 0.9)))] = True
    turned = Box(UNIT[0] + 0.05, UNIT[1] - 0.05).turned(side.frame)
    inner = Box(np.append(turned.low[:2], turned.low[2] + 0.06), turned.high)
    boxes = hollow(cells, room, inner, side.frame)
    found = Box(boxes[0].low, boxes[-1].high).turned(side.frame.T)
    assert found.size.prod() == pytest.approx(0.8 * 0.8 * 0.79, rel=0.06)


def tapered(depth):
    """Cells of a room that is wider the deeper it goes, and the column below its mouth."""
    cells = lattice(cells=50)
    x, _, z = np.meshgrid(*cells.middles, indexing="ij")
    room = (np.abs(x - 0.5) < 0.1 + 0.3 * z / depth) & (z < depth)
    return cells, room, Box(np.array([0.0, 0.0, -depth]), np.array([1.0, 1.0, 0.0]))


@pytest.mark.parametrize("depth", [0.0776, 0.31, 0.9])
def test_a_tapered_room_is_hollowed_in_steps_without_a_skin_between(depth):
    boxes = hollow(*tapered(depth), Side.TOP.frame)
    widths = [box.size[0] for box in boxes]
    assert len(boxes) > 1
    assert widths == sorted(widths, reverse=True)
    corners = inside_of(boxes, boxes[0].low[2])
    areas = doubled_normals(corners)[:, 2] / 2.0
    mouth = boxes[0].size[0] * boxes[0].size[1]
    assert np.abs(areas).sum() == pytest.approx(mouth, rel=1e-6)


def test_no_room_no_hollow():
    cells = lattice()
    assert hollow(cells, np.zeros(cells.shape, dtype=bool), Box(*UNIT), np.eye(3)) == ()


def test_a_drawer_box_keeps_clear_of_its_room():
    room = Box(np.zeros(3), np.array([0.4, 0.2, 0.5]))
    boards = drawer_box(room, -0.003)
    low = np.min([board.low for board in boards], axis=0)
    high = np.max([board.high for board in boards], axis=0)
    assert low == pytest.approx([CLEAR_M, CLEAR_M, -0.003])
    assert high[[0, 2]] == pytest.approx([0.4 - CLEAR_M, 0.5 - STOP_M])
    assert high[1] - low[1] == pytest.approx(HEIGHT * (0.2 - 2 * CLEAR_M))
    size = high - low
    inside = (size[0] - 0.02) * (size[1] - BOTTOM_M) * (size[2] - 0.01)
    total = sum(board.size.prod() for board in boards)
    assert total == pytest.approx(size.prod() - inside, rel=1e-6)
    assert drawer_box(Box(np.zeros(3), np.array([0.4, 0.024, 0.5])), 0.0) == ()


def test_pieces_of_a_box_around_a_hollow_are_its_walls_exactly():
    cells = lattice(planes=((0.2, 0.8), (0.2, 0.8), (0.2,)))
    inner = Box(np.full(3, 0.2), np.array([0.8, 0.8, np.inf]))
    free = np.zeros(cells.shape, dtype=np.uint8)
    free[cells.span(inner)] = PATH
    whole = np.ones(cells.shape, dtype=bool)
    vertices, _ = box_skin((1.0, 1.0, 1.0), 0.1)
    points = vertices + np.array([0.5, 0.5, 0.0])
    matter = Matter(cells, free == 0, whole, free, points[~inner.holds(points, -1e-9)])
    hulls = convex_pieces(matter, 20)
    assert 5 <= len(hulls) <= 9
    assert sum(hull.volume for hull in hulls) == pytest.approx(1.0 - 0.6 * 0.6 * 0.8, rel=0.02)
    centers = cells.centers(np.argwhere(free > 0))
    for hull in hulls:
        assert depth_below(hull, centers).max() < 1e-3


def test_a_wall_that_is_a_single_sheet_becomes_a_thin_piece():
    cells = lattice()
    solid = np.zeros(cells.shape, dtype=bool)
    solid[10, 2:18, 2:18] = True
    y, z = np.meshgrid(np.linspace(0.1, 0.9, 30), np.linspace(0.1, 0.9, 30))
    sheet = np.column_stack([np.full(y.size, 0.52), y.ravel(), z.ravel()])
    nothing = np.zeros(cells.shape, dtype=bool)
    (wall,) = convex_pieces(Matter(cells, solid, nothing, nothing.astype(np.uint8), sheet), 10)
    assert depth_below(wall, sheet).min() > -1e-6
    assert wall.volume == pytest.approx(0.8 * 0.8 * SHEET_M, rel=1e-3)


@pytest.mark.parametrize("bent", [0.0, 0.002])
def test_a_sheet_thinner_than_cells_leaves_free_what_passes_through_it(bent):
    cells = lattice(cells=60)
    passed = Box(np.array([0.0, 0.3, 0.35]), np.array([1.0, 0.7, 0.6]))
    free = np.zeros(cells.shape, dtype=np.uint8)
    free[cells.span(passed)] = PATH
    solid = np.zeros(cells.shape, dtype=bool)
    solid[31, 6:54, 6:54] = True
    y, z = (each.ravel() for each in np.meshgrid(*[np.linspace(0.1, 0.9, 161)] * 2))
    sheet = np.column_stack([0.52 + bent * np.sin(20.0 * y), y, z])
    seen = sheet[~passed.holds(sheet)]
    nothing = np.zeros(cells.shape, dtype=bool)
    matter = Matter(cells, solid & (free == 0), nothing, free, seen)
    walls = reaching(matter, convex_pieces(matter, 20))
    assert max(depth_below(wall, sheet[passed.holds(sheet, -0.01)]).max() for wall in walls) < 0.0
    assert np.max([depth_below(wall, seen) for wall in walls], axis=0).min() > -0.01


def test_a_knob_begins_clear_of_what_it_stands_on():
    knob = trimesh.creation.cylinder(0.02, 0.03, sections=32)
    points = np.asarray(knob.vertices) + np.array([0, 0, 0.015])
    rim = points[points[:, 2] < 1e-6]
    joint = Joint("turn", JointKind.CONTINUOUS, 0, 1, [0, 0, 1], [0, 0, 0], -np.pi, np.pi)
    bump = find_bump(points, rim, joint)
    assert bump.rule == "cut_base"
    assert bump.hull.vertices[:, 2].min() == pytest.approx(APART_M)
    assert bump.hull.volume == pytest.approx(np.pi * 0.02**2 * (0.03 - APART_M), rel=0.02)


def test_a_button_keeps_its_height_and_its_host_a_pit_for_it():
    vertices, faces = box_skin((0.4, 0.4, 0.4), 0.02)
    button = (np.abs(vertices[:, :2]) < 0.05).all(axis=1) & (vertices[:, 2] > 0.39)
    vertices = vertices + np.array([0.0, 0.0, 0.04]) * button[:, None]
    raised = button[faces].any(axis=1)
    joint = Joint("press", JointKind.PRISMATIC, 0, 1, [0, 0, -1], [0, 0, 0], 0.0, 0.02)
    parts = (Part("body", np.flatnonzero(~raised)), Part("button", np.flatnonzero(raised)))
    mesh = Mesh.from_triangles(vertices, faces)
    body, pressed = solids(Articulation(mesh, parts, (joint,), "test"), SolidsConfig()).pieces
    (hull,) = pressed.hulls
    assert np.ptp(hull.vertices[:, 2]) == pytest.approx(0.04 - APART_M, abs=1e-3)
    way = hull.vertices - np.array([0.0, 0.0, 0.02])
    assert max(depth_below(each, way).max() for each in body.hulls) < -0.002
    assert sum(each.volume for each in body.hulls) > 0.9 * 0.4**3


def test_half_a_wheel_is_turned_into_a_whole_one():
    wheel = trimesh.creation.cylinder(0.05, 0.02, sections=64)
    wheel.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0]))
    points = np.asarray(wheel.vertices)[np.asarray(wheel.vertices)[:, 2] < 0.01]
    rim = points[points[:, 2] > -0.01]
    joint = Joint("spin", JointKind.CONTINUOUS, 0, 1, [0, 1, 0], [0, 0, 0], -np.pi, np.pi)
    bump = find_bump(points, rim, joint)
    assert bump.rule == "lathe"
    assert bump.hull.volume == pytest.approx(np.pi * 0.05**2 * 0.02, rel=0.05)


def test_a_lever_that_turns_all_the_way_is_no_wheel():
    lever = trimesh.creation.box(bounds=[[0.0, -0.01, -0.01], [0.2, 0.01, 0.01]])
    points = np.asarray(lever.vertices)
    joint = Joint("spin", JointKind.CONTINUOUS, 0, 1, [0, 1, 0], [0, 0, 0], -np.pi, np.pi)
    assert find_bump(points, np.zeros((0, 3)), joint) is None


def test_hollows_and_boards_bound_their_volume():
    above = Box(np.array([0.2, 0.2, 1.0]), np.array([0.8, 0.8, 2.0]))
    boxes = (Box(np.zeros(3), np.ones(3)), above)
    assert len(boundary(outside_of(boxes))) == 0
    assert np.unique(np.round(boundary(inside_of(boxes, 0.0))[:, :, 2], 9)).tolist() == [0.0]


def test_a_plate_with_a_hole_has_the_area_of_what_is_left():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    normals = doubled_normals(plate(square, [square * 0.5 + 0.25], 0.3))
    assert normals[:, 2].sum() / 2.0 == pytest.approx(0.75)
    assert (normals[:, 2] > 0.0).all()


@pytest.mark.parametrize("degrees", [0.0, 20.0, -35.0])
def test_the_working_frame_undoes_a_turn_about_the_vertical(degrees):
    turned = posing.turned(chest(), float(np.radians(degrees)))
    frame = working_frame(turned, (1, 2))
    back = frame @ rotation_about([0.0, 0.0, 1.0], np.radians(degrees))
    assert np.abs(back).max(axis=1) == pytest.approx(np.ones(3), abs=1e-3)


LOW = np.full(3, 0.2)
HIGH = np.full(3, 0.8)


@pytest.fixture
def matter():
    """A block of 0.6 m in a room of 1 m, seen on all of its surface."""
    cells = Lattice.over(np.array([[0.0] * 3, [1.0] * 3]), 25, [[0.2, 0.8]] * 3)
    solid = np.zeros(cells.shape, dtype=bool)
    solid[cells.span(Box(LOW, HIGH))] = True
    grid = np.array(np.meshgrid(*[np.linspace(0.2, 0.8, 31)] * 3)).reshape(3, -1).T
    seen = grid[((np.abs(grid - 0.5) > 0.2999).any(axis=1))]
    return Matter(cells, solid, solid, np.zeros(cells.shape, dtype=np.uint8), seen)


def test_a_piece_that_falls_short_reaches_what_is_seen(matter):
    (reached,) = reaching(matter, [Box(LOW, np.array([0.8, 0.8, 0.75])).hull()])
    assert depth_below(reached, matter.sparse).min() >= -FAR_M
    assert reached.volume == pytest.approx(0.6**3, rel=0.02)


def test_pieces_that_cover_all_stay_as_they_are(matter):
    whole = Box(LOW, HIGH).hull()
    (reached,) = reaching(matter, [whole])
    assert reached is whole
    assert reaching(matter, ()) == ()


def test_what_must_stay_free_is_not_filled(matter):
    free = matter.free.copy()
    free[matter.lattice.span(Box(np.array([0.2, 0.2, 0.7]), np.array([0.8, 0.8, 0.76])))] = PATH
    short = Box(LOW, np.array([0.8, 0.8, 0.7])).hull()
    (reached,) = reaching(replace(matter, free=free), [short])
    assert reached.vertices[:, 2].max() < 0.71


def test_air_is_not_filled_to_reach_a_spike(matter):
    spike = np.concatenate([matter.points, [[0.5, 0.5, 0.99]]])
    (reached,) = reaching(replace(matter, points=spike), [Box(LOW, HIGH).hull()])
    assert reached.vertices[:, 2].max() == pytest.approx(0.8)


BOUNDS = np.array([[0.0, 0.0, 0.0], [1.0, 0.7, 0.4]])
LATTICE = Lattice.over(BOUNDS, 24, [[0.31], [0.5], []])
EVERYWHERE = (slice(None), slice(None), slice(None))
POINTS = hnp.arrays(np.float64, (12, 3), elements=st.floats(-0.25, 1.25, width=32))


@given(POINTS, st.floats(-0.05, 0.05), st.integers(0, 10), st.integers(0, 10))
def test_cells_below_all_planes_are_found(points, margin, first, second):
    hull = hull_of(points)
    assume(hull is not None)
    planes = hull.planes * [1.0, 1.0, 1.0, -1.0]
    span = (slice(first, None), slice(second, None), slice(0, 7))
    shape = np.zeros(LATTICE.shape)[span].shape
    at = np.argwhere(np.ones(shape)) + np.array([first, second, 0])
    heights = (LATTICE.centers(at) @ planes[:, :3].T + planes[:, 3]).max(axis=1)
    found = LATTICE.below(planes, span, margin).reshape(-1)
    assume(np.abs(heights - margin).min(initial=1.0) > 1e-9)
    assert (found == (heights < margin)).all()


def test_a_box_of_whole_cells_fills_its_volume():
    box = Box(*(np.array([line[cell] for line in LATTICE.lines]) for cell in (2, 6)))
    twice = np.full(LATTICE.shape, 2, dtype=np.uint8)
    hull = box.hull()
    assert hull is not None
    assert np.isclose(filled(LATTICE, twice, EVERYWHERE, hull), 2.0 * np.prod(box.size))


def test_a_sheet_thinner_than_cells_fills_those_it_crosses():
    middle = LATTICE.middles[2][4]
    low, high = (np.append(end, middle) for end in BOUNDS[:, :2])
    hull = Box(low, high).grown([0.0, 0.0, 5e-4]).hull()
    assert hull is not None
    once = np.ones(LATTICE.shape, dtype=np.uint8)
    assert np.isclose(filled(LATTICE, once, EVERYWHERE, hull), LATTICE.volumes[:, :, 4].sum())
