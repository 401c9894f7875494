"""Panels without a seam between them are cut where their handles say."""

import numpy as np
import pytest

from asset_factory.factory.articulate.seams.dividing import divided
from asset_factory.factory.articulate.seams.handles import Protrusion
from asset_factory.factory.articulate.seams.rectangles import Lines, Rectangle

HEIGHT = 300
NO_LINES = Lines(np.zeros(0, dtype=np.int64), *(np.zeros((0, HEIGHT + 1)),) * 3)


def cuts_between(places):
    """Rows where a tall rectangle is cut that has bars of ten rows from ``places`` on."""
    whole = Rectangle(np.array([0, 0]), np.array([HEIGHT, 100]), np.ones(4), np.ones(4))
    bars = [Protrusion(np.array([at, 30]), np.array([at + 9, 70]), 8.0, 1.0) for at in places]
    pieces = [piece for piece, _ in divided(whole, bars, NO_LINES, NO_LINES)]
    assert len(pieces) == len(places)
    return sorted(int(piece.low[0]) for piece in pieces)[1:]


@pytest.mark.parametrize(
    ("places", "cuts"),
    [
        ([80, 180, 280], [100, 200]),  # at the tops of drawers
        ([10, 110, 210], [100, 200]),  # at their feet
        ([45, 145, 245], [100, 200]),  # in their middles
        ([100, 190], [150]),  # a tall door under another: beside the seam
    ],
)
def test_every_panel_has_its_handle_where_the_outermost_has(places, cuts):
    assert cuts_between(places) == pytest.approx(cuts, abs=2)
