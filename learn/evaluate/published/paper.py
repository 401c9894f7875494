"""The metrics as the paper words them: at rest, and with every part at its farthest."""

from __future__ import annotations

from ..score import Score
from .cloud import ScoredCloud
from .matched import matched
from .state import compared


def paper(true: ScoredCloud, predicted: ScoredCloud) -> Score:
    """Compare a prediction with the truth at rest and fully articulated.

    Boxes of the articulated state are around the articulated points. The paper does not say whether
    distances are squared, nor what an intersection over union of parts is; both are taken from the
    release: squared, and of boxes. Names are those of :func:`.state.compared`, plain at rest and
    with ``articulated_`` at the upper limits.
    """
    matching = matched(true, predicted)
    rest = compared(true, predicted, (true.points, predicted.points), matching)
    full = compared(true, predicted, (true.at(1.0), predicted.at(1.0)), matching)
    return Score({**rest, **{f"articulated_{name}": value for name, value in full.items()}})
