"""Forms: closed, outward, and of the volume that geometry says."""

import manifold3d
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.learn.objects.kit import shapes
from asset_factory.learn.objects.kit.axes import X, Y, Z
from asset_factory.learn.objects.kit.outlines import arc, rounded
from asset_factory.learn.objects.kit.spans import about, between, shares, span, within

SQUARE = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])


def bounds(form):
    return np.stack([form.vertices.min(axis=0), form.vertices.max(axis=0)], axis=1)


def solid(form):
    vertices = np.ascontiguousarray(form.vertices)
    body = manifold3d.Manifold(manifold3d.Mesh64(vertices, form.faces.astype(np.uint64)))
    assert body.status() == manifold3d.Error.NoError
    return body


def polygon(sides):
    """Area of a regular polygon of circumradius 1."""
    return 0.5 * sides * np.sin(2 * np.pi / sides)


@given(st.integers(0, 2), st.integers(3, 40), st.floats(0.01, 2.0), st.floats(0.01, 2.0))
def test_a_lathed_frustum_has_the_volume_of_a_frustum(axis, sides, low, high):
    body = solid(shapes.lathe([(low, 0.0), (high, 0.7)], (1.0, 2.0, 3.0), axis, sides))
    expected = polygon(sides) * 0.7 * (low * low + low * high + high * high) / 3.0
    assert body.volume() == pytest.approx(expected, rel=1e-9)


def test_a_vessel_is_its_outside_less_its_inside():
    cup = shapes.lathe([(0.5, 0.0), (0.5, 1.0), (0.4, 1.0), (0.4, 0.1)], sides=32)
    assert solid(cup).volume() == pytest.approx(polygon(32) * (0.25 * 1.0 - 0.16 * 0.9), rel=1e-9)


def test_a_ring_is_outward_whichever_way_its_profile_runs():
    profile = [(1.0, 0.0), (1.2, 0.0), (1.2, 0.3), (1.0, 0.3)]
    for order, axis in ((profile, Z), (profile[::-1], Z), (profile, Y), (profile[::-1], X)):
        ring = solid(shapes.lathe(order, axis=axis, looped=True))
        assert ring.volume() == pytest.approx(polygon(24) * (1.44 - 1.0) * 0.3, rel=1e-9)
        assert ring.genus() == 1


def test_a_straight_pipe_is_a_prism_and_a_looped_one_has_a_hole():
    straight = solid(shapes.pipe([(0, 0, 0), (0.5, 0, 0), (2, 0, 0)], 0.1, 12))
    assert straight.volume() == pytest.approx(2.0 * 0.01 * polygon(12), rel=1e-9)
    line = arc((0.0, 0.0), 1.0, 0.0, 2 * np.pi, 65)[:-1]
    torus = solid(shapes.pipe(np.column_stack([line, np.zeros(64)]), 0.1, 12, looped=True))
    assert torus.genus() == 1
    assert torus.volume() == pytest.approx(2 * np.pi * 0.01 * polygon(12), rel=0.01)


def test_a_ribbon_between_two_lines_has_the_area_between_them_times_its_thickness():
    x = np.linspace(0.0, 1.0, 9)
    wavy = np.stack([x, np.sin(3 * x)], axis=1)
    for axis in range(3):
        plate = solid(shapes.ribbon(wavy, wavy + np.array([0.0, 0.2]), (-0.1, 0.2), axis))
        assert plate.volume() == pytest.approx(0.2 * 0.3, rel=1e-9)
    frame = solid(shapes.ribbon(SQUARE, 0.5 * SQUARE, (0.0, 0.1), looped=True))
    assert frame.volume() == pytest.approx((4.0 - 1.0) * 0.1, rel=1e-9)


def test_a_rounded_block_fills_its_spans_and_loses_only_its_corners():
    brick = shapes.block((0.0, 2.0), (0.0, 1.0), (0.0, 0.5), 0.1)
    np.testing.assert_allclose(bounds(brick), [[0, 2], [0, 1], [0, 0.5]], atol=1e-12)
    lost = 1.0 - solid(brick).volume()
    assert 0.5 * (4.0 - np.pi) * 0.01 <= lost < 0.02
    for axis in (X, Y, Z):
        soft = shapes.block((0.0, 2.0), (0.0, 1.0), (0.0, 0.5), 0.2, 0.05, axis)
        np.testing.assert_allclose(bounds(soft), [[0, 2], [0, 1], [0, 0.5]], atol=1e-12)
        assert solid(soft).volume() < 1.0 - lost
    leaning = solid(shapes.block((0.0, 2.0), (0.0, 1.0), (0.0, 0.5), 0.1, taper=0.5))
    assert 0.5 < leaning.volume() < 0.6


def test_a_radius_too_large_for_its_rectangle_is_cut_down_to_fit():
    outline = rounded((0.0, 1.0), (0.0, 0.2), 5.0)
    np.testing.assert_allclose(outline.min(axis=0), [0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(outline.max(axis=0), [1.0, 0.2], atol=1e-9)


def test_turning_shifting_and_mirroring_move_every_corner_and_keep_the_volume():
    before = shapes.ball((0.0, 0.0, 0.0), 0.3)
    after = before.turned((0, 0, 1), np.pi / 2, (1.0, 0.0, 0.0)).shifted((0.0, 0.0, 2.0))
    x, y, z = before.vertices.T
    np.testing.assert_allclose(after.vertices.T, [1.0 - y, x - 1.0, z + 2.0], atol=1e-12)
    assert solid(after).volume() == pytest.approx(solid(before).volume(), rel=1e-9)
    flipped = after.mirrored()
    np.testing.assert_array_equal(flipped.vertices[:, 0], -after.vertices[:, 0])
    assert solid(flipped).volume() == pytest.approx(solid(before).volume(), rel=1e-9)


def test_outlines_may_change_on_the_way_up():
    pyramid = solid(shapes.stack([(SQUARE, 0.0), (0.5 * SQUARE, 1.0)]))
    assert pyramid.volume() == pytest.approx((4.0 + 2.0 + 1.0) / 3.0, rel=1e-9)
    same = solid(shapes.frustum((about(1.0), about(1.0)), (about(0.5), about(0.5)), (0.0, 1.0)))
    assert same.volume() == pytest.approx(pyramid.volume(), rel=1e-9)
    skin = shapes.loft(np.stack([np.column_stack([SQUARE, np.full(4, z)]) for z in (1.0, 0.0)]))
    assert solid(skin).volume() == pytest.approx(4.0)


@pytest.mark.parametrize("axis", [X, Y, Z])
def test_boxes_cylinders_hoops_and_prisms_have_the_volume_of_their_outlines(axis):
    along = (0.2, 0.5)
    rod = solid(shapes.cylinder(axis, (0.1, -0.2), 0.05, along, 12))
    assert rod.volume() == pytest.approx(0.3 * 0.05**2 * polygon(12))
    ring = solid(shapes.hoop(axis, (0.1, 0.3), (0.04, 0.06), along))
    assert ring.volume() == pytest.approx(0.3 * (0.06**2 - 0.04**2) * polygon(24))
    for outline in ([(0, 0), (2, 0), (0, 1)], [(0, 1), (2, 0), (0, 0)]):
        wedge = shapes.prism(outline, (0, 3), axis)
        assert solid(wedge).volume() == pytest.approx(3.0)
        spans = [(0.0, 2.0), (0.0, 1.0)]
        spans.insert(axis, (0.0, 3.0))
        np.testing.assert_allclose(bounds(wedge), spans, atol=1e-12)
    assert solid(shapes.box((0, 1), (1, 3), (2, 5))).volume() == pytest.approx(6.0)


@given(st.integers(0, 2), st.floats(0.02, 0.2), st.booleans())
@settings(max_examples=20, deadline=None)
def test_pipes_face_outwards_whichever_way_they_bend(axis, bulge, flip):
    t = np.linspace(-1.0, 1.0, 9)
    path = np.zeros((9, 3))
    path[:, axis] = 0.2 * t
    path[:, (axis + 1) % 3] = bulge * (1 - t**2) * (-1 if flip else 1)
    length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    wanted = length * 0.005**2 * polygon(8)
    assert solid(shapes.pipe(path, 0.005, 8)).volume() == pytest.approx(wanted, rel=0.15)


def test_spans_are_ordered_whichever_way_they_are_said():
    assert span(1.0, -0.25) == (0.75, 1.0)
    assert about(0.5, 2.0) == (1.5, 2.5)
    assert within((0.0, 1.0), 0.25, 0.0) == (0.25, 1.0)
    assert shares((0.0, 1.0), 2) == [(0.0, 0.5), (0.5, 1.0)]
    assert between((0.0, 1.0), 3) == pytest.approx([0.25, 0.5, 0.75])
