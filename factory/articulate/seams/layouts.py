"""Which rectangles of a front are panels, learned from generated objects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray
from .candidates import FrontScene, PanelCandidate, candidates_of
from .features import NAMES, Context, features
from .groups import FrontPanel, Group, together
from .learned import load_judge
from .rectangles import Rectangle

#: Log-odds from which a panel is sure.
SURE = 0.6


@dataclass(frozen=True, eq=False)
class PanelLayout:
    """Panels of one side that can be there together.

    Attributes:
        panels: all that open.
        value: log-odds of all of them, as if each were independent.
    """

    panels: tuple[FrontPanel, ...]
    value: float


def layout_of(scene: FrontScene, found: Sequence[Rectangle]) -> PanelLayout:
    """Return what surely opens on one side, as far as that can be there together.

    Args:
        scene: the side.
        found: its closed rectangles, the best first.
    """
    groups = [
        group
        for group in rated(scene, candidates_of(scene, found))
        if min(panel.value for panel in group.panels) >= SURE
    ]
    chosen = together(groups)
    return PanelLayout(
        tuple(panel for group in chosen for panel in group.panels),
        sum(group.value for group in chosen),
    )


def value_of(scene: FrontScene, panels: Sequence[FrontPanel], found: Sequence[Rectangle]) -> float:
    """Return the log-odds of panels that somebody else found."""
    if not panels:
        return 0.0
    others = [each.rectangle for each in candidates_of(scene, found) if not each.cut]
    around = Context(scene, others or [panel.rectangle for panel in panels])
    rows = [features(around, panel.rectangle, cut=panel.cut) for panel in panels]
    return float(load_judge("panel", NAMES).scores(np.stack(rows))[:, 0].sum())


def rated(scene: FrontScene, candidates: Sequence[PanelCandidate]) -> list[Group]:
    """Return the candidates with their probabilities, the likeliest first."""
    if not candidates:
        return []
    pieces, rows = described(scene, candidates)
    values = load_judge("panel", NAMES).scores(rows)[:, 0].tolist()
    panels = iter(
        FrontPanel(piece, scene.handles_in(piece), value, cut)
        for (piece, cut), value in zip(pieces, values, strict=True)
    )
    groups = [
        Group(each.rectangle, tuple(next(panels) for _ in each.pieces)) for each in candidates
    ]
    return sorted(groups, key=lambda group: -group.value)


def described(
    scene: FrontScene, candidates: Sequence[PanelCandidate]
) -> tuple[list[tuple[Rectangle, bool]], FloatArray]:
    """Return every piece, whether it was cut, and its features [piece_count, ...]."""
    around = Context(scene, [each.rectangle for each in candidates if not each.cut])
    pieces = [(piece, each.cut) for each in candidates for piece in each.pieces]
    return pieces, np.stack([features(around, piece, cut=cut) for piece, cut in pieces])
