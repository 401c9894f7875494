"""Fits how likely a part is there by what the detector sees, on objects that are new to it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from pathlib import Path

import numpy as np
from scipy.special import expit

from asset_factory.factory.articulate.articulator import Articulator
from asset_factory.factory.articulate.detected.agreement import LID, PANEL, PROPOSED, SIGNS
from asset_factory.factory.articulate.detected.articulator import ASKED, LEAST_SCORE, STRANGE
from asset_factory.factory.articulate.detected.panels import panels_of
from asset_factory.factory.articulate.detected.rating import CellParts, support_of_box
from asset_factory.factory.articulate.origin import MeshOrigin
from asset_factory.factory.articulate.stated.seen import SeenMesh
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.mesh import FloatArray, Mesh
from asset_factory.factory.models.detector.canvas import SIDES, SORTS, STRIDE, Sort, look_at
from asset_factory.factory.models.detector.decode import overlaps
from asset_factory.factory.models.detector.detect import Detection, detect
from asset_factory.factory.models.perceptron import Perceptron
from asset_factory.factory.models.shipped import Arrays

from ..detector.real import real_objects
from ..detector.sides import BOX, IGNORED, SORT, VIEW, knows_nothing_of, labelled_sides
from ..evaluate.cases import in_settings, make_case
from ..evaluate.listing import real_requests
from ..surfaces import coloured_skin
from .perceptron import FitSettings, Weighing, cross_entropy, fit_scaled
from .writing import networks_stored

#: A part is right if a true one has a box of this intersection over union on some side.
SAME_PART = 0.5
#: Probability below which a part stays fixed. Of the 103 joints of the held-out meshes 78 are right
#: from it on and 9 spurious, 56 and 7 made one piece, where something opens on 2 of 35 that stay
#: shut; from 0.4 on 78 and 9, 56 and 8, on 3 of 35.
LEAST = 0.45
STEPS = 200
#: Ranges of probability that the card tells of.
RANGES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.01)
#: Sorts of true parts that a panel, and a lid, may be.
_TRUE = {PANEL: (Sort.DOOR, Sort.DRAWER, Sort.FLAP), LID: (Sort.LID,), PROPOSED: SORTS}

#: Signs of each part, as ``SIGNS`` names them, and 1 or 0: whether it is right.
Rated = dict[str, list[tuple[float, ...]]]


@dataclass(frozen=True, eq=False)
class LabelledMesh:
    """A mesh, z up, and what opens on each of its sides.

    Attributes:
        mesh: z up.
        truth: the table of what opens.
        own: rate what only the detector sees, too. On the list's objects as they are others propose
            it, and with their lids the detector opened a plain box.
    """

    mesh: Mesh
    truth: FloatArray
    own: bool = True


def labelled_meshes(folders: Sequence[Path], root: Path) -> Iterator[LabelledMesh]:
    """Yield labelled real meshes that the detector did not see, as they are and made one piece.

    After them come the objects in ``root`` of the list's half to tune on, likewise; of those as
    they are only what others propose is rated.

    Raises:
        ConfigError: an object of the list is not there.
    """
    real = chain.from_iterable(real_objects(folder, held_out=True) for folder in folders)
    for seed, each in enumerate(real):
        yield LabelledMesh(each.mesh, each.sides.table)
        yield LabelledMesh(coloured_skin(each.mesh, seed), each.sides.table)
    requests = real_requests(root, "develop")
    fused = [replace(request, fused=True) for request in requests]
    for request in in_settings([*requests, *fused], ("closed",), ("front",)):
        try:
            made = make_case(request)
        except InputRejected:
            continue
        yield LabelledMesh(made.mesh, labelled_sides(made).table, own=request.fused)


def rate_parts(guess: Articulator, objects: Iterable[LabelledMesh]) -> Rated:
    """Return the parts proposed for objects by model, and what the detector sees of them."""
    rated: Rated = {name: [] for name in SIGNS}
    for each in objects:
        detection = detect(each.mesh)
        if each.own:
            _rate_own(rated, each, detection)
        try:
            _rate_proposed(rated, guess, each, detection)
        except InputRejected:
            continue
    return rated


def _rate_own(rated: Rated, each: LabelledMesh, detection: Detection) -> None:
    """Add the panels and lids that the detector sees itself."""
    seen = SeenMesh.of(each.mesh)
    closed = MeshOrigin.of(each.mesh).is_shell
    for found, signs in panels_of(detection.dense, seen, closed=closed):
        box = [(SIDES.index(found.side), found.box)]
        _add(rated[PANEL], signs.tolist(), _right(box, each.truth, _TRUE[PANEL]))
    lids = [found for found in detection.parts(LEAST_SCORE) if found.sort is Sort.LID]
    if lids:
        support = max(support_of_box(found, detection.dense) for found in lids)
        boxes = [(SIDES.index(found.side), found.box) for found in lids]
        _add(rated[LID], [support], _right(boxes, each.truth, _TRUE[LID]))


def _rate_proposed(
    rated: Rated, guess: Articulator, each: LabelledMesh, detection: Detection
) -> None:
    """Add the parts that others propose, where the detector is asked; raises what they do."""
    if detection.kind in STRANGE:
        return
    articulation = guess.articulate(each.mesh)
    cells = CellParts.of(articulation, look_at(articulation.mesh).cells)
    for joint in articulation.movable_joints:
        part = articulation.parts[joint.child]
        signs = cells.signs(joint.child, detection)
        if part.kind in ASKED and signs is not None:
            right = _right(_boxes(cells, joint.child), each.truth, _TRUE[PROPOSED])
            _add(rated[PROPOSED], signs.tolist(), right)


def _add(rows: list[tuple[float, ...]], signs: Sequence[float], right: bool | None) -> None:
    if right is not None:
        rows.append((*signs, float(right)))


def fit_agreement(rated: Rated) -> Arrays:
    """Return the logistic models."""
    networks = {name: _fitted(rows) for name, rows in rated.items()}
    return networks_stored(networks, SIGNS, {"least": np.array([LEAST])})


def report(stored: Arrays, rated: Rated) -> str:
    """Return how many parts there are, how many are right, and how many of those so probable."""
    return "; ".join(
        f"{name}: {sum(row[-1] for row in rows):.0f} of {len(rows)} right"
        + "".join(_reliability(Perceptron.read(stored, name, SIGNS[name]), rows))
        for name, rows in rated.items()
    )


def _reliability(network: Perceptron, rows: Sequence[tuple[float, ...]]) -> Iterator[str]:
    """Yield by range of probability how many of the parts are right."""
    table = np.array(rows)
    chances = expit([network.scores(signs)[0] for signs in table[:, :-1]])
    for low, high in pairwise(RANGES):
        here = (chances >= low) & (chances < high)
        if here.any():
            right = f"{table[here, -1].sum():.0f} of {here.sum()}"
            yield f", of those from {low} to {high:.1f} on {right}"


def _fitted(rows: Sequence[tuple[float, ...]]) -> Perceptron:
    table = np.array(rows)
    weights = {name: Weighing(0.0, 1e-3) for name in ("base", "direct")}
    settings = FitSettings(0, weights, STEPS)
    return fit_scaled(table[:, :-1], cross_entropy(table[:, -1:]), settings)


def _boxes(cells: CellParts, part: int) -> Iterator[tuple[int, FloatArray]]:
    """Yield the sides that show a part, with its box on the canvas."""
    for view, shown in enumerate(cells.shown(part)):
        rows, columns = np.nonzero(shown)
        if len(rows):
            ends = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
            yield view, np.array(ends) * float(STRIDE)


def _right(
    boxes: Iterable[tuple[int, FloatArray]], truth: FloatArray, sorts: Sequence[Sort]
) -> bool | None:
    """Tell whether a part in these boxes of sides is a true one; ``None``: nothing is known."""
    wanted = np.isin(truth[:, SORT], [SORTS.index(sort) for sort in sorts])
    for view, box in boxes:
        known = wanted & (truth[:, VIEW] == view) & (truth[:, IGNORED] == 0.0)
        if known.any() and float(overlaps(box, truth[known, BOX]).max()) >= SAME_PART:
            return True
        if knows_nothing_of(truth, view, box):
            return None
    return False
