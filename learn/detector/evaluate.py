"""How well the detector does on labelled objects that it was not trained on."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.detector.canvas import OPENING, SIDES, SORTS
from asset_factory.factory.models.detector.decode import Found, found_parts, overlaps
from asset_factory.factory.models.detector.detect import dense_of
from asset_factory.factory.models.detector.network import cues_of

from .sides import Instances
from .stream import Pool

#: Scores from which on parts count.
FLOORS = (0.3, 0.4, 0.5, 0.6, 0.7)


def evaluate(network: Any, pool: Pool) -> dict[str, Any]:
    """Return by floor how many true parts are found and how many others are told."""
    counts = {floor: np.zeros((OPENING, 4), np.int64) for floor in FLOORS}
    still = dict.fromkeys(FLOORS, 0)
    fronts = kinds = opening = quiet = 0
    for number in range(pool.made):
        batch, whole = pool.take(torch.tensor([number], device=pool.device))
        cues = cues_of(batch.color.flatten(0, 1), batch.depth.flatten(0, 1))[None]
        with torch.no_grad():
            answers = network(cues)
        table = batch.table[0].cpu().numpy()
        table = table[table[:, 0] >= 0]
        fronts += int(answers.front.argmax() == whole[0, 2]) * int(whole[0, 1])
        kinds += int(answers.kind.argmax() == whole[0, 0])
        opening += int(whole[0, 1])
        quiet += int((answers.opens[0] > 0) == (whole[0, 1] > 0))
        dense = dense_of(answers)
        for floor in FLOORS:
            found = [p for p in found_parts(dense, floor) if SORTS.index(p.sort) < OPENING]
            if not whole[0, 1]:
                still[floor] += int(bool(found))
            counts[floor] += compared(found, table)
    shut = pool.made - opening
    figures: dict[str, Any] = {
        "objects": pool.made,
        "kind right": kinds / pool.made,
        "opens right": quiet / pool.made,
        "front right of those that open": fronts / max(opening, 1),
    }
    told = {str(floor): f"{count} of {shut}" for floor, count in still.items()}
    figures["of those that stay shut something is told"] = told
    names = ("true", "found", "way right", "spurious")
    for floor, count in counts.items():
        rows = zip(SORTS, count.tolist(), strict=False)
        figures[f"from {floor}"] = {
            str(sort): dict(zip(names, row, strict=True)) for sort, row in rows
        }
    return figures


def compared(found: list[Found], table: FloatArray) -> Any:
    """Return by sort how many are true, found, found with their way, and spurious, [4, 4]."""
    counts = np.zeros((OPENING, 4), np.int64)
    free = [True] * len(found)
    for row in table:
        if row[9] > 0 or row[6] >= OPENING:
            continue
        sort = int(row[6])
        counts[sort, 0] += 1
        fits = [
            number
            for number, part in enumerate(found)
            if free[number]
            and SIDES.index(part.side) == int(row[0])
            and SORTS.index(part.sort) == sort
            and float(overlaps(part.box, row[None, 1:5])[0]) >= 0.5
        ]
        if fits:
            free[fits[0]] = False
            counts[sort, 1] += 1
            way = found[fits[0]].ways.argmax()
            counts[sort, 2] += int(row[7] < 0 or way == int(row[7]))
    known = Instances.of(table)
    for number, part in enumerate(found):
        if free[number] and not known.knows_nothing_of(SIDES.index(part.side), part.box):
            counts[SORTS.index(part.sort), 3] += 1
    return counts
