"""What the shipped picture network sees on a side."""

from dataclasses import replace

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams import hypotheses
from asset_factory.factory.articulate.seams.fronts import fronts_of
from asset_factory.factory.articulate.seams.hypotheses import hypotheses_of_reliefs
from asset_factory.factory.articulate.seams.rectangles import Rectangle
from asset_factory.factory.articulate.seams.relief import relief_of, reliefs_of
from asset_factory.factory.articulate.seams.sight import (
    ANSWERS,
    CUES,
    GRID,
    SQUARE,
    Sight,
    cues_of,
    shipped_weights,
    sight_of,
)
from asset_factory.factory.views.raster import Side
from asset_factory.factory.views.view import Views, elevation
from asset_factory.learn.elevations.pictures import pictures_of
from asset_factory.learn.objects import make_object


@pytest.fixture(scope="module")
def fridge():
    return relief_of(elevation(make_object("fridge", 1).mesh, Side.FRONT))


def test_what_is_given_does_not_depend_on_size(fridge):
    large = make_object("fridge", 1).mesh.transformed(np.diag([3.0, 3.0, 3.0, 1.0]))
    assert cues_of(relief_of(elevation(large, Side.FRONT))) == pytest.approx(
        cues_of(fridge), abs=1e-6
    )


def test_what_is_given_fits_the_grid(fridge):
    cues = cues_of(fridge)
    assert cues.shape[0] == len(CUES)
    assert cues.shape[1] % GRID == cues.shape[2] % GRID == 0
    assert not cues[:, fridge.shape[0] :].any()
    assert np.isfinite(cues).all()


def test_answers_are_probabilities(fridge):
    seen = sight_of(fridge)
    for each in (seen.panel, seen.lid, seen.level, seen.upright):
        assert each.shape == tuple(-(-length // 2) for length in fridge.shape)
        assert each.min() >= 0.0
        assert each.max() <= 1.0
    assert len(seen.ways) == len(ANSWERS) - 4
    assert seen.ways.sum(axis=0) == pytest.approx(1.0)


def test_a_rectangle_shows_a_panel_as_far_as_it_covers_one():
    panel = np.zeros((40, 30))
    panel[:20] = 1.0
    seen = Sight(panel, panel, panel, panel, np.zeros((5, 40, 30)))
    assert seen.shows(_rectangle((2, 2), (38, 58))) == 1.0
    assert seen.shows(_rectangle((42, 2), (78, 58))) == 0.0
    assert seen.shows(_rectangle((2, 2), (78, 58))) == pytest.approx(0.5, abs=0.02)
    assert seen.shows(_rectangle((2, 2), (3, 3))) == 0.0


def _seeing_two_doors():
    """Of 40 by 60 squares, one door beside another, parted at square 30."""
    panel = np.ones((40, 60))
    upright = np.zeros((40, 60))
    upright[:, 29:31] = 0.9
    level = np.zeros((40, 60))
    level[[0, -1]] = 0.6
    return Sight(panel, np.zeros((40, 60)), level, upright, np.zeros((5, 40, 60)))


def test_a_panel_runs_on_where_the_network_sees_one_and_no_end():
    level, upright = _seeing_two_doors().runs_on((79, 119))
    assert level.shape == upright.shape == (79, 119)
    assert upright[:, :50].all()
    assert upright[:, 70:].all()
    assert not upright[:, 56:64].any()
    assert level[10:60].all()
    assert not level[:2].any()
    doubtful = replace(_seeing_two_doors(), panel=np.full((40, 60), 0.5))
    assert not doubtful.runs_on((79, 119)).any()


def test_lines_on_a_panel_that_runs_on_part_nothing():
    front = fronts_of(reliefs_of(Views(one_piece.doors())))[Side.FRONT]
    middle = front.relief.shape[1] // 2
    assert np.abs(front.scene.upright.at - middle).min() <= 4
    seen = front.sight
    nowhere = np.zeros_like(seen.panel)
    sure = replace(seen, panel=np.ones_like(seen.panel), level=nowhere, upright=nowhere)
    told = replace(front)
    told.__dict__["sight"] = sure
    assert np.abs(told.scene.upright.at - middle).min() > 20


def _rectangle(low, high):
    return Rectangle(np.array(low), np.array(high), np.ones(4), np.ones(4))


def test_what_the_network_does_not_see_is_no_panel(monkeypatch):
    reliefs = reliefs_of(Views(one_piece.fridge()))
    found = hypotheses_of_reliefs(reliefs)[0]
    monkeypatch.setattr(Sight, "shows", lambda self, rectangle: 0.0)
    # A handle within a groove all around is a door's, whoever sees it.
    assert len(hypotheses_of_reliefs(reliefs)[0]) == len(found) > 0
    monkeypatch.setattr(hypotheses, "EVIDENT", np.inf)
    assert hypotheses_of_reliefs(reliefs) == ()


@pytest.mark.parametrize("kind", ["fridge", "filing_cabinet", "base_cabinet"])
def test_the_shipped_network_tells_what_opens_from_what_stays(kind):
    pictures = pictures_of(make_object(kind, 40_001), np.random.default_rng(1), (Side.FRONT,))
    relief = pictures[Side.FRONT].relief
    part = pictures[Side.FRONT].part
    panel = sight_of(relief).panel.repeat(SQUARE, axis=0).repeat(SQUARE, axis=1)
    panel = panel[: relief.shape[0], : relief.shape[1]]
    assert panel[part > 0].mean() > panel[part == 0].mean() + 0.3


def test_the_shipped_network_is_whole():
    assert all(np.isfinite(each).all() for each in shipped_weights().values())
    assert shipped_weights()["answer.weight"].shape[0] == len(ANSWERS)
