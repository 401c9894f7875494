"""The sRGB curve and back."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.geometry.colors import linear_of, srgb_of


@given(st.floats(0.0, 1.0))
def test_the_two_curves_are_inverse(value):
    assert linear_of(srgb_of(value)) == pytest.approx(value, abs=1e-6)


def test_known_values():
    assert np.allclose(srgb_of([0.0, 0.5, 1.0]), [0.0, 0.735357, 1.0], atol=1e-6)
    assert np.allclose(linear_of([0.0, 0.5, 1.0]), [0.0, 0.214041, 1.0], atol=1e-6)
