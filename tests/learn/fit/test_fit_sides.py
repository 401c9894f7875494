"""The picture network learns, and goes on from where it was as if it had never stopped."""

import numpy as np
import pytest

from asset_factory.learn.elevations.views import views_of, write_views
from asset_factory.learn.objects import make_object

pytest.importorskip("torch")

from asset_factory.learn.fit import sides
from asset_factory.learn.train.checkpoints import read_state


@pytest.fixture
def views(tmp_path):
    folder = tmp_path / "views"
    folder.mkdir()
    for number, kind in enumerate(("fridge", "oven")):
        made = views_of(make_object(kind, 5), np.random.default_rng(number))
        write_views(folder / f"{number}.npz", made[:1])
    return folder


def test_the_network_learns(tmp_path, views, monkeypatch):
    monkeypatch.setattr(sides, "WARM_UP", 1)
    state = tmp_path / "state.pt"
    first, figures = sides.fit_sides(views, state, rounds=15, seed=0)
    assert "panel IoU" in figures
    network = sides.PictureNetwork()
    batch = next(sides._batches([views / "1.npz"], None))
    before = float(sides._loss(network.train(), *batch).detach())
    network.load_state_dict(read_state(state).weights)
    after = float(sides._loss(network.train(), *batch).detach())
    assert after < 0.8 * before
    again, _ = sides.fit_sides(views, state, rounds=15, seed=0)
    assert all(np.array_equal(again[name], first[name]) for name in first)


def test_a_run_cut_off_ends_as_if_it_had_not_been(tmp_path, views, monkeypatch):
    whole, _ = sides.fit_sides(views, tmp_path / "whole.pt", rounds=2, seed=0)
    write = sides.write_state

    def cut_off(path, state):
        write(path, state)
        raise KeyboardInterrupt

    monkeypatch.setattr(sides, "write_state", cut_off)
    with pytest.raises(KeyboardInterrupt):
        sides.fit_sides(views, tmp_path / "cut.pt", rounds=2, seed=0)
    monkeypatch.setattr(sides, "write_state", write)
    found, _ = sides.fit_sides(views, tmp_path / "cut.pt", rounds=2, seed=0)
    assert all(np.array_equal(found[name], whole[name]) for name in whole)
