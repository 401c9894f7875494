"""Crossings come in one order, however they are found."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.mesh import Mesh
from asset_factory.factory.views import crossings as module
from asset_factory.factory.views.crossings import crossings
from asset_factory.factory.views.raster import Raster, Side

#: Few values, so that pixels and depths are equal often.
pairs = st.lists(st.tuples(st.integers(0, 5), st.sampled_from([-0.0, 0.0, 0.25, 0.5])))


@given(pairs, st.sampled_from([1, 2**60]))
def test_crossings_are_ordered_by_pixel_depth_and_place(found, scale):
    pixel = np.array([pair[0] for pair in found], dtype=np.int64) * scale
    depth = np.array([pair[1] for pair in found], dtype=np.float64)
    order = module._nearest_first(pixel, depth)
    rows = sorted(zip(pixel, depth, range(len(found)), strict=True))
    assert order.tolist() == [place for _, _, place in rows]


@given(pairs)
def test_the_nearest_are_the_first_in_that_order(found):
    pixel = np.array([pair[0] for pair in found], dtype=np.int64)
    depth = np.array([pair[1] for pair in found], dtype=np.float64)
    order = module._nearest_first(pixel, depth)
    first = order[np.flatnonzero(np.diff(pixel[order], prepend=-1))]
    assert module._nearest_only(pixel, depth).tolist() == first.tolist()


def test_how_many_pairs_are_looked_at_in_one_go_changes_nothing(monkeypatch):
    generator = np.random.default_rng(3)
    mesh = Mesh.from_triangles(generator.random((60, 3)), np.arange(60).reshape(20, 3))
    raster = Raster.around(mesh, Side.LEFT, 40)
    whole = crossings(mesh, raster)
    monkeypatch.setattr(module, "_PAIRS", 7)
    parts = crossings(mesh, raster)
    assert len(whole.pixel) > 1000
    for name in ("pixel", "depth", "face", "inward", "weights"):
        assert np.array_equal(getattr(whole, name), getattr(parts, name)), name
