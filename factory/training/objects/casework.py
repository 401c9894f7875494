"""Cases with doors, drawers and shelves: what kitchens, wardrobes and sideboards have in common."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...mesh import Material
from .grips import Grip, gripped
from .hinges import swing
from .layouts import Cell, Node, divided
from .limbs import Limb, sliding, swinging
from .panels import panel
from .pieces import Block, Piece, rod
from .solids import Span


@dataclass(frozen=True)
class Style:
    """What all fronts of one case share.

    Attributes:
        board: thickness of the case's boards [m].
        front: thickness of doors and drawer fronts [m].
        gap: between fronts that lie beside each other [m].
        behind: between a front and what it covers [m].
        reveal: how much of the case's edge an overlaid front leaves bare [m].
        inset: fronts lie in their openings instead of covering the case's edges.
        recess: how far inset fronts lie behind the case's edges [m].
        hollow: the case has an inside; otherwise it is as deep as its fronts, as generated meshes
            are.
        bare: stacked drawers have no boards between them.
        panel: style of the doors.
        upper: style of the doors in the upper half of the case.
        drawer: style of the drawer fronts.
        rail: width of frames [m].
        grip: worn by all of them.
        grip_at: height of the grips of doors as a share of their height.
        drawer_grip_at: the same of drawers.
        pairs: wide drawers have two grips.
        taste: place of hinge axes in thicknesses behind the face.
        slide: how far drawers come out, in depths.
        solid: drawers are blocks instead of boxes.
        shelves: at most so many per cell.
        covered: something stands out above the fronts, so that flaps stop early.
        crowded: other fronts lie to the left and the right of the case.
        body, face, glass, inside: looks.
    """

    board: float
    front: float
    gap: float
    behind: float
    reveal: float
    inset: bool
    recess: float
    hollow: bool
    bare: bool
    panel: str
    upper: str
    drawer: str
    rail: float
    grip: Grip
    grip_at: float
    drawer_grip_at: float
    pairs: bool
    taste: float
    slide: float
    solid: bool
    shelves: int
    covered: bool
    crowded: bool
    body: Material
    face: Material
    glass: Material
    inside: Material


@dataclass(frozen=True)
class _Front:
    """A cell's front panel and the room that it has: left, right, bottom, top [m]."""

    x: Span
    z: Span
    rooms: tuple[float, ...]


def casework(
    rng: np.random.Generator, style: Style, x: Span, y: Span, z: Span, node: Node, prefix: str = ""
) -> tuple[list[Piece], list[Limb]]:
    """The boards of a case and all that moves in it.

    Args:
        rng: draws what the style leaves open.
        style: of all fronts.
        x: outer span of the case [m].
        y: outer span of the case, without fronts that lie on it [m].
        z: outer span of the case [m].
        node: how its front is divided.
        prefix: of the names of its parts.
    """
    cells, dividers = divided(node, x, z, style.board, style.bare)
    start = _inside_from(style, y[0])
    body: list[Piece] = []
    whole = not style.hollow and all(cell.kind != "open" for cell in cells)
    if whole:
        body.append(Block(x, (start, y[1]), z, style.body))
        if style.inset:
            body += _rim(style, x, (y[0], start), z)
    else:
        body += _shell(style, x, y, z)
    half = style.board / 2
    edge = y[0] if style.inset else y[0] + 0.0005
    for d in dividers:
        if not whole or style.inset:
            deep = (edge, y[1] - 0.004)
            at = (d.at - half, d.at + half)
            span = (d.span[0] + half, d.span[1] - half)
            body.append(
                Block(at, deep, span, style.body)
                if d.upright
                else Block(span, deep, at, style.body)
            )
    limbs: list[Limb] = []
    for cell in cells:
        if not (whole or style.hollow or cell.kind == "open"):
            body.append(Block(cell.inner[0], (start, y[1]), cell.inner[1], style.body))
        high = sum(cell.z) > sum(z) and style.upper != style.panel
        _fill(
            rng, replace(style, panel=style.upper) if high else style, cell, y, body, limbs, prefix
        )
    return body, limbs


def _inside_from(style: Style, edge: float) -> float:
    """Where the room behind the fronts begins [m]."""
    return edge + style.recess + style.front + style.behind if style.inset else edge


def _shell(style: Style, x: Span, y: Span, z: Span) -> list[Piece]:
    back = Block(
        (x[0] + style.board, x[1] - style.board), (y[1] - 0.006, y[1]), (z[0] + style.board, z[1] - style.board),
        style.inside,
    )  # fmt: skip
    return [*_rim(style, x, y, z), back]


def _rim(style: Style, x: Span, y: Span, z: Span) -> list[Piece]:
    b, m = style.board, style.body
    inner = (x[0] + b, x[1] - b)
    return [
        Block((x[0], inner[0]), y, z, m),
        Block((inner[1], x[1]), y, z, m),
        Block(inner, y, (z[0], z[0] + b), m),
        Block(inner, y, (z[1] - b, z[1]), m),
    ]


def _front_of(style: Style, cell: Cell) -> _Front:
    free = {True: float("inf"), False: style.gap}
    if style.inset:
        x, z = cell.inner
        g = style.gap
        return _Front((x[0] + g, x[1] - g), (z[0] + g, z[1] - g), (g,) * 4)
    margin = [style.reveal if outer else style.gap / 2 for outer in cell.outer]
    if style.crowded:
        margin[:2] = [max(edge, style.gap / 2) for edge in margin[:2]]
    x = (cell.x[0] + margin[0], cell.x[1] - margin[1])
    z = (cell.z[0] + margin[2], cell.z[1] - margin[3])
    rooms = [free[outer] for outer in cell.outer]
    if style.covered and cell.outer[3]:
        rooms[3] = style.reveal
    if style.crowded:
        rooms[:2] = [min(room, style.gap) for room in rooms[:2]]
    return _Front(x, z, tuple(rooms))


def _fill(
    rng: np.random.Generator,
    style: Style,
    cell: Cell,
    y: Span,
    body: list[Piece],
    limbs: list[Limb],
    prefix: str,
) -> None:
    """Adds a cell's boards to ``body`` and its parts to ``limbs``."""
    front = _front_of(style, cell)
    face = y[0] + style.recess if style.inset else y[0] - style.behind - style.front
    count = sum(limb.parent == "body" for limb in limbs)
    kind = cell.kind
    inside = (_inside_from(style, y[0]) + 0.002, y[1] - 0.008)
    if kind in ("drawer", "pullout"):
        limbs.append(_drawer(rng, style, cell, front, face, inside, f"{prefix}drawer_{count}"))
        return
    if kind == "fixed":
        body += panel(
            style.drawer,
            front.x,
            (face, face + style.front),
            front.z,
            (style.face, style.glass),
            style.rail,
        )
        return
    if kind == "sliding" and not style.hollow:
        kind = "double"
    if style.hollow or kind == "open":
        body += _furnish(
            rng, style, cell, (inside[0] + (0.05 if kind == "sliding" else 0.0), inside[1]), kind
        )
    if kind == "door":
        side = "left" if rng.random() < 0.5 else "right"
        if cell.outer[0] != cell.outer[1] and rng.random() < 0.75:
            side = "left" if cell.outer[0] else "right"
        limbs.append(_door(rng, style, front, face, side, f"{prefix}door_{count}"))
    elif kind == "double":
        middle = (front.x[0] + front.x[1]) / 2 + float(
            rng.choice([0.0, 0.0, rng.uniform(-0.1, 0.1)])
        ) * (front.x[1] - front.x[0])
        g = style.gap / 2
        rooms = front.rooms
        pair = (
            ("left", _Front((front.x[0], middle - g), front.z, (rooms[0], style.gap, *rooms[2:]))),
            ("right", _Front((middle + g, front.x[1]), front.z, (style.gap, rooms[1], *rooms[2:]))),
        )
        for i, (side, half) in enumerate(pair):
            limbs.append(_door(rng, style, half, face, side, f"{prefix}door_{count + i}"))
    elif kind in ("lift", "flap"):
        side = "top" if kind == "lift" else "bottom"
        limbs.append(_door(rng, style, front, face, side, f"{prefix}flap_{count}"))
    elif kind == "sliding":
        limbs += _sliders(rng, style, cell, y, f"{prefix}slider_{count}")


def _door(
    rng: np.random.Generator, style: Style, front: _Front, face: float, side: str, name: str
) -> Limb:
    x, z = front.x, front.z
    upright = side in ("left", "right")
    width = x[1] - x[0] if upright else z[1] - z[0]
    near = {"left": 0, "right": 1, "bottom": 2, "top": 3}[side]
    rooms = (front.rooms[near], front.rooms[near ^ 1])
    furthest = 170.0 if np.isinf(rooms[0]) else 92.0
    if (
        style.inset
        or (style.covered and not upright)
        or (style.taste > 0.5 and (style.reveal > 0.0 or side == "bottom"))
    ):
        furthest = 90.0
    turn = swing(rng, style.front, width, rooms, style.taste, furthest)
    if side == "left":
        x = (x[0], x[1] - turn.trim)
    elif side == "right":
        x = (x[0] + turn.trim, x[1])
    elif side == "bottom":
        z = (z[0], z[1] - turn.trim)
    else:
        z = (z[0] + turn.trim, z[1])
    pieces = panel(
        style.panel, x, (face, face + style.front), z, (style.face, style.glass), style.rail
    )
    margin = min(max(0.5 * style.rail, 0.02), 0.4 * width)
    if upright:
        at_x = x[1] - margin if side == "left" else x[0] + margin
        tall = z[1] - z[0]
        reach = (
            0.55 * min(style.grip.length, 0.8 * tall)
            if style.grip.kind not in ("knob", "ball")
            else 0.02
        )
        at_z = float(np.clip(z[0] + style.grip_at * tall, z[0] + reach, z[1] - reach))
        pieces += gripped(style.grip, at_x, at_z, face, True, 0.8 * tall)
    else:
        at_z = z[1] - margin if side == "bottom" else z[0] + margin
        pieces += gripped(style.grip, (x[0] + x[1]) / 2, at_z, face, False, 0.8 * (x[1] - x[0]))
    return swinging(name, pieces, x, z, face + turn.setback, side, turn.upper)


def _drawer(
    rng: np.random.Generator,
    style: Style,
    cell: Cell,
    front: _Front,
    face: float,
    inside: Span,
    name: str,
) -> Limb:
    x, z = front.x, front.z
    pieces = panel(
        style.drawer, x, (face, face + style.front), z, (style.face, style.glass), style.rail
    )
    pieces += _drawer_grips(style, front, face)
    depth = inside[1] - inside[0]
    reach = depth * float(rng.uniform(0.75, 0.97))
    if style.hollow and cell.inner[1][1] - cell.inner[1][0] > 0.03:
        pieces += _drawer_box(rng, style, cell, (face + style.front, inside[0] + reach))
    origin = ((x[0] + x[1]) / 2, face, (z[0] + z[1]) / 2)
    return sliding(name, pieces, (0.0, -1.0, 0.0), origin, round(style.slide * reach, 3))


def _drawer_grips(style: Style, front: _Front, face: float) -> list[Piece]:
    x, z = front.x, front.z
    low, high = z[0] + 0.02, z[1] - 0.02
    at_z = (
        (z[0] + z[1]) / 2
        if low > high
        else min(max(z[0] + style.drawer_grip_at * (z[1] - z[0]), low), high)
    )
    if style.grip.kind == "lip":
        at_z = z[1] - 0.013
    width = x[1] - x[0]
    if z[1] - z[0] < 0.045:
        return []
    places = (0.25, 0.75) if style.pairs and width > 0.5 else (0.5,)
    return [
        piece
        for share in places
        for piece in gripped(
            style.grip, x[0] + share * width, at_z, face, False, width / len(places)
        )
    ]


def _drawer_box(rng: np.random.Generator, style: Style, cell: Cell, y: Span) -> list[Piece]:
    """Bottom, sides and back behind a drawer's front, or a block."""
    inner_x, inner_z = cell.inner
    side, m = float(rng.choice([0.002, 0.006, 0.0125])), style.inside
    if inner_x[1] - inner_x[0] < 0.1:
        side = 0.002
    x = (inner_x[0] + side, inner_x[1] - side)
    low = inner_z[0] + 0.004
    share = float(rng.uniform(0.3, 0.55) if cell.kind == "pullout" else rng.uniform(0.55, 0.9))
    z = (low, low + share * (inner_z[1] - low))
    if style.solid:
        return [Block(x, y, z, m)]
    t = min(float(rng.choice([0.006, 0.01, 0.014])), 0.2 * (z[1] - z[0]))
    tray = (x[0] + t, x[1] - t)
    pieces: list[Piece] = [
        Block((x[0], tray[0]), y, z, m),
        Block((tray[1], x[1]), y, z, m),
        Block(tray, (y[1] - t, y[1]), z, m),
        Block(tray, (y[0], y[1] - t), (z[0], z[0] + t), m),
    ]
    if cell.kind == "pullout":
        top = inner_z[1] - 0.01
        pieces += [Block(x, (y[1] - t, y[1]), (z[1], top), m)]
        pieces += [Block(x, y, (v, v + t), m) for v in np.linspace(z[1], top, 4)[1:-1]]
    return pieces


def _furnish(rng: np.random.Generator, style: Style, cell: Cell, y: Span, kind: str) -> list[Piece]:
    """Shelves, a partition or a clothes rod in a cell."""
    (x, z), b = cell.inner, style.board
    height = z[1] - z[0]
    if style.shelves and height > 0.9 and rng.random() < 0.3:
        at = z[1] - 0.12
        pieces: list[Piece] = [rod(0, ((y[0] + y[1]) / 2, at), 0.012, x, style.inside, 10)]
        return (
            pieces
            if rng.random() < 0.5
            else [*pieces, Block(x, y, (z[0] + 0.25, z[0] + 0.25 + b), style.inside)]
        )
    most = min(style.shelves, int(height / 0.12))
    count = int(rng.integers(0, most + 1)) if kind != "open" else most
    setback = float(rng.choice([0.0, 0.01, 0.04])) * float(kind != "open") + 0.002
    levels = np.linspace(z[0], z[1], count + 2)[1:-1]
    pieces = [
        Block(x, (y[0] + setback, y[1]), (v - b / 2, v + b / 2), style.inside) for v in levels
    ]
    if most and x[1] - x[0] > 0.6 and rng.random() < 0.3:
        middle = (x[0] + x[1]) / 2
        pieces.append(
            Block((middle - b / 2, middle + b / 2), (y[0] + setback, y[1]), z, style.inside)
        )
    return pieces


def _sliders(rng: np.random.Generator, style: Style, cell: Cell, y: Span, name: str) -> list[Limb]:
    """Two panels on two tracks that cover an opening together."""
    (x, z), t = cell.inner, min(style.front, 0.018)
    clear = 0.002
    level = (z[0] + 0.001, z[1] - 0.001)
    middle, lap = (x[0] + x[1]) / 2, float(rng.uniform(0.005, 0.04))
    limbs = []
    for i, (span, sign) in enumerate(
        (((x[0] + 0.001, middle + lap), 1.0), ((middle - lap, x[1] - 0.001), -1.0))
    ):
        face = y[0] + 0.006 + i * (t + clear)
        style_name = (
            style.panel
            if style.panel in ("slab", "glazed", "mullion", "planks", "shaker")
            else "slab"
        )
        pieces = panel(
            style_name,
            span,
            (face, face + t),
            level,
            (style.face, style.glass),
            min(style.rail, 0.05),
        )
        at = span[0] + 0.04 if i == 0 else span[1] - 0.04
        if style.grip.kind in ("recess", "bar", "rail", "knob") and i == 0:
            pieces += gripped(style.grip, at, (z[0] + z[1]) / 2, face, True, 0.5 * (z[1] - z[0]))
        width = span[1] - span[0]
        travel = round((x[1] - x[0] - 0.002 - width) * float(rng.uniform(0.85, 1.0)), 3)
        origin = ((span[0] + span[1]) / 2, face, (z[0] + z[1]) / 2)
        limbs.append(sliding(f"{name}_{i}", pieces, (sign, 0.0, 0.0), origin, travel))
    return limbs
