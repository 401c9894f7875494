"""Refrigerators, freezers and wine coolers."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ..kit.assembly import BACK, FRONT, Assembly, PartDraft
from ..kit.boards import tray
from ..kit.casework import Case, Style, furniture, swung
from ..kit.layouts import Cell, Node, column, row
from ..kit.looks import BLACK, GLASS, RED, STEEL, WHITE
from ..kit.pulls import any_pull
from ..kit.shapes import Span, about, between, box, mid, size, span, within
from ..kit.styles import any_color, any_metal, any_style, convex_style

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
    if width > WIDE:
        low = a.weighted({"drawer": 0.6, column((1.0, "drawer"), (0.8, "drawer")): 0.4})
        beside = row((a.draw(0.38, 0.5), "door"), (0.55, "door"))
        french = column((small, low), (1.0 - small, "double"))
        return a.weighted(
            {beside: 0.35, french: 0.4, column((0.45, "double"), (0.55, "double")): 0.25}
        )
    over, under = (
        column((1.0 - small, "door"), (small, "door")),
        column((small, "door"), (1.0 - small, "door")),
    )
    return a.weighted(
        {over: 0.35, under: 0.3, column((0.3, "drawer"), (0.7, "door")): 0.15, "door": 0.2}
    )


def _style(a: Assembly, glazed: bool) -> Style:
    skin = any_color(a)
    panel = "glazed" if glazed else a.weighted({"slab": 0.6, "bevel": 0.25, "bowed": 0.15})
    pull = any_pull(a, any_metal(a), ("bar", "rail", "bow", "recess", "none"))
    return replace(
        any_style(a, {panel: 1.0}, 0.0, 1.0 if glazed else 0.7, (0.3, 0.5, 0.7)),
        board=a.draw(0.025, 0.06),
        front=a.draw(0.03, 0.08),
        gap=a.draw(0.002, 0.008),
        rail=a.draw(0.05, 0.09),
        pull=replace(pull, length=a.draw(0.15, 0.9)),
        body=skin,
        face=skin if a.happens(0.7) else any_color(a),
        inside=WHITE,
        reveal=0.0,
        shelves=0,
        bare=False,
    )


def cold_box(kind: str, a: Assembly) -> None:
    """A refrigerator that is ``tall``, ``mini`` or ``wine``."""
    sizes = a.draws(*SIZES[kind])
    style = _style(a, kind == "wine")
    node = "door" if kind == "wine" else _front(a, *sizes[::2])
    base = a.pick(0.0, 0.02, 0.05, 0.1)
    case = furniture(a, style, sizes, node, a.pick("plinth", "feet"), base, BLACK)
    stocked = style.hollow and a.happens(0.45)
    # What comes out past a door needs it wide open, on the outer side of its hinge.
    hung_outside = all(_hung_outside(door, cell) for door, cell in case.doors)
    if style.hollow:
        for door, cell in case.doors:
            levels = _shelves(a, case, cell)
            if stocked and hung_outside and levels and size(cell.inner[0]) > 0.25:
                _inner(a, case, cell, levels)
            if kind != "wine" and a.happens(0.8):
                _bins(a, style, door, cell)
    if any(part.name.startswith("inner") for part in a.parts):
        for door, _ in case.doors:
            door.upper = a.degrees(155, 171)
    if kind == "tall" and style.panel != "bowed" and case.doors and a.happens(0.3):
        _on_door(a, case, *case.doors[0])


def _hung_outside(door: PartDraft, cell: Cell) -> bool:
    """Whether the door's hinge lies at an outer edge of the case."""
    return cell.outer[0 if door.axis[2] < 0.0 else 1]


def _shelves(a: Assembly, case: Case, cell: Cell) -> list[float]:
    """Panes of glass in a cell; their heights [m]."""
    x, z = cell.inner
    levels = between(z, int(size(z) / a.draw(0.18, 0.35)))
    deep = (case.y[0] + 0.13, case.y[1] - 0.008)
    a.root.add(*(box(x, deep, span(v, 0.006)) for v in levels), look=GLASS)
    return levels


def _inner(a: Assembly, case: Case, cell: Cell, levels: list[float]) -> None:
    """A crisper at the bottom of a door's room, or an ice box at its top."""
    number = sum(part.name.startswith("inner") for part in a.parts)
    if number > 2:
        return
    x, z = cell.inner
    name, y = f"inner_{number}", (case.y[0] + 0.13, case.y[1] - 0.008)
    if a.happens(0.7):
        tub_x, tub_z = within(x, 0.006), (z[0] + 0.004, min(levels[0] - 0.004, z[0] + 0.22))
        at = (mid(x), y[0], mid(tub_z))
        crisper = a.slider(name, FRONT, at, round(0.7 * size(y), 3), look=WHITE)
        grip = box(about(0.05, mid(x)), span(y[0], -0.012), span(tub_z[1], -0.02))
        crisper.add(*tray(tub_x, y, tub_z, 0.004), grip)
        return
    flap_x, flap_z = within(x, 0.004), (levels[-1] + 0.008, z[1] - 0.004)
    ice = swung(a, name, "top", flap_x, flap_z, y[0] - 0.02, np.radians(88), look=WHITE)
    ice.add(box(flap_x, (y[0] - 0.02, y[0] - 0.004), flap_z))


def _bins(a: Assembly, style: Style, door: PartDraft, cell: Cell) -> None:
    """A lining and bins on the inner side of a door, which pass the walls on their way out."""
    depth, (x, z) = a.draw(0.05, 0.1), cell.inner
    left, pin = door.axis[2] < 0.0, float(door.origin[0])
    back = float(door.forms[0][0].vertices[:, 1].max())
    reach = back - float(door.origin[1]) + depth
    run = (x[1] - pin if left else pin - x[0]) - 0.004
    if run <= reach + 0.1:
        return
    far = float(np.sqrt(run**2 - reach**2)) - 0.002
    bin_x = (x[0] + 0.015, pin + far) if left else (pin - far, x[1] - 0.015)
    if a.happens(0.5):
        door.add(box(bin_x, span(back, 0.35 * depth), within(z, 0.01)), look=WHITE)
    for level in np.arange(z[0] + 0.03, z[1] - 0.14, a.draw(0.2, 0.34)).tolist():
        rim = box(bin_x, span(back + depth, -0.005), span(level + 0.005, 0.065))
        door.add(box(bin_x, span(back, depth), span(level, 0.005)), rim, look=WHITE)


def _on_door(a: Assembly, case: Case, door: PartDraft, cell: Cell) -> None:
    """A water dispenser's paddle, or a smaller door on a door."""
    x, middle = within(cell.x, 0.1), mid(cell.z)
    if size(cell.x) < 0.3 or size(cell.z) < 0.6:
        return
    face = case.face
    if a.happens(0.5):
        at = (mid(x), face, middle)
        paddle = a.slider("paddle", BACK, at, 0.005, on=door, look=BLACK)
        paddle.add(box(about(0.03, at[0]), (face - 0.014, face - 0.006), span(middle, 0.08)))
        return
    z, y = (middle - 0.05, cell.z[1] - 0.1), (face - 0.016, face - 0.002)
    flap = swung(a, "door_in_door", "bottom", x, z, y[0], np.radians(80), on=door, look=STEEL)
    flap.add(box(x, y, z))


def fridge(a: Assembly) -> None:
    """Two doors, freezer above or below; shelves inside and bins in the doors."""
    skin, metal = a.picks((WHITE, STEEL, RED), (STEEL, BLACK))
    style = convex_style(a, skin, board=0.04, front=0.055, panel="slab", upper="slab", shelves=0)
    pull = replace(style.pull, kind=a.pick("rail", "bar"), length=0.4, look=metal)
    style = replace(style, pull=pull, inside=WHITE, pull_at=0.5)
    share = a.draw(0.28, 0.36)
    low = share if a.happens(0.5) else 1.0 - share
    node = column((low, "door:lower_door"), (1.0 - low, "door:upper_door"))
    sizes = a.draws((0.56, 0.72), (0.5, 0.58), (1.35, 1.75))
    case = furniture(a, style, sizes, node, "feet", 0.03, BLACK)
    for door, cell in case.doors:
        _shelves(a, case, cell)
        _bins(a, style, door, cell)


MAKERS = {
    "refrigerator": partial(cold_box, "tall"),
    "mini_fridge": partial(cold_box, "mini"),
    "wine_cooler": partial(cold_box, "wine"),
    "fridge": fridge,
}
