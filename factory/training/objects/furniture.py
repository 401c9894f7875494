"""Cabinets and chests, of boards."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import Articulation, JointKind
from ...mesh import Material, Mesh
from .looks import BLACK, BRASS, GREEN, OAK, STEEL, WALNUT, WHITE, pick, wood
from .parts import (
    GAP,
    REVEAL,
    Moving,
    assemble,
    carcass,
    cavity,
    degrees,
    drawer,
    feet,
    front,
    handle,
    millimetres,
    side_door,
    tub,
)
from .solids import Span, box, prism

#: Rows of a column from bottom to top: kind and share of the height.
COLUMNS: dict[str, tuple[tuple[str, float], ...]] = {
    "drawer_over_door": (("door", 0.75), ("drawer", 0.25)),
    "door": (("door", 1.0),),
    "drawers": (("drawer", 0.4), ("drawer", 0.32), ("drawer", 0.28)),
    "door_over_drawer": (("drawer", 0.3), ("door", 0.7)),
}


@dataclass(frozen=True)
class _Style:
    board: float
    panel: float
    front: str
    handle: str
    body: Material
    face: Material
    metal: Material


@dataclass(frozen=True)
class _Cell:
    """One opening: the front covers ``x, z``; behind it lies the free space ``inner_x, inner_z`` up to ``back``."""

    kind: str
    x: Span
    z: Span
    inner_x: Span
    inner_z: Span


def cabinet(rng: np.random.Generator) -> Articulation:
    """One to three columns of doors and drawers on a plinth or feet; the first column has both."""
    style = _cabinet_style(rng)
    columns = int(rng.integers(1, 4))
    width = columns * millimetres(rng, 0.38, 0.5)
    depth, height, base = (
        millimetres(rng, 0.36, 0.56),
        millimetres(rng, 0.62, 0.95),
        millimetres(rng, 0.06, 0.12),
    )
    x, z = (-width / 2, width / 2), (base, base + height)
    y = (-depth / 2 + style.panel + GAP, depth / 2)
    solids = carcass(x, y, z, style.board, style.body)
    solids += feet(x, y, base, 0.05, style.body)
    cells, inner = _cells(rng, columns, x, y, z, style)
    solids += inner
    back = cavity(x, y, z, style.board)[1][1]
    moving: list[Moving] = []
    for cell in cells:
        number = sum(m.name.startswith(cell.kind) for m in moving)
        make = _cabinet_door if cell.kind == "door" else _cabinet_drawer
        moving.append(make(rng, f"{cell.kind}_{number}", cell, (y[0] - GAP, back), style))
        if cell.kind == "door":
            middle = (cell.inner_z[0] + cell.inner_z[1]) / 2
            solids.append(
                box(cell.inner_x, (y[0] + 0.03, back), (middle, middle + style.board), style.body)
            )
    return assemble(solids, moving)


def _cabinet_style(rng: np.random.Generator) -> _Style:
    textured = wood(int(rng.integers(1000)))
    body = pick(rng, textured, WHITE, OAK)
    return _Style(
        board=float(rng.choice([0.016, 0.018])),
        panel=0.022,
        front=str(rng.choice(["slab", "shaker"])),
        handle=str(rng.choice(["bar", "rail", "knob"])),
        body=body,
        face=textured if body is textured else pick(rng, GREEN, WALNUT, WHITE),
        metal=pick(rng, STEEL, BLACK, BRASS),
    )


def _cells(
    rng: np.random.Generator, columns: int, x: Span, y: Span, z: Span, style: _Style
) -> tuple[list[_Cell], list[Mesh]]:
    """The openings, and the boards that part them."""
    inner_x, (_, back), inner_z = cavity(x, y, z, style.board)
    half = style.board / 2
    cuts = np.linspace(x[0], x[1], columns + 1)
    boards = [
        box((c - half, c + half), (y[0] + 0.002, back), inner_z, style.body) for c in cuts[1:-1]
    ]
    cells: list[_Cell] = []
    for column in range(columns):
        name = "drawer_over_door" if column == 0 else str(rng.choice(list(COLUMNS)))
        left, right = float(cuts[column]), float(cuts[column + 1])
        free_x = (max(inner_x[0], left + half), min(inner_x[1], right - half))
        if column == 0:
            free_x = (inner_x[0], free_x[1])
        if column == columns - 1:
            free_x = (free_x[0], inner_x[1])
        levels = z[0] + (z[1] - z[0]) * np.cumsum([0.0, *(share for _, share in COLUMNS[name])])
        levels = np.round(levels, 3)
        for row, (kind, _) in enumerate(COLUMNS[name]):
            low, high = float(levels[row]), float(levels[row + 1])
            free_z = (max(inner_z[0], low + half), min(inner_z[1], high - half))
            cells.append(
                _Cell(
                    kind,
                    (left + GAP / 2, right - GAP / 2),
                    (low + GAP / 2, high - GAP / 2),
                    free_x,
                    free_z,
                )
            )
            if row:
                boards.append(
                    box(free_x, (y[0] + 0.003, back), (low - half, low + half), style.body)
                )
    return cells, boards


def _cabinet_door(
    rng: np.random.Generator, name: str, cell: _Cell, y: Span, style: _Style
) -> Moving:
    face = y[0] - style.panel
    hinge = str(rng.choice(["left", "right"]))
    solids = front(cell.x, (face, y[0]), cell.z, style.front, style.face)
    grip_x = cell.x[1] - 0.03 if hinge == "left" else cell.x[0] + 0.03
    solids += handle(style.handle, grip_x, face, cell.z[1] - 0.13, True, 0.14, style.metal)
    return side_door(name, solids, cell.x, face, cell.z, hinge, degrees(rng, 90, 110))


def _cabinet_drawer(
    rng: np.random.Generator, name: str, cell: _Cell, y: Span, style: _Style
) -> Moving:
    face = y[0] - style.panel
    solids = front(cell.x, (face, y[0]), cell.z, style.front, style.face)
    # A handle stands on the panel inside the raised frame, or on the slab itself.
    stand = face if len(solids) == 1 else face + 0.006
    middle = ((cell.x[0] + cell.x[1]) / 2, (cell.z[0] + cell.z[1]) / 2)
    solids += handle(style.handle, middle[0], stand, middle[1], False, 0.16, style.metal)
    depth = y[1] - y[0] - millimetres(rng, 0.02, 0.05)
    height = 0.75 * (cell.inner_z[1] - cell.inner_z[0])
    box_x = (cell.inner_x[0] + GAP, cell.inner_x[1] - GAP)
    box_z = (cell.inner_z[0] + GAP, round(cell.inner_z[0] + height, 3))
    return drawer(name, solids, box_x, (y[0], y[0] + depth), box_z, style.body)


def chest(rng: np.random.Generator) -> Articulation:
    """A box on feet with a flat or arched lid, hinged at its back top edge."""
    board = float(rng.choice([0.016, 0.018]))
    width, depth = millimetres(rng, 0.6, 1.0), millimetres(rng, 0.38, 0.5)
    base, height = 0.04, millimetres(rng, 0.3, 0.42)
    material, metal = pick(rng, wood(int(rng.integers(1000))), OAK, WALNUT), pick(rng, BRASS, BLACK)
    x, y, z = (-width / 2, width / 2), (-depth / 2, depth / 2), (base, base + height)
    solids = feet(x, y, base, 0.05, material) + tub(x, (y[0] + board, y[1]), z, board, material)
    solids.append(box(x, (y[0], y[0] + board), (z[0] + REVEAL, z[1] - REVEAL), material))
    middle = (z[0] + z[1]) / 2
    for side, sign in ((x[0], -1.0), (x[1], 1.0)):
        reach = sorted((side, side + sign * 0.025))
        solids.append(box((reach[0], reach[1]), (-0.06, 0.06), (middle, middle + 0.02), metal))
    lid = _chest_lid(rng, x, y, z[1] + GAP, board, material)
    bottom, overhang = z[1] + GAP, 0.01
    lid.append(
        box(
            (-0.05, 0.05),
            (y[0] - overhang - 0.022, y[0] - overhang),
            (bottom + 0.003, bottom + 0.013),
            metal,
        )
    )
    opening = Moving(
        "lid",
        tuple(lid),
        JointKind.REVOLUTE,
        (-1.0, 0.0, 0.0),
        (0.0, y[1], bottom),
        degrees(rng, 85, 105),
    )
    return assemble(solids, [opening])


def _chest_lid(
    rng: np.random.Generator, x: Span, y: Span, bottom: float, board: float, material: Material
) -> list[Mesh]:
    lid_x, lid_y = (x[0] - 0.008, x[1] + 0.008), (y[0] - 0.01, y[1])
    if rng.random() < 0.5:
        return [box(lid_x, lid_y, (bottom, bottom + board), material)]
    return _arched_lid(lid_x, lid_y, bottom, board, material)


def _arched_lid(x: Span, y: Span, bottom: float, board: float, material: Material) -> list[Mesh]:
    """Two end plates, and staves along the arch between them."""
    radius, center = (y[1] - y[0]) / 2, (y[0] + y[1]) / 2
    rise = board + 0.35 * radius
    angle = np.linspace(0.0, np.pi, 9)
    arch = np.stack([radius * np.cos(angle), board + 0.35 * radius * np.sin(angle)], axis=1)
    outer = np.vstack([[(radius, 0.0)], arch, [(-radius, 0.0)]])
    inner = outer * [(radius - board) / radius, (rise - board) / rise]
    base = np.array([center, bottom])
    ends = ((x[0], x[0] + board), (x[1] - board, x[1]))
    lid = [prism(0, base + outer, span, material) for span in ends]
    for i in range(len(outer) - 1):
        stave = np.array([outer[i], outer[i + 1], inner[i + 1], inner[i]])
        # A hair's breadth apart from its neighbours, or they would share corners.
        stave = stave.mean(axis=0) + 0.995 * (stave - stave.mean(axis=0))
        lid.append(prism(0, base + stave, (ends[0][1], ends[1][0]), material))
    return lid


MAKERS = {"cabinet": cabinet, "chest": chest}
