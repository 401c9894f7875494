"""Round solids: closed, outward, and of the volume that geometry says."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.mesh import Mesh
from asset_factory.factory.training.objects.looks import STEEL
from asset_factory.factory.training.objects.rounds import (
    arc,
    ball,
    block,
    lathe,
    loft,
    pipe,
    ribbon,
    rounded,
    shifted,
    swept,
    turned,
)


def solid(mesh: Mesh) -> manifold3d.Manifold:
    body = manifold3d.Manifold(
        manifold3d.Mesh64(np.array(mesh.vertices), mesh.faces.astype(np.uint64))
    )
    assert body.status() == manifold3d.Error.NoError
    return body


def polygon(sides: int) -> float:
    """Area of a regular polygon of circumradius 1."""
    return 0.5 * sides * np.sin(2 * np.pi / sides)


@given(st.integers(0, 2), st.integers(3, 40), st.floats(0.01, 2.0), st.floats(0.01, 2.0))
def test_a_lathed_frustum_has_the_volume_of_a_frustum(axis, sides, low, high):
    body = solid(lathe(axis, (1.0, 2.0, 3.0), [(low, 0.0), (high, 0.7)], STEEL, sides))
    expected = polygon(sides) * 0.7 * (low * low + low * high + high * high) / 3.0
    assert body.volume() == pytest.approx(expected, rel=1e-9)


def test_a_vessel_is_its_outside_less_its_inside():
    cup = lathe(2, (0, 0, 0), [(0.5, 0.0), (0.5, 1.0), (0.4, 1.0), (0.4, 0.1)], STEEL, 32)
    assert solid(cup).volume() == pytest.approx(polygon(32) * (0.25 * 1.0 - 0.16 * 0.9), rel=1e-9)


def test_a_ring_is_outward_whichever_way_its_profile_runs():
    profile = [(1.0, 0.0), (1.2, 0.0), (1.2, 0.3), (1.0, 0.3)]
    for order in (profile, profile[::-1]):
        ring = solid(lathe(2, (0, 0, 0), order, STEEL, 24, looped=True))
        assert ring.volume() == pytest.approx(polygon(24) * (1.44 - 1.0) * 0.3, rel=1e-9)
        assert ring.genus() == 1


def test_a_straight_pipe_is_a_prism_and_a_looped_one_has_a_hole():
    straight = solid(pipe([(0, 0, 0), (0.5, 0, 0), (2, 0, 0)], 0.1, STEEL, 12))
    assert straight.volume() == pytest.approx(2.0 * 0.01 * polygon(12), rel=1e-9)
    line = arc((0.0, 0.0), 1.0, 0.0, 2 * np.pi, 65)[:-1]
    torus = solid(pipe(np.column_stack([line, np.zeros(64)]), 0.1, STEEL, 12, looped=True))
    assert torus.genus() == 1
    assert torus.volume() == pytest.approx(2 * np.pi * 0.01 * polygon(12), rel=0.01)


def test_a_ribbon_between_two_lines_has_the_area_between_them_times_its_thickness():
    x = np.linspace(0.0, 1.0, 9)
    wavy = np.stack([x, np.sin(3 * x)], axis=1)
    for axis in range(3):
        plate = solid(ribbon(axis, wavy, wavy + np.array([0.0, 0.2]), (-0.1, 0.2), STEEL))
        assert plate.volume() == pytest.approx(0.2 * 0.3, rel=1e-9)
    square = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], dtype=float)
    frame = solid(ribbon(2, square, 0.5 * square, (0.0, 0.1), STEEL, looped=True))
    assert frame.volume() == pytest.approx((4.0 - 1.0) * 0.1, rel=1e-9)


def test_a_rounded_block_fills_its_spans_and_loses_only_its_corners():
    brick = block(2, (0.0, 2.0), (0.0, 1.0), (0.0, 0.5), STEEL, 0.1)
    np.testing.assert_allclose(brick.bounds, [[0, 0, 0], [2, 1, 0.5]], atol=1e-12)
    lost = 1.0 - solid(brick).volume()
    assert 0.5 * (4.0 - np.pi) * 0.01 <= lost < 0.02
    assert (
        solid(block(0, (0.0, 2.0), (0.0, 1.0), (0.0, 0.5), STEEL, 0.2, bevel=0.05)).volume()
        < 1.0 - lost
    )


def test_a_radius_too_large_for_its_rectangle_is_cut_down_to_fit():
    outline = rounded((0.0, 1.0), (0.0, 0.2), 5.0)
    np.testing.assert_allclose(
        [outline.min(axis=0), outline.max(axis=0)], [[0.0, 0.0], [1.0, 0.2]], atol=1e-9
    )


def test_turning_and_shifting_move_every_corner_and_keep_the_volume():
    before = ball((0.0, 0.0, 0.0), 0.3, STEEL)
    [after] = shifted(turned([before], (0, 0, 1), np.pi / 2, (1.0, 0.0, 0.0)), (0.0, 0.0, 2.0))
    np.testing.assert_allclose(after.vertices[:, 0], 1.0 - before.vertices[:, 1], atol=1e-12)
    np.testing.assert_allclose(after.vertices[:, 1], before.vertices[:, 0] - 1.0, atol=1e-12)
    np.testing.assert_allclose(after.vertices[:, 2], before.vertices[:, 2] + 2.0, atol=1e-12)
    assert solid(after).volume() == pytest.approx(solid(before).volume(), rel=1e-9)


def test_rings_may_change_outline_on_the_way_up():
    square = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], dtype=float)
    pyramid = solid(loft(swept(2, np.array([square, 0.5 * square]), [0.0, 1.0]), STEEL))
    assert pyramid.volume() == pytest.approx((4.0 + 2.0 + 1.0) / 3.0, rel=1e-9)
