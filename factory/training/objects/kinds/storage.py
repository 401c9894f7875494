"""Furniture to store things in: one plan per kind, casework for all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from ..kit.assembly import Assembly
from ..kit.boards import cornice, slab, stand, worktop
from ..kit.casework import Style, casework, furniture
from ..kit.layouts import (
    Cell,
    Node,
    column,
    divided,
    drawers,
    filling,
    grid,
    leaves,
    random_node,
    row,
)
from ..kit.looks import BLACK, GREEN, OAK, STEEL, WALNUT, WHITE, wood
from ..kit.shapes import Span, box, size, span, within
from ..kit.styles import any_color, any_style, convex_style


@dataclass(frozen=True)
class CaseworkPlan:
    """What tells one kind of furniture from another.

    Attributes:
        sizes: width, depth and height of the case [m].
        node: divides a front of a width and height [m].
        stands: what it stands on and how often.
        base: height of that [m].
        tops: what lies on it: ``flush`` (nothing), ``board``, ``cornice``, ``sink`` or ``vessel``.
        inset: share whose fronts lie in their openings.
        panels: styles of doors; the usual ones if empty.
        pulls: heights of the pulls of doors, as shares.
    """

    sizes: tuple[Span, Span, Span]
    node: Callable[[Assembly, float, float], Node]
    stands: Mapping[str, float]
    base: Span
    tops: Mapping[str, float]
    inset: float = 0.3
    panels: Mapping[str, float] = field(default_factory=dict)
    pulls: tuple[float, ...] = (0.5, 0.75, 0.3, 0.85)


def stored(plan: CaseworkPlan, a: Assembly) -> None:
    """One piece of furniture after a plan."""
    width, depth, height = a.draws(*plan.sizes)
    support, top = a.weighted(plan.stands), a.weighted(plan.tops)
    base = 0.0 if support == "none" else a.draw(*plan.base)
    style = any_style(a, plan.panels or None, plan.inset, pull_at=plan.pulls)
    style = replace(style, covered=top != "flush")
    node = plan.node(a, width, height)
    cells, _ = divided(node, (0.0, width), span(base, height), style.board, False)
    style = _spaced(a, style, cells)
    case = casework(a, style, (0.0, width), (0.0, depth), span(base, height), node)
    if not a.parts:
        case.build("double")
    stand(a, support, case.x, case.y, base, style.body if a.happens(0.7) else BLACK)
    _topped(a, top, case.x, within(case.y, -max(0.0, style.proud), 0.0), base + height)


def _spaced(a: Assembly, style: Style, cells: list[Cell]) -> Style:
    """A style whose fronts leave the frame between them bare, where the cells are large enough for it."""
    smallest = min(min(size(cell.x), size(cell.z)) for cell in cells)
    if style.inset or smallest < 0.15 or not a.happens(0.2):
        return style
    gap = a.draw(0.01, 0.04)
    board = gap + a.draw(0.008, 0.02)
    return replace(style, gap=gap, board=board, reveal=a.draw(0.3, 0.9) * board, bare=False)


def _topped(a: Assembly, top: str, x: Span, y: Span, z: float) -> None:
    look = any_color(a)
    if top == "board":
        a.root.add(slab(x, y, z, a.draw(0.015, 0.045), a.pick(0.0, 0.01, 0.025)), look=look)
    elif top == "cornice":
        a.root.add(*cornice(x, y, z), look=look)
    elif top != "flush":
        worktop(a, top, x, y, z, (look, STEEL))


#: A front of more cells is drawn anew.
MOST_CELLS = 16
USUAL = {
    "drawer": 1.0, "drawers": 1.5, "door": 2.0, "double": 1.5, "open": 0.5, "lift": 0.2, "flap": 0.25,
}  # fmt: skip


def _columns(a: Assembly, width: float, each: Span, least: int, most: int) -> int:
    """How many columns of about ``each`` width [m] a front has."""
    return min(most, max(least, round(width / a.draw(*each))))


def _uneven(a: Assembly, nodes: list[Node], low: float, high: float) -> Node:
    """Cells beside each other, their widths drawn."""
    return row(*((a.draw(low, high), node) for node in nodes))


def _dresser(a: Assembly, w: float, h: float) -> Node:
    rows, columns = a.count(2, 6), _columns(a, w, (0.4, 0.8), 1, 3)
    if columns == 1:
        return drawers(a, rows)
    if not a.happens(0.4):
        return grid(a, columns, rows)
    low = grid(a, columns if a.happens(0.4) else 1, rows - 1)
    return column((rows - 1.0, low), (0.8, grid(a, columns + a.count(0, 1), 1)))


def _nightstand(a: Assembly, w: float, h: float) -> Node:
    choice = a.count(0, 4)
    if choice < 2:
        return drawers(a, a.count(1, 3))
    lower = ("open", "door", "double" if w > 0.45 else "door")[choice - 2]
    return column((a.draw(0.5, 0.7), lower), (0.35, "drawer"))


def _wardrobe(a: Assembly, w: float, h: float) -> Node:
    if w > 1.0 and a.happens(0.25):
        return "sliding"
    columns, chance = _columns(a, w, (0.4, 0.6), 1, 4), a.draw(0.0, 1.0)
    node = "double" if columns == 2 else grid(a, columns, 1, "door")
    if chance < 0.35:
        low = grid(a, max(1, columns // 2), a.count(1, 2))
        return column((a.draw(0.12, 0.3), low), (0.75, node))
    return column((0.8, node), (0.2, grid(a, columns, 1, "door"))) if chance < 0.5 else node


def _sideboard(a: Assembly, w: float, h: float) -> Node:
    count = _columns(a, w, (0.35, 0.6), 2, 4)
    columns = [filling(a, w / count, h, USUAL | {"open": 0.3}) for _ in range(count)]
    if a.happens(0.5):
        columns[-1] = columns[0]
    body = _uneven(a, columns, 0.8, 1.2)
    return column((0.72, body), (0.28, grid(a, count, 1))) if a.happens(0.35) else body


def _base(a: Assembly, w: float, h: float) -> Node:
    count = max(1, round(w / a.draw(0.4, 0.7)))
    each, columns = w / count, []
    for _ in range(count):
        door = "double" if each > 0.5 and a.happens(0.7) else "door"
        choices: dict[Node, float] = {
            column((a.draw(0.7, 0.82), door), (0.22, "drawer")): 0.3,
            drawers(a, a.count(2, 4)): 0.25,
            "pullout": 0.08 if each < 0.45 else 0.0,
            column((0.78, door), (0.22, "fixed")): 0.07,
            door: 0.3,
        }
        columns.append(a.weighted(choices))
    return _uneven(a, columns, 0.7, 1.3)


def _sink(a: Assembly, w: float, h: float) -> Node:
    door = "double" if w > 0.5 else "door"
    return column((0.72, door), (0.28, "fixed")) if a.happens(0.5) else door


def _tall(a: Assembly, w: float, h: float) -> Node:
    door = "double" if w > 0.65 else "door"
    mix = {"drawers": 1.0, "drawer": 1.0, "open": 1.0, "lift": 0.3, "flap": 0.2}
    parts: list[tuple[float, Node]] = [(a.draw(0.4, 1.0), door)]
    parts += [(a.draw(0.15, 0.3), filling(a, w, 0.4, mix)) for _ in range(a.count(0, 2))]
    return column(*parts, *([(a.draw(0.3, 0.7), door)] if a.happens(0.7) else []))


def _wall(a: Assembly, w: float, h: float) -> Node:
    if h < 0.6 and a.happens(0.25):
        return "lift" if h < 0.45 else column((1.0, "lift"), (1.0, "lift"))
    mix = {"door": 2.0, "double": 2.0, "open": 0.5, "lift": 0.6}
    count = max(1, round(w / a.draw(0.4, 0.8)))
    cells = [filling(a, w / count, h, mix) for _ in range(count)]
    return (
        cells[0]
        if count == 1 and cells[0] != "open"
        else row((1.0, "door"), *((1.0, c) for c in cells))
    )


def _media(a: Assembly, w: float, h: float) -> Node:
    if a.happens(0.3):
        return "sliding"
    mix = {
        "open": 1.0, "drawer": 1.0, "drawers": 0.6, "flap": 1.0, "door": 1.0, "double": 0.5, "lift": 0.2,
    }  # fmt: skip
    count = a.count(2, 4)
    cells = [filling(a, w / count, h, mix | ({} if i else {"open": 0.0})) for i in range(count)]
    if a.happens(0.5):
        cells[-1] = cells[0]
    return _uneven(a, cells, 0.8, 1.4)


def _display(a: Assembly, w: float, h: float) -> Node:
    door = "double" if w > 0.55 else "door"
    lower = filling(a, w, 0.4 * h, {"double": 1.0, "drawers": 1.0, "door": 1.0})
    return column((a.draw(0.3, 0.5), lower), (0.6, door)) if a.happens(0.6) else door


def _filing(a: Assembly, w: float, h: float) -> Node:
    return grid(a, 1 if w < 0.6 else a.count(1, 2), a.count(2, 5))


def _shoes(a: Assembly, w: float, h: float) -> Node:
    flaps = grid(a, 1, a.count(2, 4), "flap")
    return column((0.85, flaps), (0.15, "drawer")) if a.happens(0.3) else flaps


def _open_shelves(a: Assembly, w: float, h: float) -> Node:
    lower = filling(a, w, 0.35 * h, {"double": 1.0, "drawers": 1.0, "door": 1.0, "sliding": 0.5})
    return column((a.draw(0.25, 0.45), lower), (0.65, "open"))


def _any(a: Assembly, w: float, h: float) -> Node:
    node = random_node(a, w, h, USUAL)
    while leaves(node) > MOST_CELLS:
        node = random_node(a, w, h, USUAL)
    return "double" if node == "open" else node


def _tools(a: Assembly, w: float, h: float) -> Node:
    rows = drawers(a, max(3, min(int(h / 0.1), a.count(3, 7))))
    return column((0.8, rows), (0.2, grid(a, a.count(1, 3), 1))) if a.happens(0.5) else rows


def _lockers(a: Assembly, w: float, h: float) -> Node:
    return grid(a, min(4, max(1, round(w / 0.33))), a.count(1, 4), "door")


LEGS = {
    "plinth": 0.25, "feet": 0.2, "tapered": 0.15, "round": 0.1, "turned": 0.05, "sled": 0.05, "skirt": 0.1,
    "none": 0.1,
}  # fmt: skip
KICK = {"plinth": 0.75, "feet": 0.1, "none": 0.15}
ROLLING = {"castors": 0.7, "none": 0.3}
FILES = {"plinth": 0.4, "castors": 0.3, "none": 0.3}
LOCKERS = {"plinth": 0.4, "feet": 0.4, "none": 0.2}
HUNG = {"none": 1.0}
BOARD = {"flush": 0.4, "board": 0.6}
SINK, FLUSH = {"sink": 1.0}, {"flush": 1.0}
VESSEL = {"vessel": 0.6, "board": 0.4}
CROWN, HIGH_CROWN = {"flush": 0.7, "cornice": 0.3}, {"flush": 0.4, "cornice": 0.6}
LOW, SHALLOW = (0.04, 0.18), (0.03, 0.12)
METAL, VENTED = {"slab": 0.7, "bevel": 0.3}, {"slab": 0.6, "bevel": 0.2, "louvre": 0.2}
GLAZED = {"glazed": 0.6, "mullion": 0.4}

_P = CaseworkPlan
PLANS: dict[str, CaseworkPlan] = {
    "dresser": _P(((0.4, 1.7), (0.35, 0.55), (0.55, 1.3)), _dresser, LEGS, LOW, BOARD),
    "nightstand": _P(((0.32, 0.65), (0.28, 0.5), (0.28, 0.6)), _nightstand, LEGS, (0.03, 0.3), BOARD),
    "wardrobe": _P(((0.5, 2.4), (0.45, 0.65), (1.6, 2.4)), _wardrobe, LEGS, SHALLOW, CROWN),
    "sideboard": _P(((0.9, 2.2), (0.35, 0.55), (0.45, 0.95)), _sideboard, LEGS, (0.05, 0.28), BOARD),
    "base_cabinet": _P(((0.3, 2.4), (0.5, 0.65), (0.65, 0.8)), _base, KICK, (0.07, 0.15), BOARD, 0.15, pulls=(0.85, 0.8)),
    "sink_cabinet": _P(((0.5, 1.2), (0.5, 0.62), (0.65, 0.8)), _sink, KICK, (0.05, 0.15), SINK, 0.15),
    "tall_cabinet": _P(((0.3, 0.95), (0.35, 0.65), (1.5, 2.2)), _tall, KICK, (0.05, 0.12), CROWN),
    "wall_cabinet": _P(((0.35, 1.6), (0.2, 0.4), (0.3, 0.95)), _wall, HUNG, LOW, CROWN, pulls=(0.15, 0.2, 0.5)),
    "media_unit": _P(((1.0, 2.2), (0.3, 0.5), (0.25, 0.6)), _media, LEGS, (0.04, 0.22), BOARD),
    "display_cabinet": _P(((0.45, 1.2), (0.3, 0.45), (1.2, 2.0)), _display, LEGS, LOW, HIGH_CROWN, panels=GLAZED),
    "filing_cabinet": _P(((0.35, 0.95), (0.4, 0.7), (0.5, 1.35)), _filing, FILES, (0.05, 0.09), BOARD, 0.5, METAL),
    "shoe_cabinet": _P(((0.45, 1.0), (0.15, 0.35), (0.7, 1.3)), _shoes, LEGS, SHALLOW, BOARD),
    "bookcase": _P(((0.5, 1.3), (0.25, 0.42), (1.2, 2.2)), _open_shelves, LEGS, (0.03, 0.1), CROWN),
    "lockers": _P(((0.3, 1.3), (0.35, 0.5), (1.0, 2.0)), _lockers, LOCKERS, LOW, FLUSH, 0.5, VENTED),
    "tool_chest": _P(((0.45, 0.9), (0.35, 0.5), (0.35, 0.9)), _tools, ROLLING, (0.07, 0.14), BOARD, 0.4, METAL),
    "storage_unit": _P(((0.4, 2.2), (0.25, 0.6), (0.4, 2.1)), _any, LEGS, LOW, BOARD | {"cornice": 0.1}),
    "washstand": _P(((0.5, 1.4), (0.4, 0.55), (0.35, 0.8)), _base, LEGS, (0.05, 0.35), VESSEL),
}  # fmt: skip


def cabinet(a: Assembly) -> None:
    """One to three columns of doors and drawers on a plinth or feet; the first column has both."""
    textured, columns = wood(a.count(0, 999)), a.count(1, 3)
    body = a.pick(textured, WHITE, OAK)
    face = textured if body is textured else a.pick(GREEN, WALNUT, WHITE)
    style = convex_style(a, body, face=face, shelves=a.count(1, 2))
    first = column((0.75, "door"), (0.25, "drawer"))
    others = (first, "door", column((0.4, "drawer"), (0.32, "drawer"), (0.28, "drawer")),
              column((0.3, "drawer"), (0.7, "door")))  # fmt: skip
    node = row((1.0, first), *((1.0, a.pick(*others)) for _ in range(columns - 1)))
    width, depth, height, base = a.draws((0.38, 0.5), (0.36, 0.56), (0.62, 0.95), (0.06, 0.12))
    furniture(a, style, (columns * width, depth, height), node, a.pick("feet", "plinth"), base)


MIX = {"double": 1.5, "door": 1.0, "drawers": 1.0, "open": 0.2}


def hutch(a: Assembly) -> None:
    """A deep case below, a shallow one upon it, a gap between them at times."""
    width, depth, low, high, base = a.draws(
        (0.7, 1.6), (0.38, 0.55), (0.6, 0.9), (0.7, 1.2), (0.03, 0.15)
    )
    style = replace(any_style(a), covered=True, reveal=0.0)
    columns = max(1, round(width / a.draw(0.4, 0.7)))
    each, body = width / columns, a.root
    below = row(*((1.0, filling(a, each, low, MIX | {"open": 0.0})) for _ in range(columns)))
    if a.happens(0.5):
        below = column((0.75, below), (0.25, grid(a, columns, 1)))
    x, y = (0.0, width), (0.0, depth)
    case = casework(a, style, x, y, span(base, low), below, "low_")
    stand(a, a.weighted(LEGS), x, y, base, style.body)
    start = base + low
    body.add(slab(x, (min(0.0, case.face), depth), start, 0.025, 0.01), look=any_color(a))
    start += 0.025
    if a.happens(0.4):
        gap = span(start, a.draw(0.1, 0.35))
        sides = [
            box(span(end, way), (depth - 0.25, depth), gap)
            for end, way in ((0.0, 0.02), (width, -0.02))
        ]
        body.add(*sides, box(within(x, 0.02), (depth - 0.015, depth), gap), look=style.body)
        start = gap[1]
    kind = a.weighted({"glazed": 0.4, "mullion": 0.25, style.panel: 0.35})
    upper = replace(style, panel=kind, upper=kind, hollow=True, covered=False, pull_at=0.3)
    mix = {"double": 1.0, "door": 1.5, "open": 0.7}
    above = row(*((1.0, filling(a, each, high, mix)) for _ in range(columns)))
    # The lower top stands out before the upper fronts: they keep a gap to it.
    body.add(box(within(x, 0.01), (depth - 0.2, depth), span(start, 0.003)), look=style.body)
    deep = (depth - a.draw(0.25, 0.33), depth)
    casework(a, upper, x, deep, span(start + 0.003, high), above, "high_")
    if a.happens(0.5):
        body.add(*cornice(x, (depth - 0.36, depth), start + 0.003 + high), look=style.body)


def secretaire(a: Assembly) -> None:
    """A writing cabinet: drawers, and over them a flap to write on."""
    sizes, base = a.draws((0.6, 1.0), (0.3, 0.5), (0.95, 1.5)), a.draw(0.03, 0.3)
    style = replace(any_style(a), covered=True)
    node = column((a.draw(0.8, 1.4), drawers(a, a.count(2, 3))), (1.0, "flap"))
    if a.happens(0.4):
        node = column((0.8, node), (0.2, grid(a, a.count(1, 2), 1)))
    case = furniture(a, style, sizes, node, a.weighted(LEGS), base)
    a.root.add(slab(case.x, within(case.y, -0.025, 0.0), case.z[1], 0.02, 0.015), look=any_color(a))


def storage_bed(a: Assembly) -> None:
    """A bed seen from its long side, drawers under the mattress, a headboard at one end."""
    length, width, low, base = a.draws((1.7, 2.1), (0.8, 1.6), (0.2, 0.35), (0.02, 0.08))
    style = replace(any_style(a), reveal=0.0)
    fixed = [(1.0, "fixed")] if a.happens(0.4) else []
    node = row(*[(1.0, "drawer")] * a.count(1, 3), *fixed)
    case = furniture(a, style, (length, width, low), node, a.pick("feet", "plinth"), base)
    top = span(case.z[1], a.draw(0.12, 0.28))
    left = a.happens(0.5)
    end, pillow = (
        (span(0.0, -0.05), span(0.05, 0.4))
        if left
        else (span(length, 0.05), span(length - 0.05, -0.4))
    )
    a.root.add(box(end, case.y, (0.0, top[1] + a.draw(0.1, 0.6))), look=style.body)
    mattress = box(within(case.x, 0.02), within(case.y, 0.02), top)
    a.root.add(mattress, box(pillow, within(case.y, 0.1), span(top[1], 0.09)), look=WHITE)


MAKERS = {name: partial(stored, plan) for name, plan in PLANS.items()} | {
    "cabinet": cabinet, "hutch": hutch, "secretaire": secretaire, "storage_bed": storage_bed,
}  # fmt: skip
