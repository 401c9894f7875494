"""Which surfaces are boxes, and along which edge an axis was meant to go."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.sim_checks.geometry.boxy import edge_meant
from asset_factory.sim_checks.geometry.kinematics import rotation_about
from asset_factory.sim_checks.geometry.placing import placed
from asset_factory.sim_checks.read.primitives import box, cylinder, ellipsoid

UP = np.array([0.0, 0.0, 1.0])
AHEAD = np.array([0.0, 1.0, 0.0])
DOOR = box(np.array([0.6, 0.02, 0.8]))


def turned(mesh, rotation):
    return mesh[0] @ rotation.T, mesh[1]


def joined(*meshes):
    starts = np.cumsum([0, *(len(points) for points, _ in meshes)])[:-1]
    vertices = np.vstack([points for points, _ in meshes])
    return vertices, np.vstack([f + start for (_, f), start in zip(meshes, starts, strict=True)])


def tilted(degrees, about=AHEAD):
    return rotation_about(about, np.radians(degrees)) @ UP


@given(seed=st.integers(0, 10_000), size=st.tuples(*[st.floats(0.02, 2.0)] * 3))
def test_an_edge_of_a_box_is_found_however_it_is_turned(seed, size):
    rng = np.random.default_rng(seed)
    about = rng.normal(size=3)
    rotation = rotation_about(about / np.linalg.norm(about), rng.uniform(0.0, 3.0))
    one, other, _ = rng.permutation(rotation.T)
    axis = rotation_about(other, np.radians(rng.uniform(1.0, 10.0))) @ one
    assert edge_meant(*turned(box(np.array(size)), rotation), axis) == pytest.approx(one)


NOTHING = np.zeros((0, 3)), np.zeros((0, 3), np.int64)
NO_AREA = np.zeros((3, 3)), np.array([[0, 1, 2]])
TRIANGLE = np.eye(3), np.array([[0, 1, 2]])


@pytest.mark.parametrize("mesh", [ellipsoid(np.full(3, 0.3)), NOTHING, NO_AREA, TRIANGLE])
def test_a_ball_a_triangle_or_nothing_is_no_box(mesh):
    assert edge_meant(*mesh, tilted(10.0)) is None


@given(st.floats(0.0, 2.0 * np.pi))
def test_a_round_lid_is_hinged_anywhere(angle):
    across = np.array([np.cos(angle), np.sin(angle), 0.0])
    edge = edge_meant(*cylinder(0.3, 0.02), across)
    assert edge is None or edge == pytest.approx(across, abs=0.01)


@pytest.mark.parametrize("degrees", [0.5, 4.0, 10.0, 30.0])
@pytest.mark.parametrize("about", [AHEAD, [1.0, 0.0, 0.0], [0.6, 0.8, 0.0]], ids=str)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_door_is_meant_to_turn_about_the_edge_that_is_nearest(degrees, about, sign):
    edge = edge_meant(*DOOR, sign * tilted(degrees, np.array(about)))
    assert edge == pytest.approx(sign * UP, abs=1e-9)


def test_a_lattice_that_is_askew_makes_no_frame_askew():
    bars = box(np.array([0.005, 0.08, 0.8]))
    lattice = [
        placed_at(turned(bars, rotation_about(AHEAD, np.radians(7.0))), x)
        for x in np.linspace(-0.2, 0.2, 9)
    ]
    sash = joined(placed_at(box(np.array([0.6, 0.02, 0.02])), 0.0, 0.41), *lattice)
    assert edge_meant(*sash, UP) is None


def placed_at(mesh, x, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, 0.0, z
    return placed(mesh[0], pose), mesh[1]
