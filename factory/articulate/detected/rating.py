"""How well parts agree with what the detector sees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import expit

from ...articulation import Articulation
from ...geometry.posing import face_parts
from ...mesh import BoolArray, FloatArray, IntArray
from ...models.detector.canvas import CANVAS, OPENING, SIDES, STRIDE, Sort
from ...models.detector.decode import Dense, Found
from ...models.detector.detect import Detection
from ...part import Part, PartKind, Proposer

#: These kinds of part come and go with others that move.
CARRIED = frozenset({PartKind.KNOB, PartKind.BUTTON, PartKind.RACK, PartKind.TURNTABLE})
#: A part that fewer cells show is not seen.
LEAST_CELLS = 2
#: Two parts of which one has so much of the other's cells on a side are in one place.
SAME_PLACE = 0.3
_CELLS = (np.arange(CANVAS // STRIDE) + 0.5) * STRIDE


@dataclass(frozen=True, eq=False)
class CellParts:
    """Which part of an articulation every cell of 4 pixels shows.

    Attributes:
        owner: its number, -1 where nothing is seen, shape [5, 64, 64].
        articulation: whose.
    """

    owner: IntArray
    articulation: Articulation

    @classmethod
    def of(cls, articulation: Articulation, faces: IntArray) -> CellParts:
        """Return them by the faces that cells show, shape [5, 64, 64]."""
        return cls(np.append(face_parts(articulation), -1)[faces], articulation)

    def shown(self, part: int) -> BoolArray:
        """Return the cells that show a part or what it carries, shape [5, 64, 64]."""
        return np.isin(self.owner, self.articulation.carried(part))

    def signs(self, part: int, detection: Detection) -> FloatArray | None:
        """Return what speaks for a part that somebody proposes, as ``PROPOSED_SIGNS`` names it.

        Its support is that on the side where it is highest. ``None`` of one that no side shows:
        behind a door the detector sees nothing.
        """
        shown = self.shown(part)
        views = np.flatnonzero(shown.sum(axis=(1, 2)) >= LEAST_CELLS).tolist()
        if not views:
            return None
        support = max(_support_of_cells(shown[view], detection.dense, view) for view in views)
        proposed = self.articulation.parts[part]
        return np.array([support, np.sqrt(support), by_rules(proposed), detection.opens])

    def hides(self, part: int, found: Found) -> bool:
        """Tell whether a part is where another is seen."""
        return self._fills(self.shown(part), found)

    def _fills(self, cells: BoolArray, found: Found) -> bool:
        """Tell whether cells, shape [5, 64, 64], are a share of those where a part is seen."""
        view = SIDES.index(found.side)
        seen = (self.owner[view] >= 0) & box_cells(found.box)
        return bool((cells[view] & seen).sum() > SAME_PLACE * max(seen.sum(), 1))

    def lies_in(self, part: int, found: Found, share: float = 0.5) -> bool:
        """Tell whether another is seen all around a part, or around a share of it."""
        shown = self.shown(part)[SIDES.index(found.side)]
        return bool((shown & box_cells(found.box)).sum() > share * max(shown.sum(), 1))

    def has_moving(self, found: Found) -> bool:
        """Tell whether parts that move are where another is seen; knobs on panels are not asked."""
        asked = [
            joint.child
            for joint in self.articulation.joints
            if found.sort is Sort.LID or self.articulation.parts[joint.child].kind not in CARRIED
        ]
        around = any(self.lies_in(part, found, SAME_PLACE) for part in asked)
        return around or self._fills(self.owner > 0, found)


def by_rules(part: Part) -> bool:
    """Tell whether rules of shape found a part and say what it is."""
    return part.kind is not PartKind.PART and part.is_by(Proposer.RULES, Proposer.SIDES)


def box_cells(box: FloatArray) -> BoolArray:
    """Return the cells in a box, shape [64, 64]."""
    left, low, right, high = box
    columns = (left < _CELLS) & (right > _CELLS)
    rows = (low < _CELLS) & (high > _CELLS)
    return np.asarray(rows[:, None] & columns)


def support_of_box(found: Found, dense: Dense) -> float:
    """Return the support of a part that the detector itself sees, 0 to 1."""
    rows, columns = np.nonzero(box_cells(found.box))
    if len(rows) < LEAST_CELLS:
        return 0.0
    return _support(dense, SIDES.index(found.side), rows, columns, found.box)


def _support_of_cells(shown: BoolArray, dense: Dense, view: int) -> float:
    rows, columns = np.nonzero(shown)
    ends = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
    return _support(dense, view, rows, columns, np.array(ends) * float(STRIDE))


def _support(dense: Dense, view: int, rows: IntArray, columns: IntArray, box: FloatArray) -> float:
    """Return how much cells of a side speak for a box.

    That is the mean over them of the probability of the likeliest sort that opens, times the
    intersection over union of the box that each cell sees with this one.
    """
    left, bottom, right, top = dense.edges[view][:, rows, columns]
    x = _CELLS[columns]
    y = _CELLS[rows]
    wide = np.minimum(x + right, box[2]) - np.maximum(x - left, box[0])
    tall = np.minimum(y + top, box[3]) - np.maximum(y - bottom, box[1])
    inner = np.maximum(wide, 0.0) * np.maximum(tall, 0.0)
    area = float(np.prod(box[2:] - box[:2]))
    union = (left + right) * (bottom + top) + area - inner
    share = expit(dense.sort[view][:OPENING, rows, columns])
    return float((share * inner / np.maximum(union, 1.0)).mean(axis=1).max())
