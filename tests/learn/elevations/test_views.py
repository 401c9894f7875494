"""Single sides, as the picture network learns from them."""

import numpy as np
import pytest

from asset_factory.factory.articulate.seams.sight import CUES
from asset_factory.factory.part import OpensBy
from asset_factory.learn.elevations.views import UNKNOWN, read_views, views_of, write_views
from asset_factory.learn.objects import make_object


@pytest.fixture(scope="module")
def fridge():
    return views_of(make_object("fridge", 1), np.random.default_rng(2))[0]


def test_a_view_knows_what_opens_and_how(fridge):
    panel, lid, level, upright = fridge.wanted
    assert 0.5 < panel[fridge.cues[0, ::2, ::2] > 0.0].mean() <= 1.0
    assert not lid.any()
    assert level.any()
    assert upright.any()
    hinged = {list(OpensBy).index(OpensBy.LEFT), list(OpensBy).index(OpensBy.RIGHT)}
    assert set(fridge.way[panel].tolist()) <= {*hinged, UNKNOWN}
    assert (fridge.way[~panel] == UNKNOWN).mean() > 0.95


def test_a_lid_is_seen_from_the_front():
    chest = views_of(make_object("chest", 1), np.random.default_rng(2))[0]
    assert chest.wanted[1].any()
    assert not chest.wanted[0].any()


def test_a_mirrored_view_is_hinged_on_the_other_side(fridge):
    mirrored = fridge.mirrored()
    left = list(OpensBy).index(OpensBy.LEFT)
    right = list(OpensBy).index(OpensBy.RIGHT)
    assert (mirrored.way == left).sum() == (fridge.way == right).sum()
    slope = CUES.index("slope_right")
    assert np.array_equal(mirrored.cues[slope], -fridge.cues[slope][:, ::-1])
    back = mirrored.mirrored()
    assert np.array_equal(back.cues, fridge.cues)
    assert np.array_equal(back.way, fridge.way)


def test_views_come_back_from_their_file(fridge, tmp_path):
    write_views(tmp_path / "one.npz", (fridge, fridge.mirrored()))
    first, second = read_views(tmp_path / "one.npz")
    assert first.cues == pytest.approx(fridge.cues, abs=2e-3)
    assert np.array_equal(first.wanted, fridge.wanted)
    assert np.array_equal(second.way, fridge.mirrored().way)
