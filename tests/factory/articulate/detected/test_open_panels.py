"""Panels and screens that are drawn open are closed; what sticks out of others is left alone."""

import numpy as np
import pytest

pytest.importorskip("torch")

from modelled_furniture import board
from plain_solids import box_between, carcass, parted
from tests.factory.articulate.detected.test_detected_articulator import detected

from asset_factory.factory.articulate.detected.open_panels import open_panels, reopened, with_closed
from asset_factory.factory.articulate.detected.screens import open_screen
from asset_factory.factory.articulate.rigid import rigid_articulation
from asset_factory.factory.articulation import Joint, JointKind, rotation_about
from asset_factory.factory.geometry.posing import closed, posed, turned
from asset_factory.factory.intake.stated import Hinge
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.factory.models.detector.canvas import KINDS
from asset_factory.factory.models.detector.detect import Detection
from asset_factory.factory.part import PartKind
from asset_factory.factory.views.view import Views
from asset_factory.learn.objects import make_object
from asset_factory.learn.surfaces import coloured_skin


def seen(kind, opens=0.99):
    """Return a detection of a kind of object; nothing else is asked of it."""
    kinds = np.eye(len(KINDS))[KINDS.index(kind)]
    return Detection(None, np.zeros((5, 64, 64), np.int64), kinds, opens)


def found_open(mesh, detection, one_piece=True):
    """Return what is found to stand open on a mesh."""
    return open_panels(Views(mesh), detection, one_piece=one_piece)


#: Boards, 0.6 wide, 0.4 deep, 0.8 high, open in front.
CASE = concatenate(carcass(0.6, 0.4, 0.8))
#: Closed panels of the case: what, corners, hinge's axis and a point of it.
DOOR = (PartKind.DOOR, (0.0, -0.02, 0.0), (0.6, 0.0, 0.8), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0))
LEAF = (PartKind.DOOR, (0.3, -0.02, 0.0), (0.6, 0.0, 0.8), (0.0, 0.0, 1.0), (0.6, 0.0, 0.0))
OTHER = (PartKind.DOOR, (0.0, -0.02, 0.0), (0.3, 0.0, 0.8), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0))
FLAP = (PartKind.FLAP, (0.0, -0.02, 0.0), (0.6, 0.0, 0.8), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
#: The case on its back is a chest.
LID = (PartKind.LID, (0.0, 0.0, 0.0), (0.6, 0.8, 0.02), (-1.0, 0.0, 0.0), (0.0, 0.8, 0.0))
ON_ITS_BACK = rotation_about([1.0, 0.0, 0.0], -np.pi / 2.0)


def standing_open(panel, degrees, beside=()):
    """Return the case, on its back if need be, with panels open, and the same closed."""
    named = {"body": [CASE.turned(ON_ITS_BACK) if panel is LID else CASE]}
    joints = []
    for number, (_, low, high, axis, origin) in enumerate([panel, *beside], start=1):
        named[f"panel_{number}"] = [board(low, high)]
        hinge = (JointKind.REVOLUTE, 0, number, axis, origin, 0.0, np.pi)
        joints.append(Joint(f"hinge_{number}", *hinge))
    shut = parted(named, *joints)
    return posed(shut, {joint.name: np.radians(degrees) for joint in joints}).mesh, shut.mesh


@pytest.mark.parametrize("degrees", [35.0, 90.0, 120.0])
@pytest.mark.parametrize(
    ("kind", "panel"), [("fridge", DOOR), ("cabinet", LEAF), ("oven", FLAP), ("chest", LID)]
)
def test_a_panel_that_stands_open_closes_about_its_hinge(kind, panel, degrees):
    drawn, shut = standing_open(panel, degrees)
    made = closed(found_open(drawn, seen(kind)))
    (joint,) = made.joints
    assert made.parts[joint.child].kind is panel[0]
    assert joint.kind is JointKind.REVOLUTE
    assert joint.axis == pytest.approx(panel[3], abs=0.02)
    off = np.cross(joint.origin - panel[4], panel[3])
    assert float(np.linalg.norm(off)) < 0.05
    assert joint.lower == 0.0
    assert joint.upper == pytest.approx(max(np.radians(degrees), 1.57), abs=0.03)
    assert made.mesh.bounds == pytest.approx(shut.bounds, abs=0.03)
    assert f"stands open by {degrees:.0f} degrees" in made.notes[0]


def test_two_doors_that_stand_open_both_close():
    made = found_open(standing_open(LEAF, 80.0, [OTHER])[0], seen("wardrobe"))
    assert [made.parts[joint.child].kind for joint in made.joints] == [PartKind.DOOR] * 2
    assert sorted(float(joint.axis[2]) for joint in made.joints) == pytest.approx([-1.0, 1.0])


def test_a_case_with_its_door_closed_or_without_one_is_left_alone():
    assert found_open(standing_open(DOOR, 0.0)[1], seen("cabinet")) is None
    assert found_open(CASE, seen("cabinet")) is None


def test_of_modelled_pieces_only_lids_are_looked_for():
    assert found_open(standing_open(DOOR, 90.0)[0], seen("cabinet"), one_piece=False) is None
    assert found_open(standing_open(LID, 90.0)[0], seen("chest"), one_piece=False) is not None


def test_of_things_that_do_not_open_nothing_closes():
    drawn = standing_open(DOOR, 90.0)[0]
    assert found_open(drawn, seen("shelf")) is None
    assert found_open(drawn, seen("cabinet", opens=0.2)) is None
    assert found_open(drawn, seen("chest")) is None
    assert found_open(standing_open(LID, 90.0)[0], seen("cabinet")) is None


def test_what_would_close_a_solid_face_or_is_a_rail_is_no_panel():
    wing = board((0.0, -0.5, 0.0), (0.02, 0.0, 0.8))
    block = board((0.0, 0.0, 0.0), (0.6, 0.4, 0.8))
    assert found_open(concatenate([block, wing]), seen("cabinet")) is None
    rail = board((0.0, -0.5, 0.7), (0.02, 0.0, 0.72))
    assert found_open(concatenate([CASE, rail]), seen("cabinet")) is None
    sheet = Mesh.from_triangles(np.eye(3) * [1.0, 1.0, 0.0], [[0, 1, 2]])
    assert found_open(sheet, seen("cabinet")) is None


def test_closed_panels_take_the_place_of_what_others_find_there():
    drawn = standing_open(LEAF, 90.0)[0]
    found = found_open(drawn, seen("cabinet"))
    made = closed(found)
    assert reopened(made, found).mesh.bounds == pytest.approx(drawn.bounds)
    named = with_closed(made, made)
    assert [part.name for part in named.parts] == ["base", "door_0"]
    assert len(named.joints) == 1
    assert with_closed(rigid_articulation(drawn, "auto", ()), made) is made


def opened(kind, seed, angle):
    """Return a made object whose first joint is open by an angle [rad]."""
    made = make_object(kind, seed)
    return posed(made, {made.movable_joints[0].name: angle})


@pytest.mark.parametrize("degrees", [70.0, 90.0, 110.0])
def test_a_screen_is_what_stands_on_the_base(degrees):
    screen = open_screen(opened("laptop", 1, np.radians(degrees)).mesh)
    assert screen.hinge is Hinge.BACK
    assert screen.drawn == pytest.approx(degrees, abs=1.5)
    assert 0.02 < screen.box[1] < 0.15


def test_the_hinge_is_where_the_screen_stands():
    laptop = turned(opened("laptop", 2, np.radians(100.0)), np.pi / 2.0)
    assert open_screen(laptop.mesh).hinge is Hinge.LEFT


def test_nothing_stands_on_a_closed_laptop_or_is_a_plate_on_a_fridge():
    assert open_screen(make_object("laptop", 1).mesh) is None
    assert open_screen(make_object("fridge", 4).mesh) is None


def test_a_lying_plate_a_sheet_and_a_tower_have_no_screen():
    base = box_between((0.0, 0.0, 0.0), (0.3, 0.2, 0.02))
    shelf = box_between((0.0, 0.15, 0.15), (0.3, 0.2, 0.155))
    assert open_screen(concatenate([base, shelf])) is None
    assert open_screen(Mesh.from_triangles(np.eye(3) * [1.0, 1.0, 0.0], [[0, 1, 2]])) is None
    assert open_screen(box_between((0.0, 0.0, 0.0), (0.1, 0.1, 2.0))) is None


@pytest.mark.parametrize(
    ("kind", "seed", "degrees", "part"),
    [
        ("laptop", 0, 70.0, PartKind.LID),
        ("laptop", 0, 100.0, PartKind.LID),
        ("fridge", 2, 75.0, PartKind.DOOR),
    ],
)
def test_what_is_open_stays_as_drawn_and_its_joint_closes_it(kind, seed, degrees, part):
    truth = opened(kind, seed, np.radians(degrees))
    drawn = coloured_skin(truth.mesh, 0) if kind == "fridge" else truth.mesh
    made = detected(rigid_articulation(drawn, "auto", ()))[0]
    (joint,) = [each for each in made.joints if each.lower < 0.0]
    assert made.parts[joint.child].kind is part
    assert made.looks_like == kind
    assert joint.lower == pytest.approx(np.radians(-degrees), abs=0.03)
    true = truth.movable_joints[0]
    assert joint.axis == pytest.approx(true.axis, abs=0.02)
    if kind == "laptop":
        assert joint.upper == pytest.approx(max(np.radians(90.0 - degrees), 0.0), abs=0.03)
        off = np.cross(joint.origin - true.origin, true.axis)
        assert float(np.linalg.norm(off)) < 0.03 * float(truth.mesh.extents.max())
    assert made.mesh.bounds == pytest.approx(drawn.bounds, abs=1e-6)
    assert any(f"stands open by {degrees:.0f} degrees" in note for note in made.notes)
