"""Front plates of modelled furniture: drawers get boxes, doors a hollow, where all is solid."""

from dataclasses import replace

import numpy as np
import pytest
from modelled_furniture import board, drawer_chest, fridge
from plain_solids import carcass, parted

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.config import SolidsConfig
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.solids.build import solids
from asset_factory.factory.manufacture.solids.skin import bare_fronts
from asset_factory.factory.mesh import concatenate

OUT = np.array([0.0, -1.0, 0.0])
UP = np.array([0.0, 0.0, 1.0])


SLIDE = Joint("slide", JointKind.PRISMATIC, 0, 1, OUT, np.zeros(3), upper=0.3)


def moving(mesh, pieces, joint):
    """A mesh of which some pieces move."""
    own = np.isin(connected_components(mesh), pieces)
    parts = (Part("base", np.flatnonzero(~own)), Part("drawer", np.flatnonzero(own)))
    return located(Articulation(mesh, parts, (joint,), "test"))


def with_drawer(mesh, *pieces):
    """A mesh of which some pieces slide towards the viewer."""
    return moving(mesh, pieces, SLIDE)


def with_door(mesh, *pieces):
    """The same with a hinge at the right."""
    at = np.array([mesh.bounds[1, 0], 0.0, 0.0])
    return moving(mesh, pieces, Joint("hinge", JointKind.REVOLUTE, 0, 1, UP, at, upper=1.5))


CASE = carcass(0.6, 0.4, 0.6)
FRONT = board((0.0, -0.02, 0.0), (0.6, -0.001, 0.6))


def sliding_in_case(**parts):
    """The solids of a hollow case's parts, each on a slide of its own."""
    slides = [
        replace(SLIDE, name=f"{name}_slide", child=child)
        for child, name in enumerate(parts, start=1)
    ]
    return solids(located(parted({"base": CASE, **parts}, *slides)), SolidsConfig())


def test_a_plate_that_slides_is_bare_and_a_box_is_not():
    assert bare_fronts(with_drawer(drawer_chest(), 1, 3)) == (1,)
    box = board((0.05, -0.001, 0.05), (0.55, 0.35, 0.5))
    assert bare_fronts(with_drawer(concatenate([*CASE, FRONT, box]), 5, 6)) == ()


def test_a_door_is_bare_only_where_it_closes_something_solid():
    assert bare_fronts(with_door(fridge(), 1, 3)) == (1,)
    assert bare_fronts(with_door(concatenate([*CASE, FRONT]), 5)) == ()


def test_a_drawer_of_a_solid_chest_gets_a_box_and_room_for_it():
    made = solids(with_drawer(drawer_chest(), 1, 3), SolidsConfig())
    told = {(each.part, each.kind) for each in made.surfaces}
    assert {("drawer", "drawer box"), ("base", "hollow")} <= told
    assert np.ptp(made.articulation.part_mesh(1).vertices[:, 1]) > 0.3
    assert max(hull.vertices[:, 1].max() for hull in made.pieces[1].hulls) > 0.3


def test_a_drawer_of_a_hollow_case_gets_a_box_too():
    made = sliding_in_case(drawer=[FRONT])
    assert ("drawer", "drawer box") in {(each.part, each.kind) for each in made.surfaces}
    assert not any(each.kind == "hollow" for each in made.surfaces)


@pytest.mark.parametrize(("thickness", "known"), [(0.03, None), (0.06, None), (0.13, 0.13)])
def test_a_modelled_door_becomes_a_slab_as_thick_as_it_is(thickness, known):
    case = board((0.0, 0.0, 0.0), (0.6, 0.5, 1.2))
    door = board((0.0, -thickness - 0.001, 0.0), (0.6, -0.001, 1.2))
    given = with_door(concatenate([case, door]), 1)
    base, leaf = given.parts
    told = replace(leaf, panel=replace(leaf.panel, thickness=known))
    made = solids(replace(given, parts=(base, told)), SolidsConfig())
    (back,) = (record for record in made.surfaces if record.kind == "slab back")
    assert back.thickness_m == pytest.approx(thickness, abs=1e-3)


def test_a_front_gets_no_box_where_a_tray_of_its_own_slides():
    low, high = (0.05, 0.03, 0.2), (0.55, 0.36, 0.4)
    ends = ((0.55, 0.36, 0.204), (0.054, 0.36, 0.4), (0.55, 0.034, 0.4))
    begins = ((0.546, 0.03, 0.2), (0.05, 0.356, 0.2))
    tray = [*(board(low, end) for end in ends), *(board(begin, high) for begin in begins)]
    made = sliding_in_case(drawer=[FRONT], tray=tray)
    assert "drawer box" not in {each.kind for each in made.surfaces}


def test_a_handle_taken_for_a_drawer_of_its_own_keeps_its_faces():
    made = sliding_in_case(bar=[board((0.2, -0.1, 0.3), (0.4, -0.02, 0.34))], drawer=[FRONT])
    assert all(len(part.faces) for part in made.articulation.parts)


def test_a_button_in_a_door_has_room_to_be_pressed():
    case = board((0.0, 0.0, 0.0), (0.6, 0.5, 1.2))
    door = board((0.0, -0.061, 0.0), (0.6, -0.001, 1.2))
    button = board((0.28, -0.08, 0.9), (0.32, -0.058, 0.94))
    (hinge,) = with_door(concatenate([case, door]), 1).joints
    press = Joint("press", JointKind.PRISMATIC, 1, 2, -OUT, np.zeros(3), upper=0.015)
    hung = parted({"a": [case], "b": [door], "c": [button]}, hinge, press)
    made = solids(located(hung), SolidsConfig())
    assert made.pieces[1] is not None
    inside = button.vertices + 0.015 * press.axis
    inner = 0.5 * inside + 0.5 * inside.mean(axis=0)
    assert max(depth_below(hull, inner).max() for hull in made.pieces[1].hulls) < 0.0
    assert sum(hull.volume for hull in made.pieces[1].hulls) > 0.9 * 0.6 * 0.06 * 1.2


def test_a_body_behind_a_front_is_left_to_decomposition():
    wires = [board((x, 0.05, 0.3), (x + 0.006, 0.36, 0.306)) for x in (0.1, 0.2, 0.3, 0.4)]
    rails = [board((0.1, y, 0.3), (0.406, y + 0.006, 0.306)) for y in (0.05, 0.354)]
    made = sliding_in_case(drawer=[FRONT], rack=[*wires, *rails])
    assert made.pieces[2] is None
    assert len(made.articulation.parts[2].faces) == sum(len(each.faces) for each in wires + rails)
