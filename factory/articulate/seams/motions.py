"""How a panel opens: hinged at one of its edges, or sliding out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ...mesh import FloatArray
from .candidates import FrontScene
from .features import MOTION_NAMES, motion_features
from .learned import load_judge
from .panels import FrontPanel


class OpensBy(StrEnum):
    """How a panel opens, as the viewer sees it: the edge of its hinge, or outwards."""

    LEFT = "left"
    RIGHT = "right"
    BOTTOM = "bottom"
    TOP = "top"
    OUT = "out"


@dataclass(frozen=True, eq=False)
class Opening:
    """A panel with the ways it may open.

    Attributes:
        panel: which.
        ways: with the probability of each, the likeliest first.
    """

    panel: FrontPanel
    ways: tuple[tuple[OpensBy, float], ...]

    @property
    def way(self) -> OpensBy:
        """The likeliest."""
        return self.ways[0][0]


def openings_of(scene: FrontScene, panels: Sequence[FrontPanel]) -> tuple[Opening, ...]:
    """The ways in which each panel of a side may open."""
    if not panels:
        return ()
    every = [panel.rectangle for panel in panels]
    rows = np.stack([motion_features(scene, each, every) for each in every])
    values = load_judge("motion", MOTION_NAMES).logits(rows)
    return tuple(
        Opening(panel, _ranked(value)) for panel, value in zip(panels, values, strict=True)
    )


def _ranked(values: FloatArray) -> tuple[tuple[OpensBy, float], ...]:
    """Ways with their probabilities, the likeliest first."""
    shares = np.exp(values - values.max())
    shares /= shares.sum()
    ways = zip(OpensBy, shares.tolist(), strict=True)
    return tuple(sorted(ways, key=lambda each: -each[1]))
