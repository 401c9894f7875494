"""What pictures are decorated with is where it should be, and as deep and dark as drawn."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.learn.elevations.decorations import Decorations

PLAIN = Decorations(
    planks=(0.0, 1.0, 0.5),
    straps=(),
    band=(2.0, 3.0, 0.5),
    level=True,
    overall=True,
    plates=(0, 1.0, 0.5),
    grain=0.0,
)
WHOLE = np.zeros((80, 100), dtype=np.int64)


def test_without_decorations_nothing_changes():
    found = PLAIN.on(WHOLE, np.random.default_rng(0))

    assert not found.height.any()
    assert (found.light == 1.0).all()


def test_planks_are_parted_by_grooves_from_side_to_side():
    planked = replace(PLAIN, planks=(20.0, 0.7, 0.6))

    found = planked.on(WHOLE, np.random.default_rng(0))

    grooves = np.flatnonzero((found.height == -0.7).all(axis=1))
    assert grooves.tolist() == [10, 11, 30, 31, 50, 51, 70, 71]
    assert (found.light[grooves] == 0.6).all()
    assert not np.delete(found.height, grooves, axis=0).any()


def test_straps_run_across_planks():
    strapped = replace(PLAIN, planks=(20.0, 0.0, 1.0), straps=(0.25, 0.75))

    found = strapped.on(WHOLE, np.random.default_rng(0))

    proud = np.flatnonzero((found.height == 3.0).all(axis=0))
    assert proud.tolist() == [23, 24, 25, 26, 27, 73, 74, 75, 76, 77]


def test_planks_of_single_parts_stay_on_them():
    part = np.repeat(np.arange(4), 25)[None].repeat(80, axis=0)
    planked = replace(PLAIN, planks=(20.0, 0.7, 0.6), overall=False)

    found = planked.on(part, np.random.default_rng(3))

    lined = [bool((found.height[:, part[0] == each] < 0.0).any()) for each in range(4)]
    assert any(lined)
    assert not all(lined)


def test_plates_are_as_many_as_drawn_and_inside():
    plated = replace(PLAIN, plates=(1, 1.5, 0.5))

    found = plated.on(WHOLE, np.random.default_rng(1))

    rows, columns = np.nonzero(found.height)
    whole = (np.ptp(rows) + 1) * (np.ptp(columns) + 1)
    assert len(rows) == whole
    assert (found.height[rows, columns] == 1.5).all()


@pytest.mark.parametrize("level", [True, False])
def test_grain_is_longer_than_wide(level):
    found = replace(PLAIN, grain=0.1, level=level).on(WHOLE, np.random.default_rng(2))

    along, across = (np.abs(np.diff(found.light, axis=axis)).mean() for axis in (1, 0))
    assert (along < 0.5 * across) == level
    assert found.light.std() == pytest.approx(0.1, rel=0.05)


def test_generators_differ():
    drawn = [Decorations.drawn(np.random.default_rng(seed)) for seed in range(200)]

    assert 40 < sum(each.planks[0] > 0.0 for each in drawn) < 100
    assert 20 < sum(bool(each.straps) for each in drawn) < 80
    assert 50 < sum(each.grain > 0.0 for each in drawn) < 110
