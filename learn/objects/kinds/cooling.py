"""Refrigerators, freezers and wine coolers."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ..kit.assembly import BACK, FRONT, Assembly
from ..kit.boards import tray
from ..kit.casework import Casework, Leaf, furniture, swung
from ..kit.layouts import Cell, Node, column, row
from ..kit.looks import BLACK, GLASS, RED, STEEL, WHITE
from ..kit.pulls import any_pull
from ..kit.shapes import box
from ..kit.spans import Span, about, between, mid, size, span, within
from ..kit.styles import Style, any_color, any_metal, any_style, convex_style

#: Wider than this, a door of a fridge is two.
WIDE = 0.75
SIZES: dict[str, tuple[Span, Span, Span]] = {
    "tall": ((0.5, 1.1), (0.55, 0.75), (1.2, 1.95)),
    "mini": ((0.4, 0.65), (0.4, 0.62), (0.45, 0.95)),
    "wine": ((0.3, 0.65), (0.45, 0.65), (0.5, 1.8)),
}


def _front(a: Assembly, width: float, height: float) -> Node:
    if height < 1.0:
        return "door" if width < WIDE else "double"
    small = a.draw(0.26, 0.4)
    over = column((1.0 - small, "door"), (small, "door"))
    under = column((small, "door"), (1.0 - small, "door"))
    drawer = column((0.3, "drawer"), (0.7, "door"))
    if width < WIDE:
        return a.weighted({over: 0.35, under: 0.3, drawer: 0.15, "door": 0.2})
    low = a.weighted({"drawer": 0.6, column((1.0, "drawer"), (0.8, "drawer")): 0.4})
    beside = row((a.draw(0.38, 0.5), "door"), (0.55, "door"))
    french = column((small, low), (1.0 - small, "double"))
    four = column((0.45, "double"), (0.55, "double"))
    return a.weighted({beside: 0.35, french: 0.4, four: 0.25})


def _style(a: Assembly, glazed: bool) -> Style:
    skin = any_color(a)
    panel = "glazed" if glazed else a.weighted({"slab": 0.6, "bevel": 0.25, "bowed": 0.15})
    pull = any_pull(a, any_metal(a), ("bar", "rail", "bow", "recess", "none"))
    style = any_style(a, {panel: 1.0}, 0.0, 1.0 if glazed else 0.7, (0.3, 0.5, 0.7))
    board, front, gap, rail, length = a.draws(
        (0.025, 0.06), (0.03, 0.08), (0.002, 0.008), (0.05, 0.09), (0.15, 0.9)
    )
    face = skin if a.happens(0.7) else any_color(a)
    style = replace(style, board=board, front=front, gap=gap, rail=rail, body=skin, face=face)
    style = replace(style, pull=replace(pull, length=length), inside=WHITE, bare=False)
    return replace(style, reveal=0.0, shelves=0)


def cold_box(kind: str, a: Assembly) -> None:
    """Build a refrigerator that is ``tall``, ``mini`` or ``wine``."""
    sizes = a.draws(*SIZES[kind])
    style = _style(a, kind == "wine")
    node = "door" if kind == "wine" else _front(a, sizes[0], sizes[2])
    base = a.pick(0.0, 0.02, 0.05, 0.1)
    case = furniture(a, style, sizes, node, a.pick("plinth", "feet"), base, BLACK)
    # What comes out past a door needs it wide open, on the outer side of its hinge.
    outside = all(door.cell.outer[("left", "right").index(door.side)] for door in case.doors)
    stocked = outside and a.happens(0.45)
    if style.hollow:
        for door in case.doors:
            levels = _shelves(a, case, door.cell)
            if stocked and levels and size(door.cell.inner[0]) > 0.25:
                _inner(a, case, door.cell, levels)
            if kind != "wine" and a.happens(0.8):
                _bins(a, door)
    if any(part.name.startswith("inner") for part in a.parts):
        for door in case.doors:
            door.part.upper = a.degrees(155, 171)
    if kind == "tall" and style.panel != "bowed" and case.doors and a.happens(0.3):
        _on_door(a, case.face, case.doors[0])


def _shelves(a: Assembly, case: Casework, cell: Cell) -> list[float]:
    """Build panes of glass in a cell; returns their heights [m]."""
    x, z = cell.inner
    levels = between(z, int(size(z) / a.draw(0.18, 0.35)))
    deep = within(case.y, 0.13, 0.008)
    a.root.add(*(box(x, deep, span(v, 0.006)) for v in levels), look=GLASS)
    return levels


def _inner(a: Assembly, case: Casework, cell: Cell, levels: list[float]) -> None:
    """Build a crisper at the bottom of a door's room, or an ice box at its top; three at most."""
    number = sum(part.name.startswith("inner") for part in a.parts)
    if number > 2:
        return
    x, z = cell.inner
    y = within(case.y, 0.13, 0.008)
    if a.happens(0.7):
        high = (z[0] + 0.004, min(levels[0] - 0.004, z[0] + 0.22))
        at = (mid(x), y[0], mid(high))
        crisper = a.slider(f"inner_{number}", FRONT, at, round(0.7 * size(y), 3), look=WHITE)
        grip = box(about(0.05, mid(x)), span(y[0], -0.012), span(high[1], -0.02))
        crisper.add(*tray(within(x, 0.006), y, high, 0.004), grip)
        return
    x = within(x, 0.004)
    z = (levels[-1] + 0.008, z[1] - 0.004)
    front = y[0] - 0.02
    ice = swung(a, f"inner_{number}", "top", x, z, front, np.radians(88), look=WHITE)
    ice.add(box(x, span(front, 0.016), z))


def _bins(a: Assembly, door: Leaf) -> None:
    """Build a lining and bins on a door's inner side, which pass the walls on the way out."""
    part = door.part
    depth = a.draw(0.05, 0.1)
    x, z = door.cell.inner
    left = door.side == "left"
    pin = door.x[0 if left else 1]
    back = float(part.forms[0][0].vertices[:, 1].max())
    reach = back - float(part.origin[1]) + depth
    run = (x[1] - pin if left else pin - x[0]) - 0.004
    if run <= reach + 0.1:
        return
    far = float(np.sqrt(run**2 - reach**2)) - 0.002
    x = (x[0] + 0.015, pin + far) if left else (pin - far, x[1] - 0.015)
    if a.happens(0.5):
        part.add(box(x, span(back, 0.35 * depth), within(z, 0.01)), look=WHITE)
    for level in np.arange(z[0] + 0.03, z[1] - 0.14, a.draw(0.2, 0.34)).tolist():
        rim = box(x, span(back + depth, -0.005), span(level + 0.005, 0.065))
        part.add(box(x, span(back, depth), span(level, 0.005)), rim, look=WHITE)


def _on_door(a: Assembly, face: float, door: Leaf) -> None:
    """Build a water dispenser's paddle, or a smaller door on a door."""
    x = within(door.x, 0.1)
    z = (mid(door.z) - 0.05, door.z[1] - 0.1)
    if size(x) < 0.1 or size(z) < 0.25:
        return
    if a.happens(0.5):
        at = (mid(x), face, mid(door.z))
        paddle = a.slider("paddle", BACK, at, 0.005, on=door.part, look=BLACK)
        paddle.add(box(about(0.03, at[0]), (face - 0.014, face - 0.006), span(at[2], 0.08)))
        return
    y = (face - 0.016, face - 0.002)
    flap = swung(a, "door_in_door", "bottom", x, z, y[0], np.radians(80), on=door.part, look=STEEL)
    flap.add(box(x, y, z))


def fridge(a: Assembly) -> None:
    """Build two doors, freezer above or below; shelves inside and bins in the doors."""
    skin, metal = a.picks((WHITE, STEEL, RED), (STEEL, BLACK))
    style = convex_style(a, skin, board=0.04, front=0.055, panel="slab", upper="slab", shelves=0)
    pull = replace(style.pull, kind=a.pick("rail", "bar"), length=0.4, look=metal)
    style = replace(style, pull=pull, inside=WHITE, pull_at=0.5)
    low = a.pick(a.draw(0.28, 0.36), a.draw(0.64, 0.72))
    node = column((low, "door:lower_door"), (1.0 - low, "door:upper_door"))
    sizes = a.draws((0.56, 0.72), (0.5, 0.58), (1.35, 1.75))
    case = furniture(a, style, sizes, node, "feet", 0.03, BLACK)
    for door in case.doors:
        _shelves(a, case, door.cell)
        _bins(a, door)


PLANNED = {
    "refrigerator": partial(cold_box, "tall"),
    "mini_fridge": partial(cold_box, "mini"),
    "wine_cooler": partial(cold_box, "wine"),
}
