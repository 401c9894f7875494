"""Real meshes with their openings labelled by eye, as the detector sees them."""

from __future__ import annotations

import csv
import json
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.load import load
from asset_factory.factory.mesh import FloatArray, Mesh
from asset_factory.factory.models.detector.canvas import (
    CANVAS,
    LONGEST,
    SIDES,
    SORTS,
    WAYS,
    PanelWay,
    Sort,
    look_at,
)
from asset_factory.factory.views.raster import Side, side_facing

from .labelled import EITHER, Row, labelled_objects
from .sides import Instances, LabelledSides, way_toward

AXES = "xyz"
#: A lid whose box is this wide covers the object from side to side.
WIDE = 0.85
#: Of the meshes of a folder every so many is kept for measuring.
HELD_OUT = 5
WHOLE = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True, eq=False)
class RealObject:
    """One labelled mesh, z up: its kind by its inventory, the number of its front, its sides."""

    name: str
    kind: str
    opens: bool
    front: int
    mesh: Mesh
    sides: LabelledSides


def is_held_out(name: str) -> bool:
    """Tell whether the mesh of a name is kept for measuring."""
    return zlib.crc32(name.encode()) % HELD_OUT == 0


def real_objects(folder: Path, held_out: bool | None = None) -> Iterator[RealObject]:
    """Yield the meshes of a folder with ``INVENTORY.csv``, and ``openings.json``, ``fronts.json``.

    Meshes of which the package has labels of its own need neither of these two. Those that nobody
    could tell of, or that stand open, are left out, and, by ``held_out``, those that are kept for
    measuring, or those that are not.
    """
    labels = _read(folder / "openings.json", {})
    fronts = _read(folder / "fronts.json", {"front": {}, "open_as_given": []})
    open_as_given = {each.split(" ")[0] for each in fronts["open_as_given"]}
    with (folder / "INVENTORY.csv").open(newline="") as rows:
        inventory = list(csv.DictReader(rows))
    for row in inventory:
        name = Path(row["file"]).stem
        if held_out is not None and is_held_out(name) is not held_out:
            continue
        kind = row["kind"]
        if (seen := labelled_objects().get(name)) is not None:
            kind = seen.kind
            opens = seen.opens
            front = seen.front
            rows_of = [each.row() for each in seen.parts]
        else:
            if row["opens"] not in ("yes", "no") or name in open_as_given:
                continue
            found = _front(fronts["front"].get(name, "-y"))
            if found is None:
                continue
            front = found
            opens = row["opens"] == "yes"
            rows_of = _labelled(labels, name, front) if name in labels else []
            if opens and name not in labels:
                rows_of = [(view, WHOLE, Sort.OTHER, EITHER, True) for view in range(len(SIDES))]
        mesh = load(folder / row["file"], IntakeConfig()).mesh
        part = np.zeros((len(SIDES), CANVAS, CANVAS), np.uint8)
        sides = LabelledSides(look_at(mesh), part, _on_canvas(rows_of, mesh))
        yield RealObject(name, kind, opens, SIDES.index(front), mesh, sides)


def _read(path: Path, otherwise: dict[str, Any]) -> dict[str, Any]:
    if not path.exists():
        return otherwise
    found: dict[str, Any] = json.loads(path.read_text())
    return found


def _front(text: str) -> Side | None:
    """Return the side that an axis as ``+x`` is the front of; ``None``: seen from above."""
    if text == "top":
        return None
    direction = np.zeros(3)
    direction[AXES.index(text[-1])] = -1.0 if text.startswith("-") else 1.0
    return side_facing(direction)


def _labelled(labels: Mapping[str, Any], name: str, front: Side) -> list[Row]:
    rows = [row for entry in labels[name] for row in _rows(entry, front)]
    for entry in labels.get(f"{name}:optional", []):
        rows += _ignored(entry, _sides_of(entry["plane"]))
    return rows


def _sides_of(plane: str) -> tuple[Side, ...]:
    return {
        "xz": (Side.FRONT, Side.BACK), "yz": (Side.LEFT, Side.RIGHT), "xy": (Side.TOP,)
    }[plane]  # fmt: skip


def _on(side: Side, entry: Mapping[str, Any]) -> tuple[float, ...]:
    """Return an entry's box in shares of a side's picture."""
    u0, v0, u1, v1 = entry["box"]
    right = side.frame[0]
    if float(right.sum()) < 0.0:
        u0, u1 = 1.0 - u1, 1.0 - u0
    return u0, v0, u1, v1


def _rows(entry: Mapping[str, Any], front: Side) -> list[Row]:
    """Return what an entry means on each side; a panel is on the side where the front is."""
    sides = _sides_of(entry["plane"])
    axis = np.array(entry["axis"] or [0.0, 0.0, 0.0], dtype=np.float64)
    hinges = entry.get("hinge") or []
    normal = np.abs(sides[0].frame[2])
    slides = entry["type"] == "prismatic"
    if not slides and axis[2] == 0.0 and float(axis @ normal) == 0.0:
        across = AXES[int(np.argmax(normal))]
        if Side.TOP in sides or any(across in spot for spot in hinges):
            return _lid_rows(entry, sides, hinges)
    side = side_facing(axis) if slides else front
    if side not in sides or side is Side.TOP or not (slides or hinges):
        return _ignored(entry, sides)
    if slides:
        sort = Sort.DRAWER
        way = WAYS.index(PanelWay.OUT)
    elif abs(float(axis @ normal)) > 0.9:
        sort = Sort.CONTROL
        way = WAYS.index(PanelWay.OTHER)
    elif abs(axis[2]) > 0.9:
        sort = Sort.DOOR
        mirrored = float(side.frame[0].sum()) < 0.0
        edges = (PanelWay.RIGHT, PanelWay.LEFT) if mirrored else (PanelWay.LEFT, PanelWay.RIGHT)
        way = _edge(hinges, AXES[int(np.argmax(np.abs(side.frame[0])))], entry["box"][::2], edges)
    else:
        sort = Sort.FLAP
        way = _edge(hinges, "z", entry["box"][1::2], (PanelWay.BOTTOM, PanelWay.TOP))
    return [(SIDES.index(side), _on(side, entry), sort, way, False)]


def _edge(
    hinges: Sequence[Mapping[str, float]],
    letter: str,
    ends: Sequence[float],
    edges: tuple[PanelWay, PanelWay],
) -> int:
    """Return the number of the edge, of the lower and the higher one along an axis, of a hinge."""
    low = {spot[letter] < sum(ends) / 2.0 for spot in hinges if letter in spot}
    if len(low) != 1:
        return EITHER
    return WAYS.index(edges[0] if low.pop() else edges[1])


def _ignored(entry: Mapping[str, Any], sides: Sequence[Side]) -> list[Row]:
    return [(SIDES.index(each), _on(each, entry), Sort.OTHER, EITHER, True) for each in sides]


def _lid_rows(
    entry: Mapping[str, Any], sides: Sequence[Side], hinges: Sequence[Mapping[str, float]]
) -> list[Row]:
    """Return a lid on all sides on which it must be seen."""
    direction = _hinge_direction(hinges)
    rows: list[Row] = []
    box = entry["box"]
    above = Side.TOP in sides
    wide = box[2] - box[0] >= WIDE
    for view, side in enumerate(SIDES):
        way = EITHER if direction is None else WAYS.index(way_toward(direction, side))
        if side in sides:
            rows.append((view, _on(side, entry), Sort.LID, way, False))
        elif above:
            rows.append((view, WHOLE, Sort.OTHER, EITHER, True))
        elif side is Side.TOP:
            shown = box[0], 0.0, box[2], 1.0
            if sides[0] in (Side.LEFT, Side.RIGHT):
                shown = 0.0, box[0], 1.0, box[2]
            rows.append((view, shown, Sort.LID, way, not wide))
        else:
            rows.append((view, (0.0, box[1], 1.0, box[3]), Sort.LID, way, not wide))
    return rows


def _hinge_direction(hinges: Sequence[Mapping[str, float]]) -> FloatArray | None:
    """Return where the hinge is from the middle, level; ``None`` if that is not one place."""
    found = set()
    for spot in hinges:
        for letter in "xy":
            if letter in spot and abs(spot[letter] - 0.5) > 0.15:
                found.add((letter, spot[letter] > 0.5))
    if len(found) != 1:
        return None
    letter, high = found.pop()
    direction = np.zeros(3)
    direction[AXES.index(letter)] = 1.0 if high else -1.0
    return direction


def _on_canvas(rows: Sequence[Row], mesh: Mesh) -> Instances:
    sizes = mesh.extents / mesh.extents.max() * LONGEST
    table = np.zeros((len(rows), 10))
    for number, (view, box, sort, way, ignored) in enumerate(rows):
        extents = np.abs(SIDES[view].frame[:2] @ sizes)
        shares = np.array(box, dtype=np.float64).reshape(2, 2)
        corners = (CANVAS - extents) / 2.0 + shares * extents
        table[number] = [view, *corners.ravel(), 0, SORTS.index(sort), way, 0, ignored]
    return Instances.of(table)
