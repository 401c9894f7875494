"""A labelled skin becomes solids: convex, clear of one another on all of their way, open inside."""

from dataclasses import replace
from functools import cache
from itertools import combinations

import numpy as np
import pytest
from labelled_skins import SIZE, bin_with_lid, box_skin, chest, cupboard, front, labelled, with_more
from manufactured import manufactured
from plain_solids import signed_volume, sized_box

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.config import SolidsConfig
from asset_factory.factory.intake.categories import UNKNOWN, Category
from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.separate.clip import meeting
from asset_factory.factory.manufacture.solids.boards import SHELF_M, shelf_boards
from asset_factory.factory.manufacture.solids.box import Box
from asset_factory.factory.manufacture.solids.build import solids
from asset_factory.factory.manufacture.solids.panel import DOOR_M
from asset_factory.factory.part import PartKind
from asset_factory.factory.views.raster import Side
from asset_factory.factory.views.view import elevation

CONFIG = SolidsConfig()
#: More than what makes PyBullet's joints jam [m].
CLEAR_M = 0.002
SHELVED = Category("cupboard", "height", 0.9, (0.3, 2.0), shelves=0.3, liner="#ff0000")
KINDS = {
    "cupboard": (cupboard, UNKNOWN),
    "shelves": (cupboard, SHELVED),
    "chest": (chest, SHELVED),
    "bin": (bin_with_lid, SHELVED),
}


@cache
def build(kind):
    make, usual = KINDS[kind]
    return solids(make(), CONFIG, usual=usual)


@pytest.fixture(params=KINDS)
def built(request):
    return build(request.param)


def volume(piece):
    return sum(hull.volume for hull in piece.hulls)


def least_gap(a, b, pose):
    return min(-meeting(one, other, pose).depth for one in a.hulls for other in b.hulls)


def test_parts_keep_clear_of_the_body_on_all_of_their_way_and_of_one_another(built):
    body, *movers = built.pieces
    for joint, mover in zip(built.articulation.joints, movers, strict=True):
        for value in np.linspace(joint.lower, joint.upper, 31):
            assert least_gap(body, mover, joint.motion(value)) > CLEAR_M, (joint.name, value)
    assert all(least_gap(*pair, np.eye(4)) > CLEAR_M for pair in combinations(movers, 2))


def test_pieces_stay_within_the_skin(built):
    low = np.array([-SIZE[0] / 2, -SIZE[1] / 2, 0.0]) - 2e-3
    high = np.array([SIZE[0] / 2, SIZE[1] / 2, SIZE[2]]) + 2e-3
    points = np.concatenate([hull.vertices for piece in built.pieces for hull in piece.hulls])
    assert (points >= low).all()
    assert (points <= high).all()


def test_a_door_is_the_slab_that_its_outline_says():
    # Labels end along triangles' edges and a view's pixels: sides are known to a few millimetres.
    slab = build("cupboard").pieces[1]
    want = (0.4 - 2 * CONFIG.gap_m) * (0.6 - 2 * CONFIG.gap_m) * DOOR_M
    assert volume(slab) == pytest.approx(want, rel=0.08)
    points = np.concatenate([hull.vertices for hull in slab.hulls])
    assert np.ptp(points[:, 1]) == pytest.approx(DOOR_M, abs=1e-4)


def test_a_cupboard_is_walls_around_a_hollow_of_the_recorded_depth():
    (hollow,) = [each for each in build("cupboard").surfaces if each.kind == "hollow"]
    assert hollow.part == "body"
    assert hollow.thickness_m == CONFIG.wall_m
    depth_m = SIZE[1] - DOOR_M - CONFIG.behind_m - CONFIG.wall_m
    assert hollow.depth_m == pytest.approx(depth_m, abs=0.02)
    inside = (0.4 - 2 * CONFIG.wall_m) * (0.6 - 2 * CONFIG.wall_m) * hollow.depth_m
    recess = 0.4 * 0.6 * (DOOR_M + CONFIG.behind_m)
    want = SIZE.prod() - inside - recess
    assert volume(build("cupboard").pieces[0]) == pytest.approx(want, rel=0.05)


def test_a_door_of_its_own_has_a_surface_around_its_slab():
    mesh = build("cupboard").articulation.part_mesh(1)
    assert signed_volume(mesh) == pytest.approx(0.4 * 0.6 * DOOR_M, rel=0.08)


def test_a_frame_behind_a_door_stays_behind():
    # A two-sided front of a shelf or frame right behind the door, in large triangles.
    y, half = -SIZE[1] / 2.0 + DOOR_M + 0.01, SIZE[0] / 2.0 - 0.02
    corners = np.array([[x, y, z] for z in (0.39, 0.45) for x in (-half, half)])
    faces = np.array([[0, 1, 3], [0, 3, 2], [0, 3, 1], [0, 2, 3]])
    door = solids(with_more(cupboard(), 0, corners, faces), CONFIG).articulation.part_mesh(1)
    assert (np.abs(door.bounds[:, 0]) < 0.21).all()


def test_a_drawer_has_a_bottom_two_sides_a_back_and_no_top():
    made = build("chest")
    assert [each.kind for each in made.surfaces].count("drawer box") == 2
    for part in (1, 2):
        hulls = made.pieces[part].hulls
        assert len(hulls) == 5
        low, high = made.articulation.part_mesh(part).bounds
        middle = (low + high) / 2.0
        above = np.array([[middle[0], middle[1], high[2] - 0.03]])
        assert max(depth_below(hull, above)[0] for hull in hulls) < 0.0


def test_a_drawer_of_a_case_open_below_and_behind_has_its_box_too():
    vertices, faces = box_skin()
    edge = np.array([0.0, SIZE[1] / 2.0, 0.0])
    inner = (vertices - edge) * 0.95 + edge
    middle = vertices[faces].mean(axis=1)
    case = faces[(middle[:, 2] > 1e-6) & (middle[:, 1] < SIZE[1] / 2.0 - 1e-6)]
    sheets = np.concatenate([case, case[:, ::-1] + len(vertices)])
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, [0, -1, 0], [0, -0.25, 0.6], 0.0, 0.3)
    vertices, patch = np.concatenate([vertices, inner]), front([-0.2, 0.5], [0.2, 0.7])
    made = solids(labelled(vertices, sheets, [patch], [slide]), CONFIG)
    assert np.ptp(np.concatenate([hull.vertices for hull in made.pieces[1].hulls])[:, 1]) > 0.4


def test_a_drawer_stays_in_its_hollow():
    given = chest()
    far = [replace(joint, upper=1.5) for joint in given.joints]
    made = solids(replace(given, joints=tuple(far)), CONFIG).articulation
    for joint in made.joints:
        assert 0.2 < joint.upper < np.ptp(made.part_mesh(joint.child).bounds[:, 1])
    assert any("its box is" in note for note in made.notes)


def test_a_lid_is_hollow_and_so_is_what_it_closes():
    made = build("bin")
    kinds = {(each.part, each.kind) for each in made.surfaces}
    assert {("body", "hollow"), ("panel_1", "lid hollow")} <= kinds
    assert volume(made.pieces[0]) < 0.4 * SIZE[0] * SIZE[1] * 0.7
    assert volume(made.pieces[1]) < 0.7 * SIZE[0] * SIZE[1] * 0.1
    top = np.array([[0.0, 0.0, 0.74], [0.0, 0.0, 0.3]])
    hulls = (hull for piece in made.pieces for hull in piece.hulls)
    assert max(depth_below(hull, top).max() for hull in hulls) < 0.0


def test_a_high_lid_takes_all_above_its_seam_along():
    seam = 0.25
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [-1, 0, 0], [0, 0.25, seam], 0.0, 1.5)
    given = labelled(*box_skin(), [lambda at: at[:, 2] > seam], [hinge])
    strap = sized_box((0.06, 0.06, 0.4), (0.1, -SIZE[1] / 2.0 - 0.02, seam + 0.25))
    given = with_more(given, 1, *strap)
    lid = replace(given.parts[1], kind=PartKind.LID, panel=None)
    made = solids(located(replace(given, parts=(given.parts[0], lid))), CONFIG).articulation
    # By no more than a triangle's side.
    assert made.part_mesh(0).bounds[1][2] < seam + 0.02
    assert made.part_mesh(0).bounds[0][1] == pytest.approx(-SIZE[1] / 2.0)
    assert made.part_mesh(1).bounds[0][1] == pytest.approx(-SIZE[1] / 2.0 - 0.05)


def test_a_lids_hinge_stays_under_the_cistern_behind_it():
    cistern = sized_box((SIZE[0], 0.2, 1.5), (0.0, SIZE[1] / 2.0 + 0.1, 0.75))
    (joint,) = solids(with_more(bin_with_lid(), 0, *cistern), CONFIG).articulation.joints
    assert 0.69 < joint.origin[2] < SIZE[2] + 0.01


@pytest.mark.parametrize("interior", [True, False])
def test_a_thin_door_goes_through_and_leaves_a_post(interior):
    skin = box_skin(np.array([0.8, 0.08, 2.0]), 0.02)
    framed = [lambda at: (at[:, 1] < -0.039) & (np.abs(at[:, 0]) < 0.3) & (at[:, 2] < 1.9)]
    whole = [lambda at: at[:, 1] < -0.039]
    for patches, left in ((framed, -0.3), (whole, -0.4)):
        hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, -1], [left, -0.04, 1.0], 0.0, 1.5)
        made = solids(labelled(*skin, patches, [hinge]), SolidsConfig(interior=interior))
        body = made.articulation.part_mesh(0)
        at = body.vertices[body.faces].mean(axis=1)
        assert not ((np.abs(at[:, 0]) < 0.25) & (at[:, 2] > 0.05) & (at[:, 2] < 1.8)).any()
        assert made.articulation.part_mesh(1).bounds[:, 1] == pytest.approx([-0.04, 0.04], abs=3e-3)
        post, door = (np.concatenate([each.vertices for each in p.hulls]) for p in made.pieces)
        assert post[:, 2].max() > 1.9
        assert np.ptp(door[:, 1]) == pytest.approx(0.08, abs=5e-3)
        behind = (np.abs(post[:, 0]) < 0.28) & (post[:, 2] > 0.02) & (post[:, 2] < 1.88)
        assert not behind.any()


def test_a_door_of_a_case_that_is_open_behind_does_not_go_through():
    vertices, faces = box_skin()
    shown = vertices[faces].mean(axis=1)
    faces = faces[shown[:, 1] < SIZE[1] / 2 - 1e-6]
    thick = np.concatenate([vertices, (vertices - [0, 0, 0.4]) * 0.9 + [0, 0, 0.4]])
    faces = np.concatenate([faces, faces[:, ::-1] + len(vertices)])
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, -1], [-0.3, -0.25, 0.4], 0.0, 1.5)
    made = solids(labelled(thick, faces, [lambda at: at[:, 1] < -0.249], [hinge]), SolidsConfig())
    assert np.ptp(made.articulation.part_mesh(1).vertices[:, 1]) < 0.06


def test_without_an_interior_nothing_is_hollow():
    made = solids(chest(), replace(CONFIG, interior=False))
    kinds = {each.kind for each in made.surfaces}
    assert "slab back" in kinds
    assert not kinds & {"hollow", "drawer box", "lid hollow"}
    assert volume(made.pieces[0]) > 0.9 * (SIZE.prod() - 0.48 * 0.68 * (DOOR_M + 0.003))


def test_an_opened_object_shows_no_hole(built):
    """Of the body alone, what is seen first from the front and from above faces the viewer."""
    for side in (Side.FRONT, Side.TOP):
        seen = elevation(built.articulation.part_mesh(0), side)
        toward = seen.normal[..., 2][seen.seen] < 1e-6
        assert seen.seen[2:-2, 2:-2].all()
        assert toward.mean() > 0.995


def test_a_lid_that_is_lifted_gets_no_drawers_box():
    hinged = bin_with_lid()
    lift = replace(hinged.joints[0], kind=JointKind.PRISMATIC, axis=np.array([0.0, 0.0, 1.0]))
    lifted = replace(hinged, joints=(replace(lift, upper=0.2),))
    kinds = {record.kind for record in solids(lifted, CONFIG).surfaces}
    assert "lid hollow" in kinds
    assert "drawer box" not in kinds


def test_a_skin_is_built_once_says_what_was_invented_and_is_kept(tmp_path):
    asset, _, stages = manufactured(cupboard(), tmp_path)
    assert stages.done == ["solids", "finish"]
    assert {body.decomposition for body in asset.bodies} == {"built"}
    assert {"hollow", "slab back", "rim", "frame"} <= {each.kind for each in asset.invented}
    again, _, stages = manufactured(cupboard(), tmp_path)
    assert (stages.done, stages.reused) == ([], ["solids", "finish"])
    assert again.invented == asset.invented
    for one, other in zip(asset.bodies, again.bodies, strict=True):
        hulls = zip(one.hulls, other.hulls, strict=True)
        assert all(a.vertices.tobytes() == b.vertices.tobytes() for a, b in hulls)


HOLLOW = Box(np.array([-0.3, 0.1, 0.0]), np.array([0.3, 1.0, 0.5]))


@pytest.mark.parametrize(("spacing", "count"), [(0.3, 2), (0.4, 1), (0.7, 0), (2.0, 0)])
def test_shelves_divide_a_hollow_evenly(spacing, count):
    boards = shelf_boards(HOLLOW, spacing)
    assert len(boards) == count
    edges = [0.1, *((board.low[1] + board.high[1]) / 2.0 for board in boards), 1.0]
    np.testing.assert_allclose(np.diff(edges), 0.9 / (count + 1))
    for board in boards:
        assert board.size[1] == pytest.approx(SHELF_M)
        assert board.low[2] > HOLLOW.low[2]
        np.testing.assert_array_equal(board.size[[0]], HOLLOW.size[[0]])
    assert shelf_boards(Box(HOLLOW.low, np.array([0.3, 1.0, 0.05])), spacing) == ()


def test_a_cupboard_has_shelves():
    shelved = build("shelves")
    (shelf,) = [each for each in shelved.surfaces if each.kind == "shelf"]
    assert (shelf.part, shelf.rule) == ("body", "usual")
    # As high as the middle of the hollow, where the plain one is empty.
    middle = np.array([[0.0, 0.1, SIZE[2] / 2.0]])
    filled = [any((depth_below(hull, middle) > 0.0).all() for hull in each.pieces[0].hulls)
              for each in (build("cupboard"), shelved)]  # fmt: skip
    assert filled == [False, True]


def test_the_inside_has_its_own_colour():
    colors = {each.name: each.color for each in build("shelves").articulation.mesh.materials}
    assert colors["liner_body"] == colors["liner_panel_1"] == (1.0, 0.0, 0.0, 1.0)
    assert colors["inner_body"] != colors["liner_body"]


@pytest.mark.parametrize("kind", ["chest", "bin"])
def test_neither_drawers_nor_lids_have_shelves(kind):
    assert "shelf" not in {each.kind for each in build(kind).surfaces}
