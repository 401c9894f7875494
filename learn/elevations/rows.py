"""What there is to learn from: features of candidates, and whether they are true."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from asset_factory.factory.articulate.seams.candidates import candidates_of, in_common
from asset_factory.factory.articulate.seams.features import motion_features
from asset_factory.factory.articulate.seams.fronts import AROUND, OPPOSITE, Front
from asset_factory.factory.articulate.seams.handles import cleared
from asset_factory.factory.articulate.seams.layouts import described
from asset_factory.factory.articulate.seams.rectangles import Rectangle
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.part import OpensBy
from asset_factory.factory.views.raster import Side

from .pictures import Picture, pictures_of
from .truths import TruePanel, truth_of

#: A candidate that shares so much with a true panel (intersection over union) has found it.
SEEN = 0.75
#: Of objects with panels so many are also looked at where there is none.
EMPTY = 0.4
#: True panels are shifted by so many pixels at either end, to learn how they open.
SHIFT = 3


@dataclass(frozen=True)
class Rows:
    """Of one object; figures of n rows each.

    Attributes:
        panel, panel_true: features of rectangles that may be panels, and what they share with the
            nearest true one, 0 to 1.
        motion, motion_way: of true panels, and which of :class:`OpensBy` they open by.
        found, wanted: true panels among the candidates, and all.
    """

    panel: FloatArray
    panel_true: FloatArray
    motion: FloatArray
    motion_way: FloatArray
    found: int
    wanted: int


def rows_of(articulation: Articulation, rng: np.random.Generator) -> Rows:
    """Return what can be learned from one object that is looked at once.

    Args:
        articulation: its front towards -Y.
        rng: of its looks.
    """
    pictures = pictures_of(articulation, rng, (Side.FRONT, Side.BACK, Side.TOP))
    truth = truth_of(articulation, pictures)
    panel: list[FloatArray] = []
    panel_true: list[float] = []
    motion: list[FloatArray] = []
    way: list[int] = []
    found = 0
    for side, front in _fronts(pictures, truth, rng).items():
        true = [each for each in truth if each.side is side]
        pieces, rows = _candidates(front)
        panel.extend(rows)
        shared = [[in_common(one, each.rectangle) for each in true] for one in pieces]
        panel_true.extend(max(each, default=0.0) for each in shared)
        near = np.array(shared).reshape(len(pieces), len(true))
        found += int((near >= SEEN).any(axis=0).sum())
        places = _shifted(true, rng)
        for each, place in zip(true, places, strict=True):
            if each.way is not None:
                motion.append(motion_features(front.scene, place, places))
                way.append(list(OpensBy).index(each.way))
    return Rows(
        stacked(panel),
        np.array(panel_true),
        stacked(motion),
        np.array(way, dtype=np.int64),
        found,
        len(truth),
    )


def _fronts(
    pictures: dict[Side, Picture], truth: Sequence[TruePanel], rng: np.random.Generator
) -> dict[Side, Front]:
    """Return the sides with panels, and sometimes one without."""
    some = [side for side in AROUND if any(each.side is side for each in truth)]
    none = [side for side in AROUND if side in pictures and side not in some]
    if none and (not some or rng.random() < EMPTY):
        some.append(none[int(rng.integers(len(none)))])
    reliefs = {side: each.relief for side, each in pictures.items()}
    return {
        side: Front(
            reliefs[side],
            cleared(reliefs[side]).without_mirrored(cleared(reliefs[OPPOSITE[side]])),
            reliefs[OPPOSITE[side]],
        )
        for side in some
    }


def _candidates(front: Front) -> tuple[list[Rectangle], list[FloatArray]]:
    candidates = candidates_of(front.scene, front.rectangles())
    if not candidates:
        return [], []
    pieces, rows = described(front.scene, candidates)
    return [piece for piece, _ in pieces], list(rows)


def _shifted(true: Sequence[TruePanel], rng: np.random.Generator) -> list[Rectangle]:
    def moved(rectangle: Rectangle) -> Rectangle:
        low, high = rng.integers(-SHIFT, SHIFT + 1, (2, 2))
        return Rectangle(
            np.maximum(rectangle.low + low, 0),
            np.maximum(rectangle.high + high, rectangle.low + low + 4),
            rectangle.sides,
            rectangle.relief,
        )

    return [moved(each.rectangle) for each in true]


def stacked(rows: Sequence[FloatArray]) -> FloatArray:
    """Return the rows of features, shape [n, feature_count]; [0, 0] without any."""
    return np.stack(rows) if rows else np.zeros((0, 0))
