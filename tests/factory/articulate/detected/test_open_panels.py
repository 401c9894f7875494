"""Panels that stand open are closed; what sticks out of other things is left alone."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("torch")

from modelled_furniture import board
from tests.factory.articulate.detected.test_detected_articulator import detected

from asset_factory.factory.articulate.detected.open_panels import open_panels, reopened, with_closed
from asset_factory.factory.articulate.rigid import rigid_articulation
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.geometry.posing import closed, posed
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.factory.models.detector.canvas import KINDS
from asset_factory.factory.models.detector.detect import Detection
from asset_factory.factory.part import PartKind
from asset_factory.learn.objects import make_object
from asset_factory.learn.surfaces import coloured_skin

OPENS = 0.99


def seen(kind, opens=OPENS):
    """Return a detection of a kind of object; nothing else is asked of it."""
    kinds = np.eye(len(KINDS))[KINDS.index(kind)]
    return Detection(None, np.zeros((5, 64, 64), np.int64), kinds, opens, np.full(4, 0.25))


def turned_about(mesh, axis, origin, degrees):
    """Return a mesh turned about a line."""
    rotation = rotation_about(np.array(axis, dtype=float), np.radians(degrees))
    return replace(mesh, vertices=(mesh.vertices - origin) @ rotation.T + origin)


def case():
    """A case of boards, 0.6 wide, 0.4 deep, 0.8 high, open in front."""
    return concatenate(
        [
            board((0.0, 0.0, 0.0), (0.02, 0.4, 0.8)),
            board((0.58, 0.0, 0.0), (0.6, 0.4, 0.8)),
            board((0.0, 0.38, 0.0), (0.6, 0.4, 0.8)),
            board((0.0, 0.0, 0.0), (0.6, 0.4, 0.02)),
            board((0.0, 0.0, 0.78), (0.6, 0.4, 0.8)),
        ]
    )


#: Closed panels of the case: what, corners, hinge's axis and a point of it.
DOOR = (PartKind.DOOR, (0.0, -0.02, 0.0), (0.6, 0.0, 0.8), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0))
LEAF = (PartKind.DOOR, (0.3, -0.02, 0.0), (0.6, 0.0, 0.8), (0.0, 0.0, 1.0), (0.6, 0.0, 0.0))
FLAP = (PartKind.FLAP, (0.0, -0.02, 0.0), (0.6, 0.0, 0.8), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
#: The case on its back is a chest.
LID = (PartKind.LID, (0.0, 0.0, 0.4), (0.6, 0.8, 0.42), (-1.0, 0.0, 0.0), (0.0, 0.8, 0.4))


def standing_open(panel, degrees):
    """Return the case, on its back if need be, with one panel open, and the same closed."""
    kind, low, high, axis, origin = panel
    body = case()
    if kind is PartKind.LID:
        body = replace(body, vertices=body.vertices[:, [0, 2, 1]] * [1.0, 1.0, -1.0] + [0, 0, 0.4])
    leaf = board(low, high)
    return concatenate([body, turned_about(leaf, axis, np.array(origin), degrees)]), concatenate(
        [body, leaf]
    )


@pytest.mark.parametrize("degrees", [35.0, 90.0, 120.0])
@pytest.mark.parametrize(
    ("kind", "panel"), [("fridge", DOOR), ("cabinet", LEAF), ("oven", FLAP), ("chest", LID)]
)
def test_a_panel_that_stands_open_closes_about_its_hinge(kind, panel, degrees):
    drawn, shut = standing_open(panel, degrees)
    found = open_panels(drawn, seen(kind), one_piece=True)
    made = closed(found)
    (joint,) = made.joints
    part = made.parts[joint.child]
    assert part.kind is panel[0]
    assert joint.kind is JointKind.REVOLUTE
    assert joint.axis == pytest.approx(panel[3], abs=0.02)
    off = np.cross(joint.origin - panel[4], panel[3])
    assert float(np.linalg.norm(off)) < 0.05
    assert joint.lower == 0.0
    assert joint.upper == pytest.approx(max(np.radians(degrees), 1.57), abs=0.03)
    assert made.mesh.bounds == pytest.approx(shut.bounds, abs=0.03)
    assert f"stands open by {degrees:.0f} degrees" in made.notes[0]


def test_two_doors_that_stand_open_both_close():
    both = standing_open(LEAF, 80.0)[0]
    mirrored = board((0.0, -0.02, 0.0), (0.3, 0.0, 0.8))
    made = open_panels(
        concatenate([both, turned_about(mirrored, (0, 0, -1), np.zeros(3), 100.0)]),
        seen("wardrobe"),
        one_piece=True,
    )
    assert [made.parts[joint.child].kind for joint in made.joints] == [PartKind.DOOR] * 2
    assert sorted(float(joint.axis[2]) for joint in made.joints) == pytest.approx([-1.0, 1.0])


def test_a_case_with_its_door_closed_or_without_one_is_left_alone():
    assert open_panels(standing_open(DOOR, 0.0)[1], seen("cabinet"), one_piece=True) is None
    assert open_panels(case(), seen("cabinet"), one_piece=True) is None


def test_of_modelled_pieces_only_lids_are_looked_for():
    assert open_panels(standing_open(DOOR, 90.0)[0], seen("cabinet"), one_piece=False) is None
    assert open_panels(standing_open(LID, 90.0)[0], seen("chest"), one_piece=False) is not None


def test_of_things_that_do_not_open_nothing_closes():
    drawn = standing_open(DOOR, 90.0)[0]
    assert open_panels(drawn, seen("shelf"), one_piece=True) is None
    assert open_panels(drawn, seen("cabinet", opens=0.2), one_piece=True) is None
    assert open_panels(drawn, seen("chest"), one_piece=True) is None
    assert open_panels(standing_open(LID, 90.0)[0], seen("cabinet"), one_piece=True) is None


def test_what_would_close_a_solid_face_or_is_a_rail_is_no_panel():
    wing = board((0.0, -0.5, 0.0), (0.02, 0.0, 0.8))
    block = board((0.0, 0.0, 0.0), (0.6, 0.4, 0.8))
    assert open_panels(concatenate([block, wing]), seen("cabinet"), one_piece=True) is None
    rail = board((0.0, -0.5, 0.7), (0.02, 0.0, 0.72))
    assert open_panels(concatenate([case(), rail]), seen("cabinet"), one_piece=True) is None
    sheet = Mesh.from_triangles(np.eye(3) * [1.0, 1.0, 0.0], [[0, 1, 2]])
    assert open_panels(sheet, seen("cabinet"), one_piece=True) is None


def test_closed_panels_take_the_place_of_what_others_find_there():
    drawn = standing_open(LEAF, 90.0)[0]
    found = open_panels(drawn, seen("cabinet"), one_piece=True)
    made = closed(found)
    assert reopened(made, found).mesh.bounds == pytest.approx(drawn.bounds)
    named = with_closed(made, made)
    assert [part.name for part in named.parts] == ["base", "door_0"]
    assert len(named.joints) == 1
    elsewhere = rigid_articulation(drawn, "auto", ())
    assert with_closed(elsewhere, made) is made


def test_an_open_door_is_closed_before_anybody_else_is_asked():
    made = make_object("fridge", 2)
    (true, *_) = made.movable_joints
    drawn = coloured_skin(posed(made, {true.name: np.radians(75.0)}).mesh, 0)
    told = detected(rigid_articulation(drawn, "auto", ()))[0].articulation
    (joint,) = [each for each in told.joints if each.lower < 0.0]
    assert told.parts[joint.child].kind is PartKind.DOOR
    assert joint.axis == pytest.approx(true.axis, abs=0.02)
    assert joint.lower == pytest.approx(np.radians(-75.0), abs=0.05)
    assert told.mesh.bounds == pytest.approx(drawn.bounds, abs=1e-6)
    assert any("stands open by 75 degrees" in note for note in told.notes)
