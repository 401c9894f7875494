"""What the articulator of one-piece meshes learns from: pictures of objects, and their truth."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

from asset_factory.factory.articulate.seams.features import MOTION_NAMES, NAMES
from asset_factory.factory.articulate.seams.learned import LearnedJudge, load_judge
from asset_factory.factory.geometry.crossings import Side
from asset_factory.factory.part import OpensBy
from asset_factory.learn.elevations.learning import Examples, averaged, fitted
from asset_factory.learn.elevations.pictures import pictures_of
from asset_factory.learn.elevations.rows import rows_of
from asset_factory.learn.elevations.table import table_of
from asset_factory.learn.elevations.truths import truth_of
from asset_factory.learn.objects import make_object

SIDES = (Side.FRONT, Side.BACK, Side.TOP)


def test_doors_of_a_fridge_are_truths_of_its_front() -> None:
    fridge = make_object("fridge", 1)
    pictures = pictures_of(fridge, np.random.default_rng(0), SIDES)
    panels = truth_of(fridge, pictures)
    assert len(panels) == len(fridge.joints)
    assert {panel.side for panel in panels} == {Side.FRONT}
    assert {panel.way for panel in panels} <= {OpensBy.LEFT, OpensBy.RIGHT}


def test_a_lid_is_no_panel() -> None:
    chest = make_object("chest", 1)
    pictures = pictures_of(chest, np.random.default_rng(0), SIDES)
    assert truth_of(chest, pictures) == ()


def test_the_same_seed_shows_the_same_object() -> None:
    drawers = make_object("filing_cabinet", 2)
    one = rows_of(drawers, np.random.default_rng(4))
    other = rows_of(drawers, np.random.default_rng(4))
    assert np.array_equal(one.panel, other.panel)
    assert np.array_equal(one.motion, other.motion)
    assert one.panel.shape[1] == len(NAMES)
    assert one.motion.shape == (one.wanted, len(MOTION_NAMES))
    assert one.panel_true.max() > 0.7


def _lesson() -> Examples:
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(400, 3))
    wanted = (rows[:, :1] * rows[:, 1:2] > 0.0).astype(np.float64)
    return Examples(rows, wanted, np.ones(len(rows)))


def test_a_network_learns_what_no_line_divides() -> None:
    examples = _lesson()
    judge = averaged([fitted(examples, 6, 1e-5, seed) for seed in range(3)])
    right = (judge.logits(examples.rows) > 0.0) == (examples.wanted > 0.5)
    assert right.mean() > 0.9


def test_the_average_of_networks_is_one_network() -> None:
    examples = _lesson()
    several = [fitted(examples, 4, 1e-3, seed) for seed in range(3)]
    mean = np.mean([judge.logits(examples.rows) for judge in several], axis=0)
    assert averaged(several).logits(examples.rows) == pytest.approx(mean)


def test_judges_come_back_from_their_table() -> None:
    shipped = {"panel": load_judge("panel", NAMES), "motion": load_judge("motion", MOTION_NAMES)}
    table = tomllib.loads(table_of(shipped, 7))
    assert table["panel"]["features"] == list(NAMES)
    again = LearnedJudge(
        *(np.array(table["motion"][k]) for k in ("mean", "scale", "hidden", "out"))
    )
    assert again.out == pytest.approx(shipped["motion"].out)
    assert again.logits(np.zeros((1, len(MOTION_NAMES)))).shape == (1, len(OpensBy))
