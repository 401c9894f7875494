"""Real meshes with their openings labelled by eye, as the detector sees them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.load import load
from asset_factory.factory.mesh import FloatArray, Mesh
from asset_factory.factory.models.detector.canvas import (
    CANVAS,
    LONGEST,
    SIDES,
    SORTS,
    look_at,
    on_canvas,
)

from ..labelled import LabelledObject, LabelledPart, files_of, is_held_out, labelled_objects
from .sides import COLUMNS, LabelledSides


@dataclass(frozen=True, eq=False)
class RealObject:
    """One labelled mesh, z up, and its sides."""

    name: str
    label: LabelledObject
    mesh: Mesh
    sides: LabelledSides


def real_objects(folder: Path, held_out: bool = False) -> Iterator[RealObject]:
    """Yield the meshes of a folder with ``INVENTORY.csv`` of which the package has labels.

    With ``held_out`` only those that are kept for measuring.
    """
    labels = labelled_objects()
    for name, file in files_of(folder).items():
        label = labels.get(name)
        if label is None or (held_out and not is_held_out(name)):
            continue
        mesh = load(file, IntakeConfig()).mesh
        part = np.zeros((len(SIDES), CANVAS, CANVAS), np.uint8)
        seen = look_at(mesh)
        sides = LabelledSides(seen.color, seen.depth, part, _on_canvas(label.parts, mesh))
        yield RealObject(name, label, mesh, sides)


def _on_canvas(parts: Sequence[LabelledPart], mesh: Mesh) -> FloatArray:
    """Return the table of what a person saw."""
    sizes = mesh.extents / mesh.extents.max() * LONGEST
    table = np.zeros((len(parts), COLUMNS))
    for number, part in enumerate(parts):
        box = on_canvas(np.array(part.box), np.abs(part.side.frame[:2] @ sizes))
        sort = SORTS.index(part.sort)
        view = SIDES.index(part.side)
        table[number] = [view, *box, 0, sort, part.way, 0, part.unsure]
    return table
