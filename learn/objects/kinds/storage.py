"""Furniture to store things in: one plan per kind, casework for all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from ..kit.assembly import Assembly
from ..kit.boards import cornice, put_top, slab, stand
from ..kit.casework import Casework, furniture
from ..kit.layouts import Node, column, divided, drawers, filling, grid, random_node, row
from ..kit.looks import BLACK, GREEN, OAK, WALNUT, WHITE, wood
from ..kit.shapes import box
from ..kit.spans import Span, ends, size, span, upto, within
from ..kit.styles import HIGH, any_color, any_style, convex_style

LEGS = {
    "plinth": 0.25, "feet": 0.2, "tapered": 0.15, "round": 0.1, "turned": 0.05, "sled": 0.05,
    "skirt": 0.1, "none": 0.1,
}  # fmt: skip
KICK = {"plinth": 0.75, "feet": 0.1, "none": 0.15}
FEET = {"plinth": 0.4, "feet": 0.4, "none": 0.2}
FILES = {"plinth": 0.4, "castors": 0.3, "none": 0.3}
ROLLING = {"castors": 0.7, "none": 0.3}
HUNG = {"none": 1.0}
BOARD = {"flush": 0.4, "board": 0.6}
SINK = {"sink": 1.0}
FLUSH = {"flush": 1.0}
BOWL = {"vessel": 0.6, "board": 0.4}
CROWN = {"flush": 0.7, "cornice": 0.3}
HIGH_CROWN = {"flush": 0.4, "cornice": 0.6}
ANY_TOP = {"flush": 0.5, "board": 0.4, "cornice": 0.1}
LOW = (0.04, 0.18)
METAL = {"slab": 0.7, "bevel": 0.3}
VENTED = {"slab": 0.6, "bevel": 0.2, "louvre": 0.2}
GLAZED = {"glazed": 0.6, "mullion": 0.4}


@dataclass(frozen=True)
class CaseworkPlan:
    """What tells one kind of furniture from another.

    Attributes:
        node: divides a front of a width and height [m].
        sizes: width, depth and height of the case [m].
        stands: what it stands on and how often.
        base: height of that [m].
        tops: of the piece: ``flush`` (nothing), ``board``, ``cornice``, ``sink`` or ``vessel``.
        inset: share whose fronts lie in their openings.
        panels: styles of doors; the usual ones if empty.
        pulls: heights of the pulls of doors, as shares.
    """

    node: Callable[[Assembly, float, float], Node]
    sizes: tuple[Span, Span, Span]
    stands: Mapping[str, float]
    base: Span
    tops: Mapping[str, float] = field(default_factory=lambda: BOARD)
    inset: float = 0.3
    panels: Mapping[str, float] = field(default_factory=dict)
    pulls: tuple[float, ...] = (0.5, 0.75, 0.3, 0.85)


def _stored(plan: CaseworkPlan, a: Assembly) -> None:
    """Build a piece of furniture after a plan."""
    width, depth, height = a.draws(*plan.sizes)
    support = a.weighted(plan.stands)
    top = a.weighted(plan.tops)
    base = 0.0 if support == "none" else a.draw(*plan.base)
    style = any_style(a, plan.panels or None, plan.inset, pull_at=plan.pulls)
    style = replace(style, covered=top != "flush")
    node = plan.node(a, width, height)
    cells, _ = divided(node, (0.0, width), span(base, height), style.board, False)
    smallest = min(min(size(cell.x), size(cell.z)) for cell in cells)
    if not style.inset and smallest >= 0.15 and a.happens(0.2):
        # Fronts leave the frame bare.
        gap = a.draw(0.01, 0.04)
        board = gap + a.draw(0.008, 0.02)
        reveal = a.draw(0.3, 0.9) * board
        style = replace(style, gap=gap, board=board, reveal=reveal, bare=False)
    look = style.body if a.happens(0.7) else BLACK
    case = furniture(a, style, (width, depth, height), node, support, base, look)
    if not a.parts:
        case.build("double")
    deep = within(case.y, -max(0.0, style.proud), 0.0)
    put_top(a, top, case.x, deep, base + height, any_color(a))


#: A front of more cells is drawn anew.
MOST_CELLS = 16
USUAL = {
    "drawer": 1.0, "drawers": 1.5, "door": 2.0, "double": 1.5, "open": 0.5, "lift": 0.2,
    "flap": 0.25,
}  # fmt: skip
MEDIA = {
    "open": 1.0, "drawer": 1.0, "drawers": 0.6, "flap": 1.0, "door": 1.0, "double": 0.5,
    "lift": 0.2,
}  # fmt: skip


def _columns(a: Assembly, width: float, each: Span, least: int, most: int) -> int:
    """Return how many columns of about ``each`` width [m] a front has."""
    return min(most, max(least, round(width / a.draw(*each))))


def _uneven(a: Assembly, nodes: list[Node], low: float, high: float) -> Node:
    """Return the cells beside each other, their widths drawn."""
    return row(*((a.draw(low, high), node) for node in nodes))


def _dresser(a: Assembly, w: float, h: float) -> Node:
    rows = a.count(2, 6)
    columns = _columns(a, w, (0.4, 0.8), 1, 3)
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
    columns = _columns(a, w, (0.4, 0.6), 1, 4)
    doors = "double" if columns == 2 else grid(a, columns, 1, "door")
    above = column((0.8, doors), (0.2, grid(a, columns, 1, "door")))
    low = column((a.draw(0.12, 0.3), grid(a, max(1, columns // 2), a.count(1, 2))), (0.75, doors))
    return a.weighted({low: 0.35, above: 0.15, doors: 0.5})


def _sideboard(a: Assembly, w: float, h: float) -> Node:
    count = _columns(a, w, (0.35, 0.6), 2, 4)
    columns = [filling(a, w / count, h, USUAL | {"open": 0.3}) for _ in range(count)]
    if a.happens(0.5):
        columns[-1] = columns[0]
    body = _uneven(a, columns, 0.8, 1.2)
    return column((0.72, body), (0.28, grid(a, count, 1))) if a.happens(0.35) else body


def _base(a: Assembly, w: float, h: float) -> Node:
    count = max(1, round(w / a.draw(0.4, 0.7)))
    columns = []
    for _ in range(count):
        door = "double" if w / count > 0.5 and a.happens(0.7) else "door"
        choices: dict[Node, float] = {
            column((a.draw(0.7, 0.82), door), (0.22, "drawer")): 0.3,
            drawers(a, a.count(2, 4)): 0.25,
            "pullout": 0.08 if w / count < 0.45 else 0.0,
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
    cells = [(1.0, filling(a, w / count, h, mix)) for _ in range(count)]
    return row(*cells) if count == 1 and cells[0][1] != "open" else row((1.0, "door"), *cells)


def _media(a: Assembly, w: float, h: float) -> Node:
    if a.happens(0.3):
        return "sliding"
    count = a.count(2, 4)
    cells = [filling(a, w / count, h, MEDIA | ({} if i else {"open": 0.0})) for i in range(count)]
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


def _shelves(a: Assembly, w: float, h: float) -> Node:
    lower = filling(a, w, 0.35 * h, {"double": 1.0, "drawers": 1.0, "door": 1.0, "sliding": 0.5})
    return column((a.draw(0.25, 0.45), lower), (0.65, "open"))


def _any(a: Assembly, w: float, h: float) -> Node:
    node = random_node(a, w, h, USUAL)
    while len(divided(node, (0.0, w), (0.0, h), 0.0, False)[0]) > MOST_CELLS:
        node = random_node(a, w, h, USUAL)
    return "double" if node == "open" else node


def _tools(a: Assembly, w: float, h: float) -> Node:
    rows = drawers(a, max(3, min(int(h / 0.1), a.count(3, 7))))
    return column((0.8, rows), (0.2, grid(a, a.count(1, 3), 1))) if a.happens(0.5) else rows


def _lockers(a: Assembly, w: float, h: float) -> Node:
    return grid(a, min(4, max(1, round(w / 0.33))), a.count(1, 4), "door")


def _secretaire(a: Assembly, w: float, h: float) -> Node:
    node = column((a.draw(0.8, 1.4), drawers(a, a.count(2, 3))), (1.0, "flap"))
    return column((0.8, node), (0.2, grid(a, a.count(1, 2), 1))) if a.happens(0.4) else node


_P = CaseworkPlan
PLANS: dict[str, CaseworkPlan] = {
    "dresser": _P(_dresser, ((0.4, 1.7), (0.35, 0.55), (0.55, 1.3)), LEGS, LOW, BOARD),
    "nightstand": _P(_nightstand, ((0.32, 0.65), (0.28, 0.5), (0.28, 0.6)), LEGS, (0.03, 0.3)),
    "wardrobe": _P(_wardrobe, ((0.5, 2.4), (0.45, 0.65), (1.6, 2.4)), LEGS, (0.03, 0.12), CROWN),
    "sideboard": _P(_sideboard, ((0.9, 2.2), (0.35, 0.55), (0.45, 0.95)), LEGS, (0.05, 0.28)),
    "base_cabinet": _P(
        _base, ((0.3, 2.4), (0.5, 0.65), (0.65, 0.8)), KICK, (0.07, 0.15), inset=0.15, pulls=HIGH
    ),
    "sink_cabinet": _P(
        _sink, ((0.5, 1.2), (0.5, 0.62), (0.65, 0.8)), KICK, (0.05, 0.15), SINK, 0.15
    ),
    "tall_cabinet": _P(_tall, ((0.3, 0.95), (0.35, 0.65), (1.5, 2.2)), KICK, (0.05, 0.12), CROWN),
    "wall_cabinet": _P(
        _wall, ((0.35, 1.6), (0.2, 0.4), (0.3, 0.95)), HUNG, LOW, CROWN, pulls=(0.15, 0.2, 0.5)
    ),
    "media_unit": _P(_media, ((1.0, 2.2), (0.3, 0.5), (0.25, 0.6)), LEGS, (0.04, 0.22)),
    "display_cabinet": _P(
        _display, ((0.45, 1.2), (0.3, 0.45), (1.2, 2.0)), LEGS, LOW, HIGH_CROWN, panels=GLAZED
    ),
    "filing_cabinet": _P(
        _filing, ((0.35, 0.95), (0.4, 0.7), (0.5, 1.35)), FILES, (0.05, 0.09), BOARD, 0.5, METAL
    ),
    "shoe_cabinet": _P(_shoes, ((0.45, 1.0), (0.15, 0.35), (0.7, 1.3)), LEGS, (0.03, 0.12)),
    "bookcase": _P(_shelves, ((0.5, 1.3), (0.25, 0.42), (1.2, 2.2)), LEGS, (0.03, 0.1), CROWN),
    "lockers": _P(_lockers, ((0.3, 1.3), (0.35, 0.5), (1.0, 2.0)), FEET, LOW, FLUSH, 0.5, VENTED),
    "tool_chest": _P(
        _tools, ((0.45, 0.9), (0.35, 0.5), (0.35, 0.9)), ROLLING, (0.07, 0.14), BOARD, 0.4, METAL
    ),
    "storage_unit": _P(_any, ((0.4, 2.2), (0.25, 0.6), (0.4, 2.1)), LEGS, LOW, ANY_TOP),
    "secretaire": _P(
        _secretaire, ((0.6, 1.0), (0.3, 0.5), (0.95, 1.5)), LEGS, (0.03, 0.3), {"board": 1.0}
    ),
    "washstand": _P(_base, ((0.5, 1.4), (0.4, 0.55), (0.35, 0.8)), LEGS, (0.05, 0.35), BOWL),
}


def cabinet(a: Assembly) -> None:
    """Build one to three columns of doors and drawers; the first column has both."""
    textured = wood(a.count(0, 999))
    body = a.pick(textured, WHITE, OAK)
    face = textured if body is textured else a.pick(GREEN, WALNUT, WHITE)
    style = convex_style(a, body, face=face, shelves=a.count(1, 2))
    both = column((0.75, "door"), (0.25, "drawer"))
    three = column((0.4, "drawer"), (0.32, "drawer"), (0.28, "drawer"))
    others = (both, "door", three, column((0.3, "drawer"), (0.7, "door")))
    columns = [both, *(a.pick(*others) for _ in range(a.count(0, 2)))]
    each, *sizes = a.draws((0.38, 0.5), (0.36, 0.56), (0.62, 0.95))
    node = row(*((1.0, each) for each in columns))
    base = a.draw(0.06, 0.12)
    furniture(a, style, (len(columns) * each, *sizes), node, a.pick("feet", "plinth"), base)


MIX = {"double": 1.5, "door": 1.0, "drawers": 1.0}


def hutch(a: Assembly) -> None:
    """Build a deep case below, a shallow one upon it, a gap between them at times."""
    width, depth, base = a.draws((0.7, 1.6), (0.38, 0.55), (0.03, 0.15))
    low, high = a.draws((0.6, 0.9), (0.7, 1.2))
    x, y = upto(width, depth)
    body = a.root
    style = replace(any_style(a), covered=True, reveal=0.0)
    columns = max(1, round(width / a.draw(0.4, 0.7)))
    each = width / columns
    below = row(*((1.0, filling(a, each, low, MIX)) for _ in range(columns)))
    if a.happens(0.5):
        below = column((0.75, below), (0.25, grid(a, columns, 1)))
    case = Casework(a, style, x, y, span(base, low), "low_").build(below)
    stand(a, a.weighted(LEGS), x, y, base, style.body)
    body.add(slab(x, (min(0.0, case.face), depth), base + low, 0.025, 0.01), look=any_color(a))
    start = base + low + 0.025
    if a.happens(0.4):
        gap = span(start, a.draw(0.1, 0.35))
        rear = box(within(x, 0.02), (depth - 0.015, depth), gap)
        sides = (box(end, (depth - 0.25, depth), gap) for end in ends(x, 0.02))
        body.add(rear, *sides, look=style.body)
        start = gap[1]
    kind = a.weighted({"glazed": 0.4, "mullion": 0.25, style.panel: 0.35})
    upper = replace(style, panel=kind, upper=kind, hollow=True, covered=False, pull_at=0.3)
    mix = {"double": 1.0, "door": 1.5, "open": 0.7}
    above = row(*((1.0, filling(a, each, high, mix)) for _ in range(columns)))
    # The lower top stands out before the upper fronts: they keep a gap to it.
    body.add(box(within(x, 0.01), (depth - 0.2, depth), span(start, 0.003)), look=style.body)
    deep = (depth - a.draw(0.25, 0.33), depth)
    Casework(a, upper, x, deep, span(start + 0.003, high), "high_").build(above)
    if a.happens(0.5):
        body.add(*cornice(x, (depth - 0.36, depth), start + 0.003 + high), look=style.body)


def storage_bed(a: Assembly) -> None:
    """Build a bed seen from its long side, drawers under the mattress, a headboard at one end."""
    sizes = a.draws((1.7, 2.1), (0.8, 1.6), (0.2, 0.35))
    style = replace(any_style(a), reveal=0.0)
    fixed = [(1.0, "fixed")] if a.happens(0.4) else []
    node = row(*[(1.0, "drawer")] * a.count(1, 3), *fixed)
    case = furniture(a, style, sizes, node, a.pick("feet", "plinth"), a.draw(0.02, 0.08))
    top = span(case.z[1], a.draw(0.12, 0.28))
    mattress = box(within(case.x, 0.02), within(case.y, 0.02), top)
    side = a.count(0, 1)
    head = ends(within(case.x, -0.05), 0.05)[side]
    pillow = ends(within(case.x, 0.05), 0.4)[side]
    a.root.add(box(head, case.y, (0.0, top[1] + a.draw(0.1, 0.6))), look=style.body)
    a.root.add(mattress, box(pillow, within(case.y, 0.1), span(top[1], 0.09)), look=WHITE)


PLANNED = {name: partial(_stored, plan) for name, plan in PLANS.items()}
