"""A laptop that is drawn open closes; one that is closed is left to the others."""

import numpy as np
import pytest

pytest.importorskip("torch")

from plain_solids import box_between
from tests.factory.articulate.detected.test_detected_articulator import detected

from asset_factory.factory.articulate.detected.screens import open_screen
from asset_factory.factory.articulate.rigid import rigid_articulation
from asset_factory.factory.geometry.posing import posed, turned
from asset_factory.factory.intake.stated import Hinge
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.factory.part import PartKind
from asset_factory.learn.objects import make_object


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


@pytest.mark.parametrize("degrees", [70.0, 100.0])
def test_an_open_laptop_stays_as_drawn_and_its_joint_closes_it(degrees):
    truth = opened("laptop", 0, np.radians(degrees))
    made = detected(rigid_articulation(truth.mesh, "auto", ()))[0].articulation
    (joint,) = made.joints
    assert made.parts[joint.child].kind is PartKind.LID
    assert made.looks_like == "laptop"
    assert joint.lower == pytest.approx(np.radians(-degrees), abs=0.03)
    assert joint.upper == pytest.approx(max(np.radians(90.0 - degrees), 0.0), abs=0.03)
    true = truth.movable_joints[0]
    assert joint.axis == pytest.approx(true.axis, abs=0.02)
    off = np.cross(joint.origin - true.origin, true.axis)
    assert float(np.linalg.norm(off)) < 0.03 * float(truth.mesh.extents.max())
    assert made.mesh.bounds == pytest.approx(truth.mesh.bounds, abs=1e-6)
    assert f"stands open by {degrees:.0f} degrees" in made.notes[0]
