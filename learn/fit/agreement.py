"""Fits how likely a part is there by what the detector sees of it, on real labelled meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from asset_factory.factory.articulate.articulator import Articulator
from asset_factory.factory.articulate.detected.agreement import ALONE, PROPOSED, SIGNS
from asset_factory.factory.articulate.detected.articulator import ASKED, LEAST_SCORE
from asset_factory.factory.articulate.detected.merging import seen_parts
from asset_factory.factory.articulate.detected.rating import CellParts, support_of_box
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.detector.canvas import SIDES, STRIDE, look_at
from asset_factory.factory.models.detector.decode import overlaps
from asset_factory.factory.models.detector.detect import detect
from asset_factory.factory.models.perceptron import Perceptron
from asset_factory.factory.models.shipped import Arrays

from ..detector.real import RealObject
from ..detector.sides import Instances
from .perceptron import Examples, FitSettings, Weighing, fit_examples
from .writing import networks_stored

#: A part is right if a true one has a box of this intersection over union on some side.
SAME_PART = 0.5
#: Probability below which a part stays fixed. Of 105 held-out joints 69 are right at 0.5 and 8 are
#: spurious; at 0.4 it is 73 and 9.
LEAST = 0.4
STEPS = 200


@dataclass(frozen=True)
class Rated:
    """Parts of labelled meshes, with what speaks for each and whether it is right.

    Attributes:
        proposed, alone: signs of each part, as :data:`SIGNS` names them, and 1 or 0.
    """

    proposed: list[tuple[float, float, float]]
    alone: list[tuple[float, float]]


def rate_parts(guess: Articulator, objects: Iterable[RealObject]) -> Rated:
    """Return the parts proposed for objects, and what the detector sees of them."""
    rated = Rated([], [])
    for each in objects:
        detection = detect(each.mesh)
        truth = each.sides.instances
        for part in seen_parts(detection.parts(LEAST_SCORE), each.mesh.extents):
            support = max(support_of_box(found, detection.dense) for found in part.found)
            boxes = [(SIDES.index(found.side), found.box) for found in part.found]
            right = _right(boxes, truth)
            if right is not None:
                rated.alone.append((support, float(right)))
        try:
            articulation = guess.articulate(each.mesh)
        except InputRejected:
            continue
        cells = CellParts.of(articulation, look_at(articulation.mesh).cells)
        for joint in articulation.movable_joints:
            part_ = articulation.parts[joint.child]
            shown = cells.support(joint.child, detection.dense)
            if part_.kind not in ASKED or shown is None:
                continue
            right = _right(_boxes(cells, joint.child), truth)
            if right is not None:
                rated.proposed.append((shown, part_.confidence or 0.0, float(right)))
    return rated


def fit_agreement(rated: Rated) -> Arrays:
    """Return the two logistic models."""
    networks = {PROPOSED: _fitted(rated.proposed), ALONE: _fitted(rated.alone)}
    return networks_stored(networks, SIGNS, {"least": np.array([LEAST])})


def report(rated: Rated) -> str:
    """Return how many parts there are, and how many of them are right."""
    said = []
    for name, rows in ((PROPOSED, rated.proposed), (ALONE, rated.alone)):
        said.append(f"{name}: {sum(row[-1] for row in rows):.0f} of {len(rows)} right")
    return ", ".join(said)


def _fitted(rows: Sequence[tuple[float, ...]]) -> Perceptron:
    table = np.array(rows)
    examples = Examples(table[:, :-1], table[:, -1:], np.ones(len(table)))
    weights = {name: Weighing(0.0, 1e-3) for name in ("base", "direct")}
    return fit_examples(examples, FitSettings(0, 1, weights, STEPS))


def _boxes(cells: CellParts, part: int) -> Iterator[tuple[int, FloatArray]]:
    """Yield the sides that show a part, with its box on the canvas."""
    for view, shown in enumerate(cells.shown(part)):
        rows, columns = np.nonzero(shown)
        if len(rows):
            ends = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
            yield view, np.array(ends) * float(STRIDE)


def _right(boxes: Iterable[tuple[int, FloatArray]], truth: Instances) -> bool | None:
    """Tell whether a part in these boxes of sides is a true one; ``None``: nothing is known."""
    for view, box in boxes:
        here = truth.view == view
        known = here & ~truth.ignored
        if known.any() and float(overlaps(box, truth.box[known]).max()) >= SAME_PART:
            return True
        unknown = here & truth.ignored
        if unknown.any() and float(overlaps(box, truth.box[unknown]).max()) >= SAME_PART:
            return None
    return False
