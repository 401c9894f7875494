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
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.models.detector.canvas import (
    CANVAS,
    LONGEST,
    SIDES,
    SORTS,
    Sort,
    look_at,
)
from asset_factory.factory.views.raster import Side, side_facing

from .labelled import LabelledObject, LabelledPart, labelled_objects
from .sides import Instances, LabelledSides

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
    with (folder / "INVENTORY.csv").open(newline="") as rows:
        inventory = {Path(row["file"]).stem: row for row in csv.DictReader(rows)}
    labels = labelled_objects()
    if (folder / "openings.json").exists():
        labels = _by_openings(folder, inventory) | labels
    for name, row in inventory.items():
        label = labels.get(name)
        if label is None or (held_out is not None and is_held_out(name) is not held_out):
            continue
        mesh = load(folder / row["file"], IntakeConfig()).mesh
        part = np.zeros((len(SIDES), CANVAS, CANVAS), np.uint8)
        sides = LabelledSides(look_at(mesh), part, _on_canvas(label.parts, mesh))
        front = SIDES.index(label.front)
        yield RealObject(name, label.kind, label.opens, front, mesh, sides)


def _by_openings(
    folder: Path, inventory: Mapping[str, Mapping[str, str]]
) -> dict[str, LabelledObject]:
    """Return what ``openings.json`` says; of what opens and has no entry nothing is known."""
    openings = json.loads((folder / "openings.json").read_text())
    fronts = json.loads((folder / "fronts.json").read_text())
    open_as_given = {each.split(" ")[0] for each in fronts["open_as_given"]}
    found = {}
    for name, row in inventory.items():
        front = _front(fronts["front"].get(name, "-y"))
        if row["opens"] not in ("yes", "no") or name in open_as_given or front is None:
            continue
        opens = row["opens"] == "yes"
        parts: list[LabelledPart] = []
        if name in openings:
            parts = [part for entry in openings[name] for part in _parts(entry, front)]
            for entry in openings.get(f"{name}:optional", []):
                parts += _unsure(entry, _sides_of(entry["plane"]))
        elif opens:
            parts = [LabelledPart(side, Sort.OTHER, WHOLE, unsure=True) for side in SIDES]
        found[name] = LabelledObject(row["kind"], opens, front, tuple(parts))
    return found


def _front(text: str) -> Side | None:
    """Return the side that an axis as ``+x`` is the front of; ``None``: seen from above."""
    if text == "top":
        return None
    direction = np.zeros(3)
    direction[AXES.index(text[-1])] = -1.0 if text.startswith("-") else 1.0
    return side_facing(direction)


def _sides_of(plane: str) -> tuple[Side, ...]:
    return {
        "xz": (Side.FRONT, Side.BACK), "yz": (Side.LEFT, Side.RIGHT), "xy": (Side.TOP,)
    }[plane]  # fmt: skip


def _on(side: Side, box: Sequence[float]) -> tuple[float, float, float, float]:
    """Return an entry's box in shares of a side's picture."""
    u0, v0, u1, v1 = box
    return (1.0 - u1, v0, 1.0 - u0, v1) if _is_mirrored(side) else (u0, v0, u1, v1)


def _is_mirrored(side: Side) -> bool:
    """Tell whether a side shows its axis the other way round."""
    return float(side.frame[0].sum()) < 0.0


def _parts(entry: Mapping[str, Any], front: Side) -> list[LabelledPart]:
    """Return what an entry means on each side; a panel is on the side where the front is."""
    sides = _sides_of(entry["plane"])
    axis = np.array(entry["axis"] or [0.0, 0.0, 0.0], dtype=np.float64)
    hinges = entry.get("hinge") or []
    normal = np.abs(sides[0].frame[2])
    slides = entry["type"] == "prismatic"
    if not slides and axis[2] == 0.0 and float(axis @ normal) == 0.0:
        across = AXES[int(np.argmax(normal))]
        if Side.TOP in sides or any(across in spot for spot in hinges):
            return _lid_parts(entry["box"], sides, _hinge_side(hinges))
    side = side_facing(axis) if slides else front
    if side not in sides or side is Side.TOP or not (slides or hinges):
        return _unsure(entry, sides)
    hinge = None
    if slides:
        sort = Sort.DRAWER
    elif abs(float(axis @ normal)) > 0.9:
        sort = Sort.CONTROL
    elif abs(axis[2]) > 0.9:
        sort = Sort.DOOR
        edges = ("right", "left") if _is_mirrored(side) else ("left", "right")
        letter = AXES[int(np.argmax(np.abs(side.frame[0])))]
        hinge = _edge(hinges, letter, entry["box"][::2], edges)
    else:
        sort = Sort.FLAP
        hinge = _edge(hinges, "z", entry["box"][1::2], ("bottom", "top"))
    return [LabelledPart(side, sort, _on(side, entry["box"]), hinge)]


def _edge(
    hinges: Sequence[Mapping[str, float]], letter: str, ends: Sequence[float], edges: Sequence[str]
) -> str | None:
    """Return the edge of a hinge, of the lower and the higher one along an axis."""
    low = {spot[letter] < sum(ends) / 2.0 for spot in hinges if letter in spot}
    if len(low) != 1:
        return None
    return edges[0] if low.pop() else edges[1]


def _unsure(entry: Mapping[str, Any], sides: Sequence[Side]) -> list[LabelledPart]:
    return [LabelledPart(each, Sort.OTHER, _on(each, entry["box"]), unsure=True) for each in sides]


def _lid_parts(
    box: Sequence[float], sides: Sequence[Side], hinge: str | None
) -> list[LabelledPart]:
    """Return a lid on all sides on which it must be seen."""
    left, low, right, high = box
    wide = right - left >= WIDE
    if Side.TOP in sides:
        others = [LabelledPart(side, Sort.OTHER, WHOLE, unsure=True) for side in SIDES[:-1]]
        return [*others, LabelledPart(Side.TOP, Sort.LID, (left, low, right, high), hinge)]
    found = []
    for side in SIDES:
        shown = (0.0, low, 1.0, high)
        if side in sides:
            shown = _on(side, box)
        elif side is Side.TOP:
            across = sides[0] in (Side.LEFT, Side.RIGHT)
            shown = (0.0, left, 1.0, right) if across else (left, 0.0, right, 1.0)
        unsure = side not in sides and not wide
        found.append(LabelledPart(side, Sort.LID, shown, hinge, unsure))
    return found


def _hinge_side(hinges: Sequence[Mapping[str, float]]) -> str | None:
    """Return the side of the object at which a lid is hinged; ``None`` if that is not one."""
    names = {"x": ("left", "right"), "y": ("front", "back")}
    found = {
        names[letter][spot[letter] > 0.5]
        for spot in hinges
        for letter in names
        if letter in spot and abs(spot[letter] - 0.5) > 0.15
    }
    return found.pop() if len(found) == 1 else None


def _on_canvas(parts: Sequence[LabelledPart], mesh: Mesh) -> Instances:
    sizes = mesh.extents / mesh.extents.max() * LONGEST
    table = np.zeros((len(parts), 10))
    for number, part in enumerate(parts):
        extents = np.abs(part.side.frame[:2] @ sizes)
        shares = np.array(part.box, dtype=np.float64).reshape(2, 2)
        corners = (CANVAS - extents) / 2.0 + shares * extents
        sort = SORTS.index(part.sort)
        view = SIDES.index(part.side)
        table[number] = [view, *corners.ravel(), 0, sort, part.way, 0, part.unsure]
    return Instances.of(table)
