"""Triangles: how large, how far they reach, and what a box or a plane cuts of them."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from plain_solids import box_between

from asset_factory.factory.geometry.cutting import clip_to_box, cut_at_zero
from asset_factory.factory.geometry.triangles import areas_of, ends_of, meet_box
from asset_factory.factory.mesh import cross


def area(triangles):
    return float(areas_of(triangles).sum())


SOLID = box_between([0.0] * 3, [1.0] * 3)
CUBE = SOLID.vertices[SOLID.faces]


def test_the_surface_of_a_cube_in_a_smaller_box_is_what_a_knife_leaves():
    inside = clip_to_box(CUBE, np.array([-1.0, -1.0, -1.0]), np.array([0.25, 2.0, 2.0]))
    np.testing.assert_allclose(area(inside), 1.0 + 4 * 0.25)
    assert inside[..., 0].max() == 0.25
    assert not len(clip_to_box(CUBE, np.full(3, 0.4), np.full(3, 0.6)))


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_two_halves_make_the_whole(seed):
    rng = np.random.default_rng(seed)
    triangles = rng.uniform(-1.0, 1.0, (12, 3, 3))
    cut = rng.uniform(-0.5, 0.5)
    low = np.full(3, -0.8)
    high = np.full(3, 0.8)
    whole = clip_to_box(triangles, low, high)
    left = clip_to_box(triangles, low, np.array([cut, 0.8, 0.8]))
    right = clip_to_box(triangles, np.array([cut, -0.8, -0.8]), high)
    np.testing.assert_allclose(area(left) + area(right), area(whole), atol=1e-9)
    assert (np.abs(whole) <= 0.8 + 1e-9).all()


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_triangles_that_meet_a_box_are_those_of_which_it_holds_some(seed):
    rng = np.random.default_rng(seed)
    triangles = rng.uniform(-1.0, 1.0, (1, 1, 3)) + rng.uniform(-0.6, 0.6, (20, 3, 3))
    low = np.array([-0.3, -0.2, -0.4])
    high = np.array([0.1, 0.3, 0.2])
    some = [bool(len(clip_to_box(triangle[None], low, high))) for triangle in triangles]
    assert meet_box(triangles, low, high).tolist() == some


def test_pieces_keep_what_is_linear_on_their_triangles():
    height = CUBE[:, :, 0] - 0.3
    pieces = cut_at_zero(height)
    made = pieces.spread(CUBE)
    np.testing.assert_allclose(area(made), area(CUBE))
    lifted = pieces.spread(height[..., None])[..., 0]
    np.testing.assert_allclose(lifted, made[:, :, 0] - 0.3, atol=1e-12)
    assert ((lifted > -1e-9).all(axis=1) | (lifted < 1e-9).all(axis=1)).all()
    normals = np.cross(CUBE[:, 1] - CUBE[:, 0], CUBE[:, 2] - CUBE[:, 0])
    wound = np.cross(made[:, 1] - made[:, 0], made[:, 2] - made[:, 0])
    assert (np.einsum("ij,ij->i", wound, normals[pieces.whole]) > 0.0).all()


SHAPES = st.tuples(st.integers(0, 5), st.just(3), st.integers(1, 3))


@given(hnp.arrays(np.float64, SHAPES, elements=st.floats(-1e3, 1e3)))
def test_ends_are_those_along_the_corners(corners):
    low, high = ends_of(corners)
    assert (low == corners.min(axis=1)).all()
    assert (high == corners.max(axis=1)).all()


@given(hnp.arrays(np.float64, st.tuples(st.integers(0, 5), st.just(2), st.just(3))))
def test_cross_products_are_those_of_numpy_to_the_last_bit(pairs):
    with np.errstate(all="ignore"):
        one, other = pairs.swapaxes(0, 1)
        assert cross(one, other).tobytes() == np.cross(pairs[:, 0], pairs[:, 1]).tobytes()
