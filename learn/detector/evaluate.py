"""How well the detector does on labelled objects that it was not trained on."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.detector.canvas import OPENING, SIDES, SORTS
from asset_factory.factory.models.detector.decode import Found, found_parts, overlaps
from asset_factory.factory.models.detector.detect import first_of
from asset_factory.factory.models.detector.network import cues_of

from .sides import BOX, IGNORED, SORT, VIEW, WAY, knows_nothing_of
from .stream import Pool

#: Score from which on parts count.
FLOOR = 0.7


def evaluate(network: Any, pool: Pool) -> dict[str, Any]:
    """Return how many true parts are found and others told, and how often the rest is right."""
    counts = np.zeros((OPENING, 4), np.int64)
    still = fronts = kinds = opening = quiet = 0
    for number in range(pool.made):
        batch = pool.take(torch.tensor([number], device=pool.device))
        kind, opens, front, _ = batch.whole[0].tolist()
        cues = cues_of(batch.color.flatten(0, 1), batch.depth.flatten(0, 1))[None]
        with torch.no_grad():
            answers = network(cues)
        table = batch.table[0].cpu().numpy()
        told = found_parts(first_of(answers), FLOOR)
        found = [part for part in told if SORTS.index(part.sort) < OPENING]
        counts += compared(found, table[table[:, VIEW] >= 0])
        fronts += int(answers.front.argmax() == front) * opens
        kinds += int(answers.kind.argmax() == kind)
        opening += opens
        quiet += int((answers.opens[0] > 0) == (opens > 0))
        still += int(bool(found) and not opens)
    names = ("true", "found", "way right", "spurious")
    rows = zip(SORTS, counts.tolist(), strict=False)
    return {
        "objects": pool.made,
        "kind right": kinds / pool.made,
        "opens right": quiet / pool.made,
        "front right of those that open": fronts / max(opening, 1),
        "of those that stay shut something is told": f"{still} of {pool.made - opening}",
        f"from {FLOOR}": {str(sort): dict(zip(names, row, strict=True)) for sort, row in rows},
    }


def compared(found: list[Found], table: FloatArray) -> Any:
    """Return by sort how many are true, found, found with their way, and spurious, [4, 4]."""
    counts = np.zeros((OPENING, 4), np.int64)
    free = [True] * len(found)
    for row in table:
        if row[IGNORED] > 0 or row[SORT] >= OPENING:
            continue
        sort = int(row[SORT])
        counts[sort, 0] += 1
        fits = [
            number
            for number, part in enumerate(found)
            if free[number]
            and SIDES.index(part.side) == int(row[VIEW])
            and SORTS.index(part.sort) == sort
            and float(overlaps(part.box, row[None, BOX])[0]) >= 0.5
        ]
        if fits:
            free[fits[0]] = False
            counts[sort, 1] += 1
            way = found[fits[0]].ways.argmax()
            counts[sort, 2] += int(row[WAY] < 0 or way == int(row[WAY]))
    for number, part in enumerate(found):
        if free[number] and not knows_nothing_of(table, SIDES.index(part.side), part.box):
            counts[SORTS.index(part.sort), 3] += 1
    return counts
