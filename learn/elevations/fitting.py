"""The two judges: of panels, and of how they open."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from asset_factory.factory.articulate.seams.learned import LearnedJudge
from asset_factory.factory.part import OpensBy

from .learning import Examples, averaged, fitted
from .rows import Rows

#: What a candidate must share with a true panel to be half true, and how fast that grows.
HALF = 0.72
SHARPNESS = 14.0
#: Width of the hidden layers, and decay of their weights.
WIDTHS = {"panel": 8, "motion": 6}
DECAYS = {"panel": 2e-3, "motion": 3e-3}
#: So many networks with other first weights answer together.
SEVERAL = 5
#: Rows are weighed so that no object counts more than so many rows.
MOST_ROWS = 24.0


def fit(objects: Sequence[Rows], seed: int) -> dict[str, LearnedJudge]:
    """Judges of all that was seen."""
    return {
        "panel": _fitted("panel", panel_lesson(objects), seed),
        "motion": _fitted("motion", motion_lesson(objects), seed),
    }


def _fitted(name: str, examples: Examples, seed: int) -> LearnedJudge:
    several = [
        fitted(examples, WIDTHS[name], DECAYS[name], SEVERAL * seed + each)
        for each in range(SEVERAL)
    ]
    return averaged(several)


def panel_lesson(objects: Sequence[Rows]) -> Examples:
    """Return which rectangles are panels."""
    some = [each for each in objects if len(each.panel)]
    rows = [each.panel for each in some]
    shared = np.concatenate([each.panel_true for each in some])
    weights = [np.full(len(row), min(MOST_ROWS / len(row), 1.0)) for row in rows]
    return Examples(
        np.concatenate(rows),
        (1.0 / (1.0 + np.exp(-SHARPNESS * (shared - HALF))))[:, None],
        np.concatenate(weights),
    )


def motion_lesson(objects: Sequence[Rows]) -> Examples:
    """Return how panels open."""
    some = [each for each in objects if len(each.motion)]
    ways = np.concatenate([each.motion_way for each in some]).astype(np.int64)
    weights = [np.full(len(row.motion), min(6.0 / len(row.motion), 1.0)) for row in some]
    return Examples(
        np.concatenate([each.motion for each in some]),
        np.eye(len(OpensBy))[ways],
        np.concatenate(weights),
    )


def report(objects: Sequence[Rows], seed: int) -> str:
    """Return how judges of four fifths of the objects do on the last fifth."""
    cut = max(len(objects) * 4 // 5, 1)
    judges = fit(objects[:cut], seed)
    held = objects[cut:]
    lines = [
        f"true panels among candidates: {sum(int(each.found) for each in held)} of "
        f"{sum(int(each.wanted) for each in held)}"
    ]
    examples = panel_lesson(held)
    said = judges["panel"].logits(examples.rows)[:, 0] > 0.0
    true = examples.wanted[:, 0] > 0.5
    hits = int((said & true).sum())
    lines.append(
        f"panel: recall {hits / max(int(true.sum()), 1):.3f}, "
        f"precision {hits / max(int(said.sum()), 1):.3f} of {len(true)} candidates"
    )
    motion = motion_lesson(held)
    right = judges["motion"].logits(motion.rows).argmax(axis=1) == motion.wanted.argmax(axis=1)
    lines.append(f"motion: {right.mean():.3f} right of {len(right)}")
    return "\n".join(lines)
