"""Fits the two networks of rectangles: which are panels, and how panels open."""

from collections.abc import Sequence

import numpy as np

from asset_factory.factory.articulate.seams.features import MOTION_NAMES, NAMES
from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.perceptron import Perceptron
from asset_factory.factory.models.shipped import Arrays
from asset_factory.factory.part import OpensBy

from ..elevations.rows import Rows
from .perceptron import Examples, FitSettings, Weighing, averaged, fit_examples
from .writing import networks_stored

INPUTS = {"panel": NAMES, "motion": MOTION_NAMES}
#: What a candidate must share with a true panel to be half true, and how fast that grows.
HALF = 0.72
SHARPNESS = 14.0
#: Width of the hidden layers, and decay of their weights.
WIDTHS = {"panel": 8, "motion": 6}
DECAYS = {"panel": 4e-3, "motion": 6e-3}
#: So many networks with other first weights answer together.
SEVERAL = 5
STEPS = 400
#: Rows are weighed so that no object counts more than so many rows of panels, or of motions.
MOST_ROWS = {"panel": 24.0, "motion": 6.0}


def fit_rectangles(objects: Sequence[Rows], seed: int) -> Arrays:
    """Return the networks of all that was seen."""
    return networks_stored(_networks(objects, seed), INPUTS)


def _networks(objects: Sequence[Rows], seed: int) -> dict[str, Perceptron]:
    return {
        "panel": _fitted("panel", panel_examples(objects), seed),
        "motion": _fitted("motion", motion_examples(objects), seed),
    }


def _fitted(name: str, examples: Examples, seed: int) -> Perceptron:
    weighing = Weighing((examples.rows.shape[1] + 1) ** -0.5, DECAYS[name])
    weights = dict.fromkeys(("inner", "offset", "outer", "base"), weighing)
    several = [
        FitSettings(WIDTHS[name], examples.wanted.shape[1], weights, STEPS, SEVERAL * seed + each)
        for each in range(SEVERAL)
    ]
    return averaged([fit_examples(examples, settings) for settings in several])


def panel_examples(objects: Sequence[Rows]) -> Examples:
    """Return which rectangles are panels."""
    some = [each for each in objects if len(each.panel)]
    rows = [each.panel for each in some]
    shared = np.concatenate([each.panel_true for each in some])
    weights = [_weights("panel", len(row)) for row in rows]
    return Examples(
        np.concatenate(rows),
        (1.0 / (1.0 + np.exp(-SHARPNESS * (shared - HALF))))[:, None],
        np.concatenate(weights),
    )


def motion_examples(objects: Sequence[Rows]) -> Examples:
    """Return how panels open."""
    some = [each for each in objects if len(each.motion)]
    ways = np.concatenate([each.motion_way for each in some]).astype(np.int64)
    weights = [_weights("motion", len(row.motion)) for row in some]
    return Examples(
        np.concatenate([each.motion for each in some]),
        np.eye(len(OpensBy))[ways],
        np.concatenate(weights),
    )


def _weights(name: str, count: int) -> FloatArray:
    return np.full(count, min(MOST_ROWS[name] / count, 1.0))


def report(objects: Sequence[Rows], seed: int) -> str:
    """Return how networks of four fifths of the objects do on the last fifth."""
    cut = max(len(objects) * 4 // 5, 1)
    networks = _networks(objects[:cut], seed)
    held = objects[cut:]
    lines = [
        f"true panels among candidates: {sum(int(each.found) for each in held)} of "
        f"{sum(int(each.wanted) for each in held)}"
    ]
    examples = panel_examples(held)
    said = networks["panel"].scores(examples.rows)[:, 0] > 0.0
    true = examples.wanted[:, 0] > 0.5
    hits = int((said & true).sum())
    lines.append(
        f"panel: recall {hits / max(int(true.sum()), 1):.3f}, "
        f"precision {hits / max(int(said.sum()), 1):.3f} of {len(true)} candidates"
    )
    motion = motion_examples(held)
    right = networks["motion"].scores(motion.rows).argmax(axis=1) == motion.wanted.argmax(axis=1)
    lines.append(f"motion: {right.mean():.3f} right of {len(right)}")
    return "; ".join(lines)
