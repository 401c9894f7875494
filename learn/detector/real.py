"""Real meshes with their openings labelled by eye, as the detector sees them."""

from __future__ import annotations

import csv
import zlib
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

from .labelled import LabelledObject, LabelledPart, labelled_objects
from .sides import COLUMNS, LabelledSides

#: Of the meshes of a folder every so many is kept for measuring.
HELD_OUT = 5


@dataclass(frozen=True, eq=False)
class RealObject:
    """One labelled mesh, z up, and its sides."""

    name: str
    label: LabelledObject
    mesh: Mesh
    sides: LabelledSides


def is_held_out(name: str) -> bool:
    """Tell whether the mesh of a name is kept for measuring."""
    return zlib.crc32(name.encode()) % HELD_OUT == 0


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


def files_of(folder: Path) -> dict[str, Path]:
    """Return the meshes that the ``INVENTORY.csv`` of a folder lists, by name."""
    with (folder / "INVENTORY.csv").open(newline="") as rows:
        files = [folder / row["file"] for row in csv.DictReader(rows)]
    return {file.stem: file for file in files}


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
