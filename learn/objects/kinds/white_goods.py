"""Refrigerators, freezers and wine coolers; washing machines."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, FRONT, LEFT, Y, Z, facing_front
from ..kit.boards import carcass, ring_of_boards, stand, tray
from ..kit.casework import Casework, Leaf, furniture
from ..kit.controls import ControlPanel
from ..kit.layouts import Cell, Node, column, row
from ..kit.looks import BLACK, GLASS, RED, STEEL, WHITE
from ..kit.pulls import add_pull, any_pull
from ..kit.shapes import Form, box, cylinder, hoop, lathe, ribbon
from ..kit.spans import Flat, Span, about, between, ends, mid, size, span, upto, within
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
    pull = any_pull(a, any_metal(a), "bar", "rail", "bow", "recess", "none")
    style = any_style(a, {panel: 1.0}, 0.0, 1.0 if glazed else 0.7, (0.3, 0.5, 0.7))
    board, front, gap, rail, length = a.draws(
        (0.025, 0.06), (0.03, 0.08), (0.002, 0.008), (0.05, 0.09), (0.15, 0.9)
    )
    face = skin if a.happens(0.7) else any_color(a)
    style = replace(style, board=board, front=front, gap=gap, rail=rail, body=skin, face=face)
    style = replace(style, pull=replace(pull, length=length), inside=WHITE, bare=False)
    return replace(style, reveal=0.0, shelves=0)


def _cold_box(kind: str, a: Assembly) -> None:
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
    ice = a.swung(f"inner_{number}", "top", x, z, front, np.radians(88), look=WHITE)
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
    flap = a.swung("door_in_door", "bottom", x, z, y[0], np.radians(80), on=door.part, look=STEEL)
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
    "refrigerator": partial(_cold_box, "tall"),
    "mini_fridge": partial(_cold_box, "mini"),
    "wine_cooler": partial(_cold_box, "wine"),
}


def front_loader(a: Assembly) -> None:
    """Build a round or square door before a drum; a soap drawer, knobs and buttons above it."""
    width, depth, height, strip = a.draws((0.45, 0.7), (0.4, 0.7), (0.7, 1.0), (0.1, 0.16))
    body = a.body(a.pick(WHITE, WHITE, STEEL, BLACK))
    x, y = upto(width, depth)
    z = span(a.pick(0.0, 0.015, 0.03), height)
    split = z[1] - strip
    radius = min(a.draw(0.26, 0.36) * width, 0.48 * (split - z[0] - 0.09))
    at = (width / 2, a.draw(z[0] + radius + 0.06, split - radius - 0.03))
    stand(a, "feet", x, y, z[0], BLACK)
    if a.happens(0.72):
        body.add(_holed(x, z, at, 0.9 * radius), *carcass(x, (0.02, depth), z, 0.012, 0.012))
        drum = a.hinge("drum", BACK, (at[0], 0.07, at[1]), 6.2) if a.happens(0.3) else body
        _drum(drum, at, 0.95 * radius, (0.07, depth - 0.05))
    else:
        body.add(box(x, y, z))
    _porthole(a, at, radius)
    _controls(a, x, (split, z[1]))


def _holed(x: Span, z: Span, at: Flat, radius: float) -> Form:
    """Return a plate at y = 0 with a round hole."""
    center = np.array(at)
    limits = np.array((x, z))
    corners = np.array([(u, v) for u in x for v in z]) - center
    turn = np.linspace(-np.pi, np.pi, 33)[:-1] + 0.05
    angle = np.sort(np.concatenate([np.arctan2(corners[:, 1], corners[:, 0]), turn]))
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    out = (np.where(way > 0, limits[:, 1], limits[:, 0]) - center) / way
    edge = center + out.min(axis=1)[:, None] * way
    return ribbon(center + radius * way, edge, (0.0, 0.02), Y, looped=True)


def _drum(drum: PartDraft, at: Flat, radius: float, y: Span) -> None:
    forms = [hoop(Y, at, (radius - 0.004, radius), y, 28)]
    forms.append(cylinder(Y, at, radius - 0.002, span(y[1], -0.004), 28))
    for angle in np.arange(3) * 2.0 * np.pi / 3.0:
        rib = (at[0] + 0.85 * radius * np.cos(angle), at[1] + 0.85 * radius * np.sin(angle))
        forms.append(cylinder(Y, rib, 0.08 * radius, within(y, 0.01), 8))
    drum.add(*forms, look=STEEL)


def _porthole(a: Assembly, at: Flat, radius: float) -> None:
    look = a.pick(WHITE, STEEL, BLACK)
    x, z = (about(radius, v) for v in at)
    side = a.weighted({"left": 0.7, "right": 0.3})
    y = span(-a.draw(0.0005, 0.003), -a.draw(0.02, 0.05))
    setback = a.pick(0.0, 0.5, 1.0) * size(y)
    # Behind its face the axis swings the hinge edge into the front beside it.
    upper = a.degrees(80, 90) if setback else a.degrees(85, 164)
    door = a.swung("door", side, x, z, y[0] + setback, upper, look=look)
    if a.happens(0.75):
        rim = a.draw(0.7, 0.88) * radius
        bowl = [(0.55 * radius, y[0] + 0.3 * size(y)), (rim + 0.004, y[0] + 0.6 * size(y))]
        door.add(hoop(Y, at, (rim, radius), y, 32))
        door.add(lathe(bowl, (at[0], 0.0, at[1]), Y, 28), look=GLASS)
    else:
        door.add(box(x, y, z))
        door.add(cylinder(Y, at, 0.7 * radius, span(y[0], -0.002), 28), look=GLASS)
    pull = any_pull(a, any_metal(a), "bar", "bow", "recess", "rail")
    far = at[0] + (0.92 if side == "left" else -0.92) * radius
    pull = replace(pull, length=0.35 * radius)
    add_pull(door, pull, (far, at[1]), facing_front(y[0]), radius, True)


def _controls(a: Assembly, x: Span, z: Span) -> None:
    """Build a soap drawer at one end, a knob and buttons along the rest."""
    level = mid(z)
    place = facing_front(0.0)
    left = a.happens(0.8)
    if a.happens(0.7):
        front = ends(within(x, 0.02), 0.32 * size(x) - 0.02)[0 if left else 1]
        high = about(0.32 * size(z), level)
        drawer = a.slider("drawer", FRONT, (mid(front), 0.0, level), 0.2)
        drawer.add(box(front, (-0.018, -0.001), high), look=a.pick(WHITE, STEEL, BLACK))
        lip = span(high[1] - 0.012, 0.006)
        drawer.add(box(within(front, 0.02), (-0.026, -0.018), lip), look=BLACK)
    places = np.linspace(0.42, 0.92, a.count(3, 8))
    spots = (x[0] + (places if left else 1.0 - places) * size(x)).tolist()
    radius = min(0.3 * size(z), 0.035)
    ControlPanel(a, place, any_metal(a), RED).knob("knob", (spots[0], level), radius)
    if a.happens(0.6):
        half = 0.15 * size(x) / len(spots)
        panel = ControlPanel(a, place, WHITE)
        for i, at in enumerate(spots[2:]):
            panel.button(f"button_{i}", about(half, at), about(half, level))


def top_loader(a: Assembly) -> None:
    """Build a lid that lifts, before a console with knobs."""
    width, depth, height = a.draws((0.45, 0.72), (0.5, 0.7), (0.8, 1.0))
    console, tall = a.draws((0.1, 0.18), (0.08, 0.2))
    x, y = upto(width, depth)
    t = 0.02
    body = a.body(a.pick(WHITE, WHITE, STEEL))
    mouth = (within(x, 0.05), (0.05, depth - console - 0.06))
    body.add(*ring_of_boards((x, y), mouth, span(height, -t)), *tray(x, y, (0.0, height - t), t))
    body.add(box(x, span(depth, -console), span(height, tall)))
    center = (mid(mouth[0]), mid(mouth[1]))
    radius = 0.48 * min(size(mouth[0]), size(mouth[1]))
    deep = (0.3 * height, height - t - 0.01)
    drum = hoop(Z, center, (radius - 0.005, radius), deep, 28)
    body.add(drum, cylinder(Z, center, radius - 0.002, span(deep[0], -0.01), 28), look=STEEL)
    lid_y = within(mouth[1], -0.03, -0.01)
    z = span(height + 0.002, a.draw(0.012, 0.03))
    lid = a.hinge("lid", LEFT, (center[0], lid_y[1], z[1]), a.degrees(70, 88))
    lid.add(box(within(mouth[0], -0.03), lid_y, z), look=a.pick(body.look, GLASS))
    lid.add(box(about(0.06, center[0]), span(lid_y[0], -0.012), span(z[0], 0.01)))
    panel = ControlPanel(a, facing_front(depth - console), STEEL, RED)
    for i, at in enumerate(between((0.15 * width, 0.85 * width), a.count(1, 4))):
        panel.knob(f"knob_{i}", (at, height + 0.65 * tall), 0.025)
