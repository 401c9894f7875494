"""The three judges: of panels, of lids, and of how panels open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...articulate.seams.learned import Judge
from ...articulate.seams.motions import OpensBy
from ...articulate.seams.reading import NO_LID
from ...mesh import FloatArray
from .learning import Lesson, fitted
from .rows import Rows

#: What a candidate must share with a true panel to be half true, and how fast that grows.
HALF = 0.72
SHARPNESS = 14.0
#: Width of the hidden layers, and decay of their weights.
WIDTHS = {"panel": 8, "lid": 6, "motion": 6}
DECAYS = {"panel": 2e-3, "lid": 4e-3, "motion": 3e-3}
#: Rows are weighed so that no object counts more than so many rows.
MOST_ROWS = 24.0


def fit(objects: Sequence[Rows], seed: int) -> dict[str, Judge]:
    """Judges of all that was seen."""
    lid = _fitted("lid", lid_lesson(objects), seed)
    panel = _fitted("panel", panel_lesson(objects, lid), seed)
    return {
        "panel": panel,
        "lid": lid,
        "motion": _fitted("motion", motion_lesson(objects), seed),
    }


def _fitted(name: str, lesson: Lesson, seed: int) -> Judge:
    return fitted(lesson, WIDTHS[name], DECAYS[name], seed)


def lid_lesson(objects: Sequence[Rows]) -> Lesson:
    """Which rows begin a lid."""
    some = [each for each in objects if len(each.lid)]
    return Lesson(
        np.concatenate([each.lid for each in some]),
        np.concatenate([each.lid_true for each in some])[:, None],
        np.concatenate([np.full(len(each.lid), 1.0) for each in some]),
    )


def panel_lesson(objects: Sequence[Rows], lid: Judge) -> Lesson:
    """Which rectangles are panels, with what is thought of a lid."""
    some = [each for each in objects if len(each.panel)]
    rows = [_with_lid(each, lid) for each in some]
    shared = np.concatenate([each.panel_true for each in some])
    weights = [np.full(len(row), min(MOST_ROWS / len(row), 1.0)) for row in rows]
    return Lesson(
        np.concatenate(rows),
        (1.0 / (1.0 + np.exp(-SHARPNESS * (shared - HALF))))[:, None],
        np.concatenate(weights),
    )


def _with_lid(each: Rows, lid: Judge) -> FloatArray:
    odds = float(lid.logits(each.lid)[:, 0].max()) if len(each.lid) else NO_LID
    return np.concatenate([each.panel[:, :-1], np.full((len(each.panel), 1), odds)], axis=1)


def motion_lesson(objects: Sequence[Rows]) -> Lesson:
    """How panels open."""
    some = [each for each in objects if len(each.motion)]
    ways = np.concatenate([each.motion_way for each in some]).astype(np.int64)
    weights = [np.full(len(row.motion), min(6.0 / len(row.motion), 1.0)) for row in some]
    return Lesson(
        np.concatenate([each.motion for each in some]),
        np.eye(len(OpensBy))[ways],
        np.concatenate(weights),
    )


def report(objects: Sequence[Rows], seed: int) -> str:
    """How judges of four fifths of the objects do on the last fifth."""
    cut = max(len(objects) * 4 // 5, 1)
    judges = fit(objects[:cut], seed)
    held = objects[cut:]
    lines = [
        f"true panels among candidates: {sum(int(each.found) for each in held)} of "
        f"{sum(int(each.wanted) for each in held)}"
    ]
    lessons: Mapping[str, Lesson] = {
        "panel": panel_lesson(held, judges["lid"]),
        "lid": lid_lesson(held),
    }
    for name, lesson in lessons.items():
        said = judges[name].logits(lesson.rows)[:, 0] > 0.0
        true = lesson.wanted[:, 0] > 0.5
        hits = int((said & true).sum())
        lines.append(
            f"{name}: recall {hits / max(int(true.sum()), 1):.3f}, "
            f"precision {hits / max(int(said.sum()), 1):.3f} of {len(true)} candidates"
        )
    motion = motion_lesson(held)
    right = judges["motion"].logits(motion.rows).argmax(axis=1) == motion.wanted.argmax(axis=1)
    lines.append(f"motion: {right.mean():.3f} right of {len(right)}")
    return "\n".join(lines)
