"""Masses and inertias against closed forms and symmetries, and whole objects as heavy as usual."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from export_samples import hull_of
from hypothesis import given, settings
from hypothesis import strategies as st
from manufactured import manufactured
from plain_solids import box
from scipy.spatial.transform import Rotation

from asset_factory.factory.config import InertiaConfig
from asset_factory.factory.errors import InvalidAsset
from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.intake.categories import usual_of
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

DENSITY = 650.0
CONFIG = InertiaConfig()
WALL_M = CONFIG.shell_thickness_m
PLAIN = Material("plain")
UNIT = box((0.0, 0.4), (0.0, 0.3), (0.0, 0.2), PLAIN)
HOLE = box((0.02, 0.38), (0.02, 0.28), (0.02, 0.18), PLAIN)


def inertial(mesh, hulls=(), density=DENSITY):
    return part_inertial(mesh, hulls, density, CONFIG)


def inside_out(mesh):
    return Mesh.from_triangles(mesh.vertices, mesh.faces[:, ::-1])


def two_sided(mesh):
    return Mesh.from_triangles(mesh.vertices, np.vstack([mesh.faces, mesh.faces[:, ::-1]]))


def without_top(mesh):
    return mesh.submesh(np.flatnonzero((mesh.vertices[mesh.faces][:, :, 2] < 0.2).any(axis=1)))


SHEET = Mesh.from_triangles(
    [(0, 0, 0), (0.5, 0, 0), (0.5, 0.4, 0), (0, 0.4, 0)], [(0, 1, 2), (0, 2, 3)]
)
LINE = Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])


def filled(center, size, sign=1.0):
    """Mass, first and second moments about the origin of a box of the material."""
    mass = sign * DENSITY * np.prod(size)
    center = np.array(center)
    return mass, mass * center, mass * (np.outer(center, center) + np.diag(np.square(size)) / 12.0)


def together(*boxes):
    """Mass, centre and inertia tensor about it of boxes together."""
    mass, first, second = (sum(each) for each in zip(*boxes, strict=True))
    center = first / mass
    about = second - mass * np.outer(center, center)
    return mass, center, np.trace(about) * np.eye(3) - about


BLOCK = filled((0.2, 0.15, 0.1), (0.4, 0.3, 0.2))
HOLLOW = filled((0.2, 0.15, 0.1), (0.36, 0.26, 0.16), -1.0)
PLATE = filled((0.25, 0.2, 0.0), (0.5, 0.4, WALL_M))
WALLS = [
    filled((0.2, 0.15, 0.0), (0.4, 0.3, WALL_M)),
    *(filled((x, 0.15, 0.1), (WALL_M, 0.3, 0.2)) for x in (0.0, 0.4)),
    *(filled((0.2, y, 0.1), (0.4, WALL_M, 0.2)) for y in (0.0, 0.3)),
]
CORE = box((0.1, 0.2), (0.1, 0.2), (0.05, 0.15), PLAIN)
BESIDE = box((0.2, 0.6), (0.0, 0.3), (0.0, 0.2), PLAIN)
FAR = box((1.0, 1.1), (0.0, 0.5), (0.3, 0.5), PLAIN)
FLAT = box((0.0, 0.5), (0.0, 0.4), (0.0, 1e-6), PLAIN)
FORMS = {
    "a box": ([UNIT], [BLOCK]),
    "a cavity": ([UNIT, inside_out(HOLE)], [BLOCK, HOLLOW]),
    "all inside out": ([inside_out(UNIT), HOLE], [BLOCK, HOLLOW]),
    "a solid in a cavity": (
        [UNIT, inside_out(HOLE), CORE],
        [BLOCK, HOLLOW, filled((0.15, 0.15, 0.1), (0.1, 0.1, 0.1))],
    ),
    "an overlap, counted once": ([UNIT, BESIDE], [filled((0.3, 0.15, 0.1), (0.6, 0.3, 0.2))]),
    "two apart": ([UNIT, FAR], [BLOCK, filled((1.05, 0.25, 0.4), (0.1, 0.5, 0.2))]),
    "a sheet": ([SHEET], [PLATE]),
    "a sheet with a back side": ([two_sided(SHEET)], [PLATE]),
    "closed without thickness": ([FLAT], [PLATE]),
    "an open box of sheets": ([without_top(UNIT)], WALLS),
}


@pytest.mark.parametrize("name", FORMS)
def test_a_part_has_the_textbook_inertia_of_the_boxes_that_it_consists_of(name):
    meshes, boxes = FORMS[name]
    found = inertial(concatenate(meshes))
    mass, center, tensor = together(*boxes)
    assert found.mass == pytest.approx(mass, rel=1e-5)
    np.testing.assert_allclose(found.center, center, atol=1e-6)
    np.testing.assert_allclose(found.tensor, tensor, rtol=1e-3, atol=1e-9)


def test_a_box_with_a_fin_on_an_edge_weighs_what_both_weigh():
    fin = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.2], [-0.1, 0.0, 0.0]]
    corners = [*UNIT.vertices[UNIT.faces].reshape(-1, 3).round(9).tolist(), *fin]
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    found = inertial(Mesh.from_triangles(vertices, index.reshape(-1, 3))).mass
    assert found - inertial(UNIT).mass == pytest.approx(DENSITY * 0.01 * WALL_M)


THIN = hull_of(box((0.0, 0.5), (0.0, 0.4), (-0.0005, 0.0005), PLAIN))


@pytest.mark.parametrize(
    ("mesh", "hulls", "mass"),
    [
        (SHEET, (THIN,), DENSITY * THIN.volume),
        (UNIT, (hull_of(UNIT), hull_of(UNIT)), DENSITY * 0.024),
        (LINE, (hull_of(UNIT),), DENSITY * 0.024),
        (LINE, (), MIN_MASS_KG),
    ],
    ids=["less than its surface", "as much", "without an area", "without hulls either"],
)
def test_no_part_weighs_more_than_its_filled_hulls_or_too_little(mesh, hulls, mass):
    assert inertial(mesh, hulls).mass == pytest.approx(mass)


def test_a_crumb_is_lifted_to_what_simulators_can_hold():
    found = inertial(box((0.0, 1e-4), (0.0, 1e-4), (0.0, 1e-4), PLAIN))
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


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 1000), shift=st.floats(-20.0, 20.0), factor=st.floats(0.3, 3.0))
def test_moving_turning_and_scaling_commute_with_the_inertia(seed, shift, factor):
    lump = np.random.default_rng(seed).normal(size=(12, 3)) * [0.3, 0.2, 0.1]
    made = trimesh.convex.convex_hull(lump)
    mesh = Mesh.from_triangles(made.vertices, made.faces)
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


def mass_of(whole, kept, **known):
    asset, *_ = manufactured(whole, kept, **known)
    return sum(body.inertial.mass for body in asset.bodies)


def test_an_object_weighs_what_is_usual_of_its_category_or_what_is_stated(kept):
    whole = make_object("microwave", seed=1)
    plain = mass_of(whole, kept)
    want = usual_of("microwave").bulk * closed(whole).mesh.extents.prod()
    assert mass_of(whole, kept, category="microwave") == pytest.approx(want)
    seen = replace(whole, looks_like="microwave")
    assert mass_of(seen, kept) == pytest.approx(want)
    assert mass_of(seen, kept, category="cabinet") == pytest.approx(plain)
    stated = mass_of(whole, kept, category="microwave", density=1300.0)
    assert stated == pytest.approx(2.0 * plain, rel=0.01)
