"""How large triangles are, and how far they reach."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from asset_factory.factory.geometry.triangles import ends_of, face_areas
from asset_factory.factory.mesh import Mesh, cross

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


def test_half_a_square_has_half_its_area():
    corners = np.array([[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 2.0, 1.0]])
    assert face_areas(Mesh.from_triangles(corners, [[0, 1, 2]])) == pytest.approx(2.0)
