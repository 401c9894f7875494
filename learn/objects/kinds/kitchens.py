"""Ranges, ovens, hobs, hoods, microwaves and dishwashers; and kitchens with some of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly
from ..kit.axes import FRONT, UP, Point, Z, facing_front, facing_up
from ..kit.boards import corners, put_top, rack
from ..kit.casework import Casework, furniture
from ..kit.controls import ControlPanel, cells, key, keypad
from ..kit.layouts import Node, column, drawers, filling, row
from ..kit.looks import BLACK, GLASS, RED, STEEL, WHITE
from ..kit.pulls import any_pull
from ..kit.shapes import box, cylinder, frustum, hoop, lathe
from ..kit.spans import Span, about, between, ends, mid, shares, size, span, upto, within
from ..kit.styles import HIGH, Style, any_color, any_metal, any_style, convex_style


def _style(a: Assembly, panels: Mapping[str, float]) -> Style:
    skin = a.pick(WHITE, STEEL, BLACK, STEEL)
    pull = any_pull(a, any_metal(a), "bar", "rail", "bow", "recess")
    style = any_style(a, panels, 0.0, 0.72, (0.5,))
    board, front, gap, rail, length = a.draws(
        (0.012, 0.03), (0.018, 0.045), (0.0015, 0.006), (0.06, 0.11), (0.25, 0.6)
    )
    face = skin if a.happens(0.7) else a.pick(STEEL, BLACK, WHITE)
    style = replace(style, board=board, front=front, gap=gap, rail=rail, body=skin, face=face)
    style = replace(style, pull=replace(pull, length=length), drawer="slab", drawer_pull_at=0.75)
    return replace(style, reveal=0.0, shelves=0, bare=False)


def _burners(a: Assembly, x: Span, y: Span, z: float) -> None:
    """Build burners on a hob at ``z``: plates, glass marks, or gas under grates."""
    style = a.pick("plate", "mark", "gas")
    columns = shares(x, 2 if size(x) < 0.75 else 3)
    radius = 0.36 * min(size(columns[0]), size(y) / 2)
    for at in [(mid(cx), mid(cy), z) for cx in columns for cy in shares(y, 2)]:
        r = radius * a.draw(0.7, 1.0)
        if style == "plate":
            plate = [(r, 0.0), (r, 0.008), (0.9 * r, 0.01)]
            a.root.add(lathe(plate, at, sides=20), look=BLACK)
        elif style == "mark":
            a.root.add(hoop(Z, at[:2], (0.92 * r, r), span(z, 0.001)), look=STEEL)
        else:
            gas = [(0.4 * r, 0.0), (0.4 * r, 0.015), (0.3 * r, 0.02)]
            a.root.add(lathe(gas, at, sides=16), look=BLACK)
            _grate(a, at, 1.2 * radius)


def _grate(a: Assembly, at: Point, half: float) -> None:
    x, y = (about(half, v) for v in at[:2])
    feet = (box(about(0.005, u), about(0.005, v), span(at[2], 0.026)) for u, v in corners(x, y))
    across = box(x, about(0.005, at[1]), span(at[2] + 0.025, 0.008))
    a.root.add(*rack(x, y, at[2] + 0.025, 1), across, *feet, look=BLACK)


def _racks(a: Assembly, case: Casework, most: int = 3) -> None:
    """Wire shelves behind every door of a case, as part of the body."""
    y = within(case.y, 0.02, 0.03)
    for door in case.doors if case.style.hollow else ():
        x, z = door.cell.inner
        for level in between(z, a.count(1, most)):
            a.root.add(*rack(x, y, level, a.count(5, 13), a.happens(0.5)), look=STEEL)


def _panel_row(a: Assembly, case: Casework, share: float, looks: tuple[Material, Material]) -> None:
    """Build knobs on the fixed panel that is the uppermost ``share`` of a case's front."""
    high = share * size(case.z)
    panel = ControlPanel(a, facing_front(case.face), *looks)
    panel.knob_row(within(case.x, case.style.board), case.z[1] - high / 2, high, case.prefix)


def stove(a: Assembly) -> None:
    """Build a range: oven doors that drop, knobs before or behind the hob, often a drawer below."""
    style = _style(a, {"glazed": 0.6, "slab": 0.3, "bevel": 0.1})
    width, depth, height, share = a.draws((0.5, 1.2), (0.5, 0.7), (0.75, 0.92), (0.1, 0.17))
    console = a.happens(0.4)
    oven = column((1.0, "flap"), *([(0.7, "flap")] if a.happens(0.15) else []))
    if width > 0.85 and a.happens(0.7):
        oven = row((a.draw(0.9, 1.8), "flap"), (1.0, "flap"))
    parts = [(0.78, oven), *([] if console else [(share, "fixed")])]
    if a.happens(0.6):
        parts.insert(0, (a.draw(0.15, 0.28), "drawer" if a.happens(0.8) else "fixed"))
    support = a.pick("plinth", "feet")
    base = a.pick(0.0, 0.03, 0.1)
    case = furniture(a, style, (width, depth, height), column(*parts), support, base, BLACK)
    looks = (any_metal(a), a.pick(RED, WHITE, BLACK))
    top = case.z[1]
    tall = a.draw(0.08, 0.2)
    # Knobs on the console stand out over the hob.
    _burners(a, case.x, within(case.y, 0.0, 0.1 if console else 0.0), top)
    if console or a.happens(0.3):
        a.root.add(box(case.x, span(depth, -0.06), span(top, tall)), look=style.body)
    if console:
        panel = ControlPanel(a, facing_front(depth - 0.06), *looks)
        panel.knob_row(case.x, top + 0.55 * tall, 0.7 * tall)
    else:
        _panel_row(a, case, share / sum(part for part, _ in parts), looks)
    _racks(a, case)


def built_in_oven(a: Assembly) -> None:
    """Build an oven without a hob: one or two doors under a panel with knobs and buttons."""
    style = _style(a, {"glazed": 0.7, "slab": 0.3})
    width, depth, share = a.draws((0.35, 0.76), (0.35, 0.6), (0.14, 0.24))
    height = a.draw(0.28, 0.65) if a.happens(0.7) else a.draw(0.9, 1.3)
    beside = height < 0.45 and a.happens(0.4)
    door: Node = a.weighted({"flap": 0.8, "door": 0.2})
    if height > 0.8:
        door = column((1.0, "flap"), (0.9, "flap"))
    node = column((1.0 - share, door), (share, "fixed"))
    if beside:
        node = row((0.76, door), (0.24, "fixed"))
    case = furniture(a, style, (width, depth, height), node, "feet", 0.015, BLACK)
    metal = any_metal(a)
    if beside:
        panel = ControlPanel(a, facing_front(case.face), metal, RED)
        for i, level in enumerate(between(case.z, a.count(2, 4))):
            panel.knob(f"knob_{i}", (0.88 * width, level), min(0.08 * width, 0.025))
    else:
        _panel_row(a, case, share, (metal, RED))
    _racks(a, case)


def microwave_oven(a: Assembly) -> None:
    """Build a door beside a panel of keys, some of which give way; a plate that turns."""
    *sizes, share = a.draws((0.42, 0.8), (0.3, 0.5), (0.24, 0.45), (0.16, 0.3))
    style = _style(a, {"glazed": 0.6, "slab": 0.4})
    style = replace(style, pull=replace(style.pull, length=0.7 * sizes[2]))
    parts = [(1.0 - share, "door" if a.happens(0.85) else "flap"), (share, "fixed")]
    right = a.happens(0.85)
    node = row(*(parts if right else parts[::-1]))
    case = furniture(a, style, tuple(sizes), node, "feet", 0.012, BLACK)
    y = case.y
    z = case.z
    area = within(ends(case.x, share * sizes[0])[1 if right else 0], 0.012)
    place = facing_front(case.face)
    display = box(area, span(case.face, -0.001), (z[1] - 0.06, z[1] - 0.025))
    a.root.add(display, look=GLASS)
    keypad(a, area, (z[0] + 0.03, z[1] - 0.08), place, still=a.happens(0.5))
    if style.hollow and a.happens(0.7):
        room = case.doors[0].cell.inner[0]
        at = (mid(room), mid(y), z[0] + style.board + 0.004)
        radius = 0.4 * min(size(room), size(y))
        plate = a.hinge("plate", UP, at, 6.2, look=GLASS)
        plate.add(lathe([(0.9 * radius, 0.0), (radius, 0.006)], at))


def hob(a: Assembly) -> None:
    """Build a hob on its own, its knobs before or upon it."""
    width, depth, height = a.draws((0.3, 1.0), (0.35, 0.55), (0.04, 0.18))
    x, y = upto(width, depth)
    metal = any_metal(a)
    a.body(a.pick(STEEL, BLACK, WHITE)).add(box(x, y, (0.0, height)))
    if height > 0.09:
        _burners(a, x, y, height)
        ControlPanel(a, facing_front(0.0), metal, RED).knob_row(x, height / 2, height)
        return
    beside = a.happens(0.5)
    row = y if beside else x
    _burners(a, (0.0, 0.8 * width) if beside else x, y if beside else (0.14, depth), height)
    count = a.count(2, 6)
    radius = min(0.022, 0.35 * size(row) / (count + 1))
    panel = ControlPanel(a, facing_up(height), metal, RED)
    for i, v in enumerate(between(row, count)):
        panel.knob(f"knob_{i}", (0.91 * width, v) if beside else (v, 0.06), radius)


def hood(a: Assembly) -> None:
    """Build an extractor hood: a visor that slides out or a pane that lifts, and buttons."""
    width, depth, low = a.draws((0.5, 1.0), (0.4, 0.55), (0.05, 0.1))
    high, top = a.draws((low + 0.12, low + 0.3), (low + 0.5, low + 0.9))
    x, y = upto(width, depth)
    body = a.body(a.pick(STEEL, WHITE, BLACK))
    flue = (about(0.13, width / 2), (depth - 0.3, depth))
    body.add(frustum((x, y), flue, (low, high)), box(*flue, (high, top)))
    panel = ControlPanel(a, facing_front(0.0), WHITE)
    for i, at in enumerate(np.linspace(0.3, 0.7, a.count(2, 5)) * width):
        panel.button(f"button_{i}", about(0.01, at), (0.028, low - 0.006))
    visored = a.happens(0.6)
    body.add(box(x, y, (0.022 if visored else 0.0, low)))
    if visored:
        body.add(*(box(end, y, (0.0, 0.022)) for end in ends(x, 0.01)))
        visor = a.slider("visor", FRONT, (width / 2, -0.02, 0.012), round(0.6 * depth, 3))
        visor.add(box(within(x, 0.012), (-0.02, depth - 0.05), (0.004, 0.02)))


def dish_washer(a: Assembly) -> None:
    """Build a door that drops, before racks that come out over it."""
    style = _style(a, {"slab": 0.7, "bevel": 0.3})
    sizes = a.draws((0.42, 0.62), (0.5, 0.65), (0.6, 0.8))
    node = a.weighted({"flap": 0.6, column((0.86, "flap"), (0.14, "fixed")): 0.4})
    case = furniture(a, style, sizes, node, "plinth", a.draw(0.05, 0.13), BLACK)
    if a.happens(0.4):
        top = box(within(case.x, -0.01), (-0.03, sizes[1]), span(case.z[1], 0.03))
        a.root.add(top, look=WHITE)
    if not style.hollow:
        return
    door, cell, *_ = case.doors[0]
    door.upper = max(door.upper, np.radians(90))
    x = within(cell.inner[0], 0.012)
    y = within(case.y, 0.02, 0.03)
    floor = case.z[0] + style.board + 0.06
    for i, low in enumerate(np.linspace(floor, case.z[0] + 0.7 * sizes[2], 3)[: a.count(1, 3)]):
        part = a.root
        if a.happens(0.75):
            at = (sizes[0] / 2, 0.0, low)
            part = a.slider(f"inner_rack_{i}", FRONT, at, round(0.8 * sizes[1], 3))
        z = (float(low), min(low + a.draw(0.05, 0.13), cell.inner[1][1] - 0.012))
        wires = [cylinder(Z, at, 0.003, z, 6) for at in corners(x, y, 0.003)]
        part.add(*rack(x, y, z[0], 12), *rack(x, y, z[1], 0), *wires, look=STEEL)


def _demo(
    a: Assembly, sizes: tuple[float, ...], node: Node, support: str, base: float, style: Style, *,
    length: float, look: Material,
) -> Casework:  # fmt: skip
    """Return an appliance of the demo, its door with a bar of some length, or a rail."""
    pull = replace(style.pull, kind=a.pick("bar", "rail"), length=length, look=look)
    plain = replace(style, pull=pull, panel="slab", upper="slab", shelves=0, pull_at=0.5)
    return furniture(a, plain, sizes, node, support, base, BLACK)


def oven(a: Assembly) -> None:
    """Build the demo's range: a drop door with a window, knobs, a drawer below, burners."""
    skin, metal = a.picks((WHITE, STEEL, BLACK), (STEEL, BLACK))
    style = convex_style(a, skin, board=0.018, front=0.035)
    sizes = a.draws((0.55, 0.7), (0.53, 0.61), (0.81, 0.89))
    node = column((0.2, "drawer:drawer"), (0.66, "flap:door"), (0.14, "fixed"))
    case = _demo(a, sizes, node, "feet", 0.03, style, length=a.draw(0.3, 0.45), look=metal)
    door, cell, *_ = case.doors[0]
    window = box(within(cell.x, 0.09), span(case.face, -0.003), within(cell.z, 0.1, 0.13))
    door.add(window, look=GLASS)
    _racks(a, case, 2)
    panel = ControlPanel(a, facing_front(case.face), metal, RED)
    for i, x in enumerate(between(within(case.x, 0.04), a.count(2, 5))):
        panel.knob(f"knob_{i}", (x, case.z[1] - 0.07 * sizes[2]), 0.025)
    for at in [(mid(u), mid(v)) for u in shares(case.x, 2) for v in shares(case.y, 2)]:
        a.root.add(cylinder(Z, at, 0.08, span(case.z[1], 0.006), 20), look=BLACK)


def microwave(a: Assembly) -> None:
    """Build a microwave of the demo: a side door with a window, a panel with buttons and a knob."""
    skin, dark = a.picks((WHITE, STEEL, BLACK), (BLACK, STEEL))
    style = convex_style(a, skin, board=0.016, front=0.028)
    sizes = a.draws((0.46, 0.56), (0.31, 0.39), (0.26, 0.31))
    node = row((0.74, "door:door"), (0.26, "fixed"))
    case = _demo(a, sizes, node, "feet", 0.012, style, length=0.7 * sizes[2], look=dark)
    door, cell, *_ = case.doors[0]
    window = box(within(cell.x, 0.05, 0.07), span(case.face, -0.002), within(cell.z, 0.04))
    door.add(window, look=GLASS)
    x = (0.75 * sizes[0], sizes[0] - 0.008)
    z = case.z
    place = facing_front(case.face)
    for _, key_x, key_z in cells(x, (z[0] + 0.02, z[0] + 0.13), 4, 3):
        a.root.add(key(key_x, key_z, (0.0, 0.002), 0.0).moved(place), look=WHITE)
    plate = (mid(cell.inner[0]), mid(case.y))
    a.root.add(cylinder(Z, plate, 0.11, span(cell.inner[1][0], 0.008), 20), look=GLASS)
    panel = ControlPanel(a, place, RED if dark is skin else skin, RED)
    panel.knob("knob", (mid(x), z[1] - 0.05), 0.02)


def dishwasher(a: Assembly) -> None:
    """Build a dishwasher of the demo: a drop door before two racks, on a recessed plinth."""
    skin, dark = a.picks((WHITE, STEEL, BLACK), (BLACK, STEEL))
    style = convex_style(a, skin, board=0.016, front=0.03)
    sizes = a.draws((0.45, 0.6), (0.51, 0.57), (0.7, 0.76))
    look = RED if skin is dark else dark
    base = a.draw(0.09, 0.11)
    case = _demo(a, sizes, "flap:door", "plinth", base, style, length=0.75 * sizes[0], look=look)
    door, cell, *_ = case.doors[0]
    strip = (cell.z[1] - 0.05, cell.z[1] - 0.02)
    door.add(box(within(cell.x, 0.001), span(case.face, -0.003), strip), look=dark)
    for share in (0.16, 0.6):
        level = case.z[0] + share * sizes[2]
        a.root.add(*rack(cell.inner[0], within(case.y, 0.03, 0.02), level, 7), look=STEEL)


#: Units of a row: how often each is drawn, and its width [m].
UNITS: dict[str, tuple[float, Span]] = {
    "door": (0.22, (0.3, 0.6)),
    "drawers": (0.22, (0.3, 0.6)),
    "drawer_over_door": (0.18, (0.3, 0.6)),
    "double": (0.12, (0.7, 1.0)),
    "oven": (0.12, (0.55, 0.65)),
    "dishwasher": (0.07, (0.55, 0.65)),
    "open": (0.07, (0.3, 0.6)),
}
OVENS: dict[Node, float] = {
    column((0.8, "flap"), (0.16, "fixed")): 0.6,
    column((0.2, "drawer"), (0.64, "flap"), (0.16, "fixed")): 0.4,
}


def _node(a: Assembly, unit: str) -> Node:
    nodes: dict[str, Node] = {
        "drawers": drawers(a, a.count(2, 4)),
        "drawer_over_door": column((0.78, "door"), (0.22, "drawer")),
        "oven": a.weighted(OVENS),
        "dishwasher": "flap",
    }
    return nodes.get(unit, unit)


def _oven_style(style: Style) -> Style:
    glazed = replace(style, panel="glazed", upper="glazed", drawer="slab", rail=0.07)
    return replace(glazed, hollow=True, face=STEEL, shelves=0, slide=0.7)


def kitchen(a: Assembly) -> None:
    """Build two to five base units, a worktop with a sink or a hob; at times wall units."""
    depth, base, height = a.draws((0.5, 0.65), (0.07, 0.15), (0.65, 0.78))
    style = any_style(a, None, 0.12, pull_at=HIGH)
    style = replace(style, covered=True, crowded=True, reveal=0.0, shelves=2)
    y = (0.0, depth)
    z = span(base, height)
    left = 0.0
    hob = None
    weights = {unit: weight for unit, (weight, _) in UNITS.items()}
    for i in range(a.count(2, 5)):
        unit = a.weighted(weights)
        x = span(left, a.draw(*UNITS[unit][1]))
        left = x[1]
        mine = _oven_style(style) if unit == "oven" else style
        case = Casework(a, mine, x, y, z, f"unit_{i}_").build(_node(a, unit))
        if unit == "oven":
            hob = x
            _panel_row(a, case, 0.16, (any_metal(a), RED))
            shelf = rack(within(x, mine.board), within(y, 0.05, 0.03), z[0] + 0.6 * height, 8)
            a.root.add(*shelf, look=STEEL)
    if not a.parts:
        Casework(a, style, span(left, 0.5), y, z, "last_").build("door")
        left += 0.5
    a.root.add(box((0.01, left - 0.01), (0.05, depth), (0.0, base)), look=BLACK)
    sunk = hob is None and not style.hollow and left > 0.9 and a.happens(0.5)
    deep = within(y, -max(0.0, style.proud), 0.0)
    top = put_top(a, "sink" if sunk else "board", (0.0, left), deep, z[1], any_color(a))
    if hob is not None and a.happens(0.7):
        _burners(a, within(hob, 0.03), (0.06, depth - 0.05), top)
    if a.happens(0.35):
        _wall_units(a, style, left, depth, z[1])


def _wall_units(a: Assembly, style: Style, width: float, depth: float, z: float) -> None:
    """Build cabinets over the worktop, on a back wall that holds them."""
    high = span(z + a.draw(0.45, 0.6), a.draw(0.4, 0.8))
    y = (depth - a.draw(0.28, 0.38), depth)
    upper = replace(style, covered=False, pull_at=0.15)
    a.root.add(box((0.0, width), span(depth, 0.02), (0.0, high[1])), look=any_color(a))
    mix = {"door": 2.0, "double": 2.0, "lift": 0.5, "open": 0.5}
    for i, x in enumerate(shares((0.0, width), max(1, round(width / a.draw(0.45, 0.8))))):
        Casework(a, upper, x, y, high, f"wall_{i}_").build(filling(a, size(x), size(high), mix))


def oven_tower(a: Assembly) -> None:
    """Build a tall unit around an oven, doors above and drawers or a door below."""
    width, depth, height, base = a.draws((0.55, 0.68), (0.5, 0.65), (1.6, 2.2), (0.05, 0.12))
    style = replace(any_style(a, None, 0.15), shelves=2, covered=True, taste=0.0)
    # What lies above and below is a neighbour: fronts keep half a gap to the level's end.
    style = replace(style, reveal=style.gap / 2)
    x, y = upto(width, depth)
    low = span(base, height * a.draw(0.25, 0.4))
    middle = span(low[1], a.draw(0.5, 0.62))
    door = "double" if a.happens(0.4) else "door"
    below = drawers(a, a.count(1, 3)) if a.happens(0.6) else door
    above = column((1.0, "flap"), (1.2, door)) if a.happens(0.3) else door
    a.root.add(box(within(x, 0.01), (0.04, depth), (0.0, base)), look=BLACK)
    Casework(a, style, x, y, low, "low_").build(below)
    oven = column((0.82, "flap"), (0.18, "fixed"))
    case = Casework(a, _oven_style(style), x, y, middle, "oven_").build(oven)
    Casework(a, style, x, y, (middle[1], base + height), "high_").build(above)
    _panel_row(a, case, 0.18, (any_metal(a), RED))
