"""Which cells a hull fills, column by column, against every cell and every plane."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from asset_factory.factory.manufacture.decompose.convex import hull_of
from asset_factory.factory.manufacture.solids.box import Box
from asset_factory.factory.manufacture.solids.lattice import Lattice
from asset_factory.factory.manufacture.solids.pieces import filled

BOUNDS = np.array([[0.0, 0.0, 0.0], [1.0, 0.7, 0.4]])
LATTICE = Lattice.over(BOUNDS, 24, [[0.31], [0.5], []])
EVERYWHERE = (slice(None), slice(None), slice(None))
POINTS = hnp.arrays(np.float64, (12, 3), elements=st.floats(-0.25, 1.25, width=32))


@given(POINTS, st.floats(-0.05, 0.05), st.integers(0, 10), st.integers(0, 10))
def test_cells_below_all_planes_are_found(points, margin, first, second):
    hull = hull_of(points)
    assume(hull is not None)
    planes = hull.planes * [1.0, 1.0, 1.0, -1.0]
    span = (slice(first, None), slice(second, None), slice(0, 7))
    shape = np.zeros(LATTICE.shape)[span].shape
    at = np.argwhere(np.ones(shape)) + np.array([first, second, 0])
    heights = (LATTICE.centers(at) @ planes[:, :3].T + planes[:, 3]).max(axis=1)
    found = LATTICE.below(planes, span, margin).reshape(-1)
    assume(np.abs(heights - margin).min(initial=1.0) > 1e-9)
    assert (found == (heights < margin)).all()


def test_a_box_of_whole_cells_fills_its_volume():
    box = Box(*(np.array([line[cell] for line in LATTICE.lines]) for cell in (2, 6)))
    twice = np.full(LATTICE.shape, 2, dtype=np.uint8)
    hull = box.hull()
    assert hull is not None
    assert np.isclose(filled(LATTICE, twice, EVERYWHERE, hull), 2.0 * np.prod(box.size))


def test_a_sheet_thinner_than_cells_fills_those_it_crosses():
    middle = LATTICE.middles[2][4]
    low, high = (np.append(end, middle) for end in BOUNDS[:, :2])
    hull = Box(low, high).grown([0.0, 0.0, 5e-4]).hull()
    assert hull is not None
    once = np.ones(LATTICE.shape, dtype=np.uint8)
    crossed = LATTICE.volumes[:, :, 4].sum()
    assert np.isclose(filled(LATTICE, once, EVERYWHERE, hull), crossed)
