"""Masses and inertias against closed forms and symmetries."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box, cylinder
from scipy.spatial.transform import Rotation

from asset_factory.factory.asset import Hull
from asset_factory.factory.config import InertiaConfig
from asset_factory.factory.errors import InvalidAsset
from asset_factory.factory.manufacture.inertia import (
    MIN_GYRATION_M,
    MIN_MASS_KG,
    STEEL,
    carrier_inertial,
    part_inertial,
    weighing,
)
from asset_factory.factory.mesh import Material, Mesh, concatenate
from asset_factory.learn.objects import make_object
from asset_factory.learn.objects.catalog import DEMO_CATEGORIES

DENSITY = 650.0
CONFIG = InertiaConfig()
PLAIN = Material("plain")
UNIT = box((0.0, 0.4), (0.0, 0.3), (0.0, 0.2), PLAIN)


def inertial(mesh, hulls=(), density=DENSITY):
    return part_inertial(mesh, hulls, density, CONFIG)


def box_tensor(mass, x, y, z):
    return mass / 12.0 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])


def inside_out(mesh):
    return Mesh.from_triangles(mesh.vertices, mesh.faces[:, ::-1])


def sheet(x, y):
    return Mesh.from_triangles([(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)], [(0, 1, 2), (0, 2, 3)])


def hull_of(mesh):
    return Hull(mesh.vertices, mesh.faces)


def test_a_box_has_its_textbook_inertia():
    found = inertial(UNIT)
    assert found.mass == pytest.approx(DENSITY * 0.4 * 0.3 * 0.2)
    np.testing.assert_allclose(found.center, [0.2, 0.15, 0.1])
    np.testing.assert_allclose(found.tensor, box_tensor(found.mass, 0.4, 0.3, 0.2), atol=1e-12)


def test_a_cylinder_comes_close_to_its_textbook_inertia():
    radius = 0.1
    height = 0.5
    found = inertial(cylinder(2, (0.0, 0.0), radius, (0.0, height), PLAIN, sides=360))
    mass = DENSITY * np.pi * radius**2 * height
    across = mass * (3 * radius**2 + height**2) / 12
    assert found.mass == pytest.approx(mass, rel=1e-3)
    tensor = np.diag([across, across, mass * radius**2 / 2])
    np.testing.assert_allclose(found.tensor, tensor, rtol=1e-3, atol=1e-9)


@pytest.mark.parametrize("shell", [(False, True), (True, False)], ids=["proper", "all_inside_out"])
def test_a_closed_shell_inside_another_is_a_cavity(shell):
    outer = UNIT
    inner = box((0.02, 0.38), (0.02, 0.28), (0.02, 0.18), PLAIN)
    pairs = zip((outer, inner), shell, strict=True)
    parts = [inside_out(mesh) if turned else mesh for mesh, turned in pairs]
    found = inertial(concatenate(parts))
    solid = DENSITY * 0.4 * 0.3 * 0.2
    hole = DENSITY * 0.36 * 0.26 * 0.16
    assert found.mass == pytest.approx(solid - hole)
    np.testing.assert_allclose(found.center, [0.2, 0.15, 0.1])
    expected = box_tensor(solid, 0.4, 0.3, 0.2) - box_tensor(hole, 0.36, 0.26, 0.16)
    np.testing.assert_allclose(found.tensor, expected, atol=1e-12)


def test_a_solid_inside_a_cavity_counts_again():
    layers = [UNIT, inside_out(box((0.02, 0.38), (0.02, 0.28), (0.02, 0.18), PLAIN))]
    core = box((0.1, 0.2), (0.1, 0.2), (0.05, 0.15), PLAIN)
    with_core = inertial(concatenate([*layers, core])).mass
    assert with_core - inertial(concatenate(layers)).mass == pytest.approx(DENSITY * 1e-3)


def test_a_box_with_a_fin_on_an_edge_weighs_what_both_weigh():
    fin = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.2], [-0.1, 0.0, 0.0]]
    corners = [*UNIT.vertices[UNIT.faces].reshape(-1, 3).round(9).tolist(), *fin]
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    found = inertial(Mesh.from_triangles(vertices, index.reshape(-1, 3))).mass
    assert found - inertial(UNIT).mass == pytest.approx(DENSITY * 0.01 * CONFIG.shell_thickness_m)


def test_overlapping_boxes_count_their_overlap_once():
    other = UNIT.transformed([[1, 0, 0, 0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    found = inertial(concatenate([UNIT, other]))
    assert found.mass == pytest.approx(DENSITY * 0.6 * 0.3 * 0.2)
    tensor = box_tensor(found.mass, 0.6, 0.3, 0.2)
    np.testing.assert_allclose(found.tensor, tensor, rtol=1e-9, atol=1e-12)


def test_two_parts_together_are_the_sum_of_both():
    far = box((1.0, 1.1), (0.0, 0.5), (0.3, 0.5), PLAIN)
    one = inertial(UNIT)
    two = inertial(far)
    both = inertial(concatenate([UNIT, far]))
    assert both.mass == pytest.approx(one.mass + two.mass)
    center = (one.mass * one.center + two.mass * two.center) / both.mass
    np.testing.assert_allclose(both.center, center)
    expected = np.zeros((3, 3))
    for piece in (one, two):
        arm = piece.center - center
        expected += piece.tensor + piece.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    np.testing.assert_allclose(both.tensor, expected, rtol=1e-9, atol=1e-12)


def test_a_sheet_weighs_its_area_times_the_wall_and_its_back_side_adds_nothing():
    plate = sheet(0.5, 0.4)
    found = inertial(plate)
    assert found.mass == pytest.approx(DENSITY * 0.2 * CONFIG.shell_thickness_m)
    expected = box_tensor(found.mass, 0.5, 0.4, CONFIG.shell_thickness_m)
    np.testing.assert_allclose(found.tensor, expected, rtol=1e-3)
    doubled = Mesh.from_triangles(plate.vertices, np.vstack([plate.faces, plate.faces[:, ::-1]]))
    assert inertial(doubled).mass == pytest.approx(found.mass)


def test_a_closed_surface_without_thickness_is_a_sheet():
    flat = box((0.0, 0.5), (0.0, 0.4), (0.0, 1e-6), PLAIN)
    assert inertial(flat).mass == pytest.approx(DENSITY * 0.2 * CONFIG.shell_thickness_m, rel=1e-4)


def test_an_open_box_of_sheets_is_walls_and_not_a_block():
    low = (UNIT.vertices[UNIT.faces][:, :, 2] < 0.2).any(axis=1)
    tray = UNIT.submesh(np.flatnonzero(low))
    area = 0.4 * 0.3 + 2 * 0.4 * 0.2 + 2 * 0.3 * 0.2
    found = inertial(tray)
    assert found.mass == pytest.approx(DENSITY * area * CONFIG.shell_thickness_m)
    assert found.mass < 0.1 * inertial(UNIT).mass
    assert found.center[2] < 0.1


def test_no_part_weighs_more_than_its_filled_hulls():
    plate = sheet(0.5, 0.4)
    hull = hull_of(box((0.0, 0.5), (0.0, 0.4), (-0.0005, 0.0005), PLAIN))
    assert inertial(plate, (hull,)).mass == pytest.approx(DENSITY * hull.volume)
    assert inertial(UNIT, (hull_of(UNIT), hull_of(UNIT))).mass == pytest.approx(inertial(UNIT).mass)


def test_a_part_of_faces_without_area_weighs_what_its_hulls_weigh():
    line = Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    assert inertial(line, (hull_of(UNIT),)).mass == pytest.approx(DENSITY * 0.024)
    assert inertial(line).mass == MIN_MASS_KG


def test_a_crumb_is_lifted_to_what_simulators_can_hold():
    crumb = box((0.0, 1e-4), (0.0, 1e-4), (0.0, 1e-4), PLAIN)
    found = inertial(crumb)
    assert found.mass == MIN_MASS_KG
    np.testing.assert_allclose(
        found.tensor, np.eye(3) * 2 * MIN_MASS_KG * MIN_GYRATION_M**2, atol=1e-20
    )


def test_nothing_at_all_and_no_density_are_refused():
    empty = Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3)))
    with pytest.raises(InvalidAsset, match="carrier_inertial"):
        inertial(empty)
    with pytest.raises(InvalidAsset, match="density is 0"):
        inertial(UNIT, density=0.0)


def test_a_carrier_is_a_light_sphere_at_the_joint():
    child = inertial(UNIT)
    found = carrier_inertial(child, np.array([0.1, 0.2, 0.3]))
    assert found.mass == pytest.approx(0.05 * child.mass)
    np.testing.assert_array_equal(found.center, [0.1, 0.2, 0.3])
    assert len(np.unique(np.linalg.eigvalsh(found.tensor).round(12))) == 1


def test_links_together_weigh_what_is_usual_distributed_as_they_are():
    links = [inertial(UNIT), inertial(box((0.0, 0.1), (0.0, 0.1), (0.0, 0.1), PLAIN))]
    heavier = weighing(links, 40.0, DENSITY)
    assert sum(each.mass for each in heavier) == pytest.approx(40.0)
    for before, after in zip(links, heavier, strict=True):
        factor = after.mass / before.mass
        assert factor == pytest.approx(heavier[0].mass / links[0].mass)
        np.testing.assert_allclose(after.tensor, factor * before.tensor)
        np.testing.assert_array_equal(after.center, before.center)


def test_no_link_becomes_denser_than_steel_or_too_light_for_simulators():
    links = [inertial(UNIT), inertial(box((0.0, 0.02), (0.0, 0.02), (0.0, 0.02), PLAIN))]
    (heaviest, _) = weighing(links, 1e6, DENSITY)
    assert heaviest.mass == pytest.approx(0.4 * 0.3 * 0.2 * STEEL)
    (_, lightest) = weighing(links, 0.1, DENSITY)
    assert lightest.mass == pytest.approx(MIN_MASS_KG)


def lump(seed):
    points = np.random.default_rng(seed).normal(size=(12, 3)) * [0.3, 0.2, 0.1]
    made = trimesh.convex.convex_hull(points)
    return Mesh.from_triangles(made.vertices, made.faces)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000), shift=st.floats(-20.0, 20.0), factor=st.floats(0.3, 3.0))
def test_moving_turning_and_scaling_commute_with_the_inertia(seed, shift, factor):
    mesh = lump(seed)
    rotation = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    matrix = np.eye(4)
    matrix[:3, :3] = factor * rotation
    matrix[:3, 3] = [shift, -shift, shift / 2]
    before = inertial(mesh)
    after = inertial(mesh.transformed(matrix))
    assert after.mass == pytest.approx(before.mass * factor**3, rel=1e-6)
    np.testing.assert_allclose(
        after.center, matrix[:3, :3] @ before.center + matrix[:3, 3], atol=1e-7
    )
    turned = factor**5 * rotation @ before.tensor @ rotation.T
    np.testing.assert_allclose(after.tensor, turned, atol=1e-5 * np.abs(turned).max())


@pytest.mark.parametrize("category", DEMO_CATEGORIES)
def test_generated_objects_weigh_what_such_things_weigh(category):
    articulation = make_object(category, 0)
    masses = [inertial(articulation.part_mesh(i)).mass for i in range(len(articulation.parts))]
    low, high = (0.5, 3.0) if category == "laptop" else (3.0, 200.0)
    assert low < sum(masses) < high
