"""Cells tile the front, and doors are trimmed to what passes."""

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.learn.objects.kit.chance import Chance
from asset_factory.learn.objects.kit.hinges import SLACK, stop, swing
from asset_factory.learn.objects.kit.layouts import column, divided, drawers, random_node, row

MIX = dict.fromkeys(("drawer", "drawers", "door", "double", "open", "lift", "flap"), 1.0)


@given(st.integers(0, 10**6), st.floats(0.3, 2.5), st.floats(0.3, 2.2), st.booleans())
@settings(max_examples=50, deadline=None)
def test_cells_tile_the_front_and_their_insides_lie_within(seed, width, height, bare):
    node = random_node(Chance(np.random.default_rng(seed)), width, height, MIX)
    cells, dividers = divided(node, (0.0, width), (0.0, height), 0.018, bare)
    area = sum((c.x[1] - c.x[0]) * (c.z[1] - c.z[0]) for c in cells)
    np.testing.assert_allclose(area, width * height, rtol=1e-9)
    for cell in cells:
        (left, right), (low, high) = cell.inner
        assert cell.x[0] < left < right < cell.x[1]
        assert cell.z[0] < low < high < cell.z[1]
        edges = zip((*cell.x, *cell.z), (0.0, width, 0.0, height), strict=True)
        assert cell.outer == tuple(abs(a - b) < 1e-9 for a, b in edges)
    assert len(dividers) <= len(cells) - 1


def test_shares_are_heights_and_bare_drawers_have_no_boards_between_them():
    node = column((1.0, "drawer"), (3.0, row((1.0, "door"), (1.0, "open"))), (1.0, "drawer"))
    cells, dividers = divided(node, (0.0, 1.0), (0.0, 1.0), 0.02, True)
    assert [(c.kind, round(c.z[0], 6), round(c.z[1], 6)) for c in cells] == [
        ("drawer", 0.0, 0.2), ("door", 0.2, 0.8), ("open", 0.2, 0.8), ("drawer", 0.8, 1.0),
    ]  # fmt: skip
    lying = (0.01, 0.99)
    upright = ((0.49, 0.51), (0.21, 0.79))
    wanted = [(lying, (0.19, 0.21)), upright, (lying, (0.79, 0.81))]
    np.testing.assert_allclose(dividers, wanted)
    pile = drawers(Chance(np.random.default_rng(0)), 4)
    assert divided(pile, (0.0, 1.0), (0.0, 1.0), 0.02, True)[1] == []
    assert len(divided(pile, (0.0, 1.0), (0.0, 1.0), 0.02, False)[1]) == 3


SIZES = (st.floats(0.01, 0.08), st.floats(0.1, 1.0), st.floats(0.0005, 0.01))


@given(st.integers(0, 10**6), *SIZES, st.floats(-0.3, 1.0))
@settings(max_examples=100, deadline=None)
def test_a_trimmed_front_turns_past_its_neighbours(seed, thickness, width, gap, taste):
    made = swing(thickness, width, (gap, gap), taste)
    upper = stop(Chance(np.random.default_rng(seed)), 92.0)
    angle = np.linspace(0.0, upper, 50)
    depths = (-made.setback, thickness - made.setback)
    for x, y in itertools.product((0.0, width - made.trim), depths):
        across = x * np.cos(angle) + y * np.sin(angle)
        away = -x * np.sin(angle) + y * np.cos(angle)
        beside = (away > -made.setback) & (away < thickness - made.setback)
        assert (across[beside] < width + gap + SLACK + 1e-9).all()
        assert (across[beside] > -gap - SLACK - 1e-9).all()
    assert np.radians(60) < upper <= np.radians(92)
