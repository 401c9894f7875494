"""Pieces are closed and face outwards, and a mesh of them is the sum of them."""

from __future__ import annotations

import manifold3d
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.training.objects.limbs import Limb, built, swinging
from asset_factory.factory.training.objects.looks import STEEL, WHITE
from asset_factory.factory.training.objects.pieces import (
    Block,
    Form,
    Piece,
    extruded,
    frustum,
    holed,
    hoop,
    pipe,
    rod,
    turned,
)


def volume(form: Form) -> float:
    solid = manifold3d.Manifold(
        manifold3d.Mesh64(np.ascontiguousarray(form.vertices), form.faces.astype(np.uint64))
    )
    assert solid.status() == manifold3d.Error.NoError
    return float(solid.volume())


def polygon_area(sides: int, radius: float) -> float:
    return 0.5 * sides * radius**2 * float(np.sin(2 * np.pi / sides))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_turned_rods_and_hoops_have_the_volume_of_their_polygons(axis: int) -> None:
    span = (0.2, 0.5)
    assert volume(rod(axis, (0.1, -0.2), 0.05, span, STEEL, 12)) == pytest.approx(
        0.3 * polygon_area(12, 0.05)
    )
    cone = turned(axis, (0.0, 0.0), [(0.0, 0.1), (0.3, 0.05)], STEEL, 12)
    frustum_volume = (
        0.3
        / 3
        * (polygon_area(12, 0.1) + polygon_area(12, 0.05) + polygon_area(12, np.sqrt(0.1 * 0.05)))
    )
    assert volume(cone) == pytest.approx(frustum_volume)
    ring = hoop(axis, (0.1, 0.3), (0.04, 0.06), span, STEEL, 24)
    assert volume(ring) == pytest.approx(0.3 * (polygon_area(24, 0.06) - polygon_area(24, 0.04)))


def test_extruded_and_frustum_have_the_volume_of_prisms() -> None:
    assert volume(extruded(1, [(0, 0), (2, 0), (0, 1)], (0, 3), STEEL)) == pytest.approx(3.0)
    assert volume(frustum(0, ((0, 1), (0, 1)), ((0, 1), (0, 1)), (0, 2), STEEL)) == pytest.approx(
        2.0
    )


def test_a_holed_plate_lacks_its_hole() -> None:
    plate = holed((0.0, 0.6), (0.1, 1.0), (0.3, 0.5), 0.2, (0.0, 0.02), STEEL)
    whole = 0.6 * 0.9 * 0.02
    assert whole - np.pi * 0.2**2 * 0.02 < volume(plate) < whole - 0.97 * np.pi * 0.2**2 * 0.02
    np.testing.assert_allclose(plate.vertices.min(axis=0), [0.0, 0.0, 0.1], atol=1e-12)
    np.testing.assert_allclose(plate.vertices.max(axis=0), [0.6, 0.02, 1.0], atol=1e-12)


@given(st.integers(0, 2), st.floats(0.02, 0.2), st.booleans())
@settings(max_examples=20, deadline=None)
def test_pipes_face_outwards_whichever_way_they_bend(axis: int, bulge: float, flip: bool) -> None:
    t = np.linspace(-1.0, 1.0, 9)
    path: npt.NDArray[np.float64] = np.zeros((9, 3))
    path[:, axis], path[:, (axis + 1) % 3] = 0.2 * t, bulge * (1 - t**2) * (-1 if flip else 1)
    length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    assert volume(pipe(path, 0.005, STEEL, 8)) == pytest.approx(
        length * polygon_area(8, 0.005), rel=0.15
    )


def test_built_keeps_every_piece_in_its_part_and_stands_it_on_the_ground() -> None:
    door_x, door_z = (1.0, 2.0), (3.0, 4.0)
    door: list[Piece] = [
        Block(door_x, (-0.1, 0.0), door_z, WHITE),
        rod(1, (3.5, 1.9), 0.01, (-0.2, -0.1), STEEL),
    ]
    latch = Limb(
        "latch",
        (Block((1.9, 1.95), (-0.3, -0.2), (3.1, 3.2), STEEL),),
        JointKind.PRISMATIC,
        (1, 0, 0),
        (0, 0, 0),
        0.1,
        "door",
    )
    made = built(
        [Block(door_x, (0.1, 1.0), (3.0, 4.0), WHITE)],
        [swinging("door", door, door_x, door_z, -0.1, "left", 1.5), latch],
    )
    assert [len(part.faces) for part in made.parts] == [12, 12 + 4 * 12 - 4, 12]
    np.testing.assert_allclose(made.mesh.bounds[0], [-0.5, -0.65, 0.0], atol=1e-12)
    assert [joint.parent for joint in made.joints] == [0, 1]
    np.testing.assert_allclose(made.joints[0].origin, [-0.5, -0.1 - 0.35, 0.5], atol=1e-12)
    assert {material.name for material in made.mesh.materials} == {"white", "steel"}
    opened = (
        made.part_mesh(1).vertices @ made.joints[0].motion(1.5)[:3, :3].T
        + made.joints[0].motion(1.5)[:3, 3]
    )
    assert opened[:, 1].min() < made.part_mesh(1).bounds[0, 1] - 0.5
