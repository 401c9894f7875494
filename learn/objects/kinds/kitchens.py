"""Rows of kitchen units under one worktop, with built-in appliances."""

from __future__ import annotations

from dataclasses import replace

from ..kit.assembly import Assembly, facing_front
from ..kit.boards import rack, slab, worktop
from ..kit.casework import Casework
from ..kit.controls import knob_row
from ..kit.layouts import Node, column, drawers, filling
from ..kit.looks import BLACK, RED, STEEL
from ..kit.shapes import box
from ..kit.spans import Span, shares, size, span, upto, within
from ..kit.styles import Style, any_color, any_metal, any_style
from .cooking import burners

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


def _dials(a: Assembly, case: Casework, high: float, prefix: str = "") -> None:
    """Build knobs on the fixed panel over an oven, which is ``high`` [m]."""
    x = within(case.x, case.style.board)
    level = case.z[1] - high / 2
    room = high - 2.4 * case.style.board
    knob_row(a, x, level, room, (any_metal(a), RED), facing_front(case.face), prefix)


def kitchen(a: Assembly) -> None:
    """Build two to five base units, a worktop with a sink or a hob; at times wall units."""
    depth, base, height = a.draws((0.5, 0.65), (0.07, 0.15), (0.65, 0.78))
    style = any_style(a, None, 0.12, pull_at=(0.85, 0.8))
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
            _dials(a, case, 0.16 * height, case.prefix)
            shelf = rack(within(x, mine.board), within(y, 0.05, 0.03), z[0] + 0.6 * height, 8)
            a.root.add(*shelf, look=STEEL)
    if not a.parts:
        Casework(a, style, span(left, 0.5), y, z, "last_").build("door")
        left += 0.5
    a.root.add(box((0.01, left - 0.01), (0.05, depth), (0.0, base)), look=BLACK)
    _worktop(a, style, (0.0, left), y, z[1], hob)
    if a.happens(0.35):
        _wall_units(a, style, left, depth, z[1])


def _worktop(a: Assembly, style: Style, x: Span, y: Span, z: float, hob: Span | None) -> None:
    over = a.pick(0.0, 0.01, 0.025)
    look = any_color(a)
    deep = within(y, -max(0.0, style.proud) - over, 0.0)
    if hob is None and not style.hollow and size(x) > 0.9 and a.happens(0.5):
        worktop(a, "sink", x, deep, z, (look, STEEL))
        return
    a.root.add(slab(x, deep, z, 0.035), look=look)
    if hob is not None and a.happens(0.7):
        burners(a, within(hob, 0.03), (0.06, y[1] - 0.05), z + 0.035)


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
    _dials(a, case, 0.18 * size(middle))
