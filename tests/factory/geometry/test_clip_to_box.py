"""Triangles cut to boxes: what is inside stays, exactly."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box
from target_worlds import PLAIN

from asset_factory.factory.geometry.cutting import clip_to_box


def area(triangles: np.ndarray) -> float:
    edges = triangles[:, 1:] - triangles[:, :1]
    return float(np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum() / 2.0)


def surface(low: float, high: float) -> np.ndarray:
    solid = box((low, high), (low, high), (low, high), PLAIN)
    return solid.vertices[solid.faces]


def test_the_surface_of_a_cube_in_a_smaller_box_is_what_a_knife_leaves() -> None:
    inside = clip_to_box(
        surface(0.0, 1.0), np.array([-1.0, -1.0, -1.0]), np.array([0.25, 2.0, 2.0])
    )
    np.testing.assert_allclose(area(inside), 1.0 + 4 * 0.25)
    assert inside[..., 0].max() == 0.25


def test_a_box_within_a_solid_holds_nothing_of_its_surface() -> None:
    assert not len(clip_to_box(surface(0.0, 1.0), np.full(3, 0.4), np.full(3, 0.6)))


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_two_halves_make_the_whole(seed: int) -> None:
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
