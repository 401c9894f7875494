"""Equal rows of a table."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from asset_factory.factory.geometry.rows import distinct_rows

SHAPES = st.tuples(st.integers(0, 30), st.integers(1, 4))
TYPES = st.sampled_from([np.int64, np.float64])
TABLES = hnp.arrays(TYPES, SHAPES, elements=st.integers(-2, 2))


@given(TABLES)
def test_they_are_those_that_numpy_finds(rows):
    first, which = distinct_rows(rows)
    _, index, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    assert first.tolist() == index.tolist()
    assert which.tolist() == inverse.reshape(-1).tolist()
    assert (rows[first][which] == rows).all()
