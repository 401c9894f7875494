"""Furniture to store things in: one plan per kind, casework for all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ...articulation import Articulation
from .casework import Style, casework
from .layouts import Cell, Node, divided, drawers, filling, grid, leaves, random_node, row, stack
from .limbs import built
from .looks import BLACK, STEEL
from .pieces import Piece
from .solids import Span
from .stands import cornice, countertop, sink_top, stood, vessel_top
from .styles import any_color, any_style, drawn


@dataclass(frozen=True)
class Plan:
    """What tells one kind of furniture from another.

    Attributes:
        width, depth, height: of the case [m].
        node: divides a front of a width and height [m].
        stands: what it stands on and how often.
        base: height of that [m].
        tops: what lies on it: ``flush`` (nothing), ``board``, ``cornice``, ``sink`` or ``vessel``.
        inset: share whose fronts lie in their openings.
        panels: styles of doors; the usual ones if empty.
        grips: heights of the grips of doors, as shares.
    """

    width: Span
    depth: Span
    height: Span
    node: Callable[[np.random.Generator, float, float], Node]
    stands: Mapping[str, float]
    base: Span
    tops: Mapping[str, float]
    inset: float = 0.3
    panels: Mapping[str, float] = field(default_factory=dict)
    grips: tuple[float, ...] = (0.5, 0.75, 0.3, 0.85)


def stored(plan: Plan, rng: np.random.Generator) -> Articulation:
    """One piece of furniture after a plan."""
    width, depth, height = (
        float(rng.uniform(*span)) for span in (plan.width, plan.depth, plan.height)
    )
    stand, top = drawn(rng, dict(plan.stands)), drawn(rng, dict(plan.tops))
    base = 0.0 if stand == "none" else float(rng.uniform(*plan.base))
    style = any_style(rng, dict(plan.panels) or None, plan.inset, grip_at=plan.grips)
    style = replace(style, covered=top != "flush")
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    node = plan.node(rng, width, height)
    style = _spaced(rng, style, divided(node, x, z, style.board, False)[0])
    body, limbs = casework(rng, style, x, y, z, node)
    if not limbs:
        body, limbs = casework(rng, style, x, y, z, "double")
    body += stood(rng, stand, x, y, base, style.body if rng.random() < 0.7 else BLACK)
    reach = 0.0 if style.inset else style.behind + style.front
    body += _topped(rng, top, x, (y[0] - reach, y[1]), z[1], style.board)
    return built(body, limbs)


def _spaced(rng: np.random.Generator, style: Style, cells: list[Cell]) -> Style:
    """A style whose fronts leave the frame between them bare, where the cells are large enough for it."""
    smallest = min(min(cell.x[1] - cell.x[0], cell.z[1] - cell.z[0]) for cell in cells)
    if style.inset or smallest < 0.15 or rng.random() > 0.2:
        return style
    gap = float(rng.uniform(0.01, 0.04))
    board = gap + float(rng.uniform(0.008, 0.02))
    return replace(
        style, gap=gap, board=board, reveal=float(rng.uniform(0.3, 0.9)) * board, bare=False
    )


def _topped(
    rng: np.random.Generator, top: str, x: Span, y: Span, z: float, board: float
) -> list[Piece]:
    look = any_color(rng)
    if top == "board":
        return countertop(
            x, y, z, float(rng.uniform(0.015, 0.045)), float(rng.choice([0.0, 0.01, 0.025])), look
        )
    if top == "cornice":
        return cornice(x, y, z, look)
    if top == "sink":
        return sink_top(rng, x, y, z, 0.03, (look, STEEL))
    if top == "vessel":
        return vessel_top(rng, x, y, z, 0.03, (look, STEEL))
    return []


#: A front of more cells is drawn anew.
MOST_CELLS = 16
USUAL = {
    "drawer": 1.0,
    "drawers": 1.5,
    "door": 2.0,
    "double": 1.5,
    "open": 0.5,
    "lift": 0.2,
    "flap": 0.25,
}


def _dresser(rng: np.random.Generator, w: float, h: float) -> Node:
    rows, columns = int(rng.integers(2, 7)), int(np.clip(round(w / rng.uniform(0.4, 0.8)), 1, 3))
    if columns == 1:
        return drawers(rng, rows)
    if rng.random() < 0.4:
        top = grid(rng, columns + int(rng.integers(0, 2)), 1)
        return stack(
            (rows - 1.0, grid(rng, columns if rng.random() < 0.4 else 1, rows - 1)), (0.8, top)
        )
    return grid(rng, columns, rows)


def _nightstand(rng: np.random.Generator, w: float, h: float) -> Node:
    choice = int(rng.integers(5))
    if choice < 2:
        return drawers(rng, int(rng.integers(1, 4)))
    lower: Node = (
        "open" if choice == 2 else "door" if choice == 3 else "double" if w > 0.45 else "door"
    )
    return stack((float(rng.uniform(0.5, 0.7)), lower), (0.35, "drawer"))


def _wardrobe(rng: np.random.Generator, w: float, h: float) -> Node:
    if w > 1.0 and rng.random() < 0.25:
        return "sliding"
    columns = int(np.clip(round(w / rng.uniform(0.4, 0.6)), 1, 4))
    kinds = ["door"] * columns
    node: Node = (
        "double" if columns == 2 else row(*((1.0, k) for k in kinds)) if columns > 1 else "door"
    )
    chance = rng.random()
    if chance < 0.35:
        return stack(
            (
                float(rng.uniform(0.12, 0.3)),
                grid(rng, max(1, columns // 2), int(rng.integers(1, 3))),
            ),
            (0.75, node),
        )
    if chance < 0.5:
        return stack((0.8, node), (0.2, grid(rng, columns, 1, "door")))
    return node


def _sideboard(rng: np.random.Generator, w: float, h: float) -> Node:
    count = int(np.clip(round(w / rng.uniform(0.35, 0.6)), 2, 4))
    columns = [filling(rng, w / count, h, USUAL | {"open": 0.3}) for _ in range(count)]
    if rng.random() < 0.5:
        columns[-1] = columns[0]
    body = row(*((float(rng.uniform(0.8, 1.2)), c) for c in columns))
    if rng.random() < 0.35:
        return stack((0.72, body), (0.28, grid(rng, count, 1)))
    return body


def _base(rng: np.random.Generator, w: float, h: float) -> Node:
    count = max(1, round(w / float(rng.uniform(0.4, 0.7))))
    columns: list[Node] = []
    for _ in range(count):
        each, chance = w / count, rng.random()
        door: Node = "double" if each > 0.5 and rng.random() < 0.7 else "door"
        if chance < 0.3:
            columns.append(stack((float(rng.uniform(0.7, 0.82)), door), (0.22, "drawer")))
        elif chance < 0.55:
            columns.append(drawers(rng, int(rng.integers(2, 5))))
        elif chance < 0.63 and each < 0.45:
            columns.append("pullout")
        elif chance < 0.7:
            columns.append(stack((0.78, door), (0.22, "fixed")))
        else:
            columns.append(door)
    return columns[0] if count == 1 else row(*((float(rng.uniform(0.7, 1.3)), c) for c in columns))


def _sink(rng: np.random.Generator, w: float, h: float) -> Node:
    door: Node = "double" if w > 0.5 else "door"
    return stack((0.72, door), (0.28, "fixed")) if rng.random() < 0.5 else door


def _tall(rng: np.random.Generator, w: float, h: float) -> Node:
    door: Node = "double" if w > 0.65 else "door"
    parts: list[tuple[float, Node]] = [(float(rng.uniform(0.4, 1.0)), door)]
    for _ in range(int(rng.integers(0, 3))):
        middle = filling(
            rng, w, 0.4, {"drawers": 1.0, "drawer": 1.0, "open": 1.0, "lift": 0.3, "flap": 0.2}
        )
        parts.append((float(rng.uniform(0.15, 0.3)), middle))
    if rng.random() < 0.7:
        parts.append((float(rng.uniform(0.3, 0.7)), door))
    return parts[0][1] if len(parts) == 1 else ("v", tuple(parts))


def _wall(rng: np.random.Generator, w: float, h: float) -> Node:
    if rng.random() < 0.25 and h < 0.6:
        return "lift" if h < 0.45 else stack((1.0, "lift"), (1.0, "lift"))
    mix = {"door": 2.0, "double": 2.0, "open": 0.5, "lift": 0.6}
    count = max(1, round(w / float(rng.uniform(0.4, 0.8))))
    cells = [filling(rng, w / count, h, mix) for _ in range(count)]
    return (
        cells[0]
        if count == 1 and cells[0] != "open"
        else row((1.0, "door"), *((1.0, c) for c in cells))
    )


def _media(rng: np.random.Generator, w: float, h: float) -> Node:
    if rng.random() < 0.3:
        return "sliding"
    count = int(rng.integers(2, 5))
    mix = {
        "open": 1.0,
        "drawer": 1.0,
        "drawers": 0.6,
        "flap": 1.0,
        "door": 1.0,
        "double": 0.5,
        "lift": 0.2,
    }
    cells: list[Node] = [filling(rng, w / count, h, mix) for _ in range(count)]
    cells[0] = filling(rng, w / count, h, mix | {"open": 0.0})
    if rng.random() < 0.5:
        cells[-1] = cells[0]
    return row(*((float(rng.uniform(0.8, 1.4)), c) for c in cells))


def _display(rng: np.random.Generator, w: float, h: float) -> Node:
    door: Node = "double" if w > 0.55 else "door"
    lower = filling(rng, w, 0.4 * h, {"double": 1.0, "drawers": 1.0, "door": 1.0})
    return stack((float(rng.uniform(0.3, 0.5)), lower), (0.6, door)) if rng.random() < 0.6 else door


def _filing(rng: np.random.Generator, w: float, h: float) -> Node:
    return grid(rng, 1 if w < 0.6 else int(rng.integers(1, 3)), int(rng.integers(2, 6)))


def _shoes(rng: np.random.Generator, w: float, h: float) -> Node:
    count = int(rng.integers(2, 5))
    flaps: Node = ("v", tuple((1.0, "flap") for _ in range(count)))
    return stack((0.85, flaps), (0.15, "drawer")) if rng.random() < 0.3 else flaps


def _open_shelves(rng: np.random.Generator, w: float, h: float) -> Node:
    lower = filling(rng, w, 0.35 * h, {"double": 1.0, "drawers": 1.0, "door": 1.0, "sliding": 0.5})
    return stack((float(rng.uniform(0.25, 0.45)), lower), (0.65, "open"))


def _any(rng: np.random.Generator, w: float, h: float) -> Node:
    node = random_node(rng, w, h, USUAL)
    while leaves(node) > MOST_CELLS:
        node = random_node(rng, w, h, USUAL)
    return "double" if node == "open" else node


def _tools(rng: np.random.Generator, w: float, h: float) -> Node:
    rows = drawers(rng, int(np.clip(h / 0.1, 3, rng.integers(3, 8))))
    return (
        stack((0.8, rows), (0.2, grid(rng, int(rng.integers(1, 4)), 1)))
        if rng.random() < 0.5
        else rows
    )


def _lockers(rng: np.random.Generator, w: float, h: float) -> Node:
    return grid(rng, int(np.clip(round(w / 0.33), 1, 4)), int(rng.integers(1, 5)), "door")


LEGS = {
    "plinth": 0.25,
    "feet": 0.2,
    "tapered": 0.15,
    "round": 0.1,
    "turned": 0.05,
    "sled": 0.05,
    "skirt": 0.1,
    "none": 0.1,
}
KICK = {"plinth": 0.75, "feet": 0.1, "none": 0.15}
BOARD = {"flush": 0.4, "board": 0.6}
HUNG = {"none": 1.0}
LOW = (0.04, 0.18)

PLANS: dict[str, Plan] = {
    "dresser": Plan((0.4, 1.7), (0.35, 0.55), (0.55, 1.3), _dresser, LEGS, LOW, BOARD),
    "nightstand": Plan(
        (0.32, 0.65), (0.28, 0.5), (0.28, 0.6), _nightstand, LEGS, (0.03, 0.3), BOARD
    ),
    "wardrobe": Plan(
        (0.5, 2.4),
        (0.45, 0.65),
        (1.6, 2.4),
        _wardrobe,
        LEGS,
        (0.03, 0.12),
        {"flush": 0.7, "cornice": 0.3},
    ),
    "sideboard": Plan(
        (0.9, 2.2), (0.35, 0.55), (0.45, 0.95), _sideboard, LEGS, (0.05, 0.28), BOARD
    ),
    "base_cabinet": Plan(
        (0.3, 2.4),
        (0.5, 0.65),
        (0.65, 0.8),
        _base,
        KICK,
        (0.07, 0.15),
        BOARD,
        0.15,
        grips=(0.85, 0.8),
    ),
    "sink_cabinet": Plan(
        (0.5, 1.2), (0.5, 0.62), (0.65, 0.8), _sink, KICK, (0.05, 0.15), {"sink": 1.0}, 0.15
    ),
    "tall_cabinet": Plan(
        (0.3, 0.95),
        (0.35, 0.65),
        (1.5, 2.2),
        _tall,
        KICK,
        (0.05, 0.12),
        {"flush": 0.8, "cornice": 0.2},
    ),
    "wall_cabinet": Plan(
        (0.35, 1.6),
        (0.2, 0.4),
        (0.3, 0.95),
        _wall,
        HUNG,
        LOW,
        {"flush": 0.9, "cornice": 0.1},
        grips=(0.15, 0.2, 0.5),
    ),
    "media_unit": Plan((1.0, 2.2), (0.3, 0.5), (0.25, 0.6), _media, LEGS, (0.04, 0.22), BOARD),
    "display_cabinet": Plan(
        (0.45, 1.2),
        (0.3, 0.45),
        (1.2, 2.0),
        _display,
        LEGS,
        LOW,
        {"flush": 0.4, "cornice": 0.6},
        panels={"glazed": 0.6, "mullion": 0.4},
    ),
    "filing_cabinet": Plan(
        (0.35, 0.95),
        (0.4, 0.7),
        (0.5, 1.35),
        _filing,
        {"plinth": 0.4, "castors": 0.3, "none": 0.3},
        (0.05, 0.09),
        BOARD,
        0.5,
        {"slab": 0.7, "bevel": 0.3},
    ),
    "shoe_cabinet": Plan((0.45, 1.0), (0.15, 0.35), (0.7, 1.3), _shoes, LEGS, (0.03, 0.12), BOARD),
    "bookcase": Plan(
        (0.5, 1.3),
        (0.25, 0.42),
        (1.2, 2.2),
        _open_shelves,
        LEGS,
        (0.03, 0.1),
        {"flush": 0.7, "cornice": 0.3},
    ),
    "lockers": Plan(
        (0.3, 1.3),
        (0.35, 0.5),
        (1.0, 2.0),
        _lockers,
        {"plinth": 0.4, "feet": 0.4, "none": 0.2},
        LOW,
        {"flush": 1.0},
        0.5,
        {"slab": 0.6, "bevel": 0.2, "louvre": 0.2},
    ),
    "tool_chest": Plan(
        (0.45, 0.9),
        (0.35, 0.5),
        (0.35, 0.9),
        _tools,
        {"castors": 0.7, "none": 0.3},
        (0.07, 0.14),
        BOARD,
        0.4,
        {"slab": 0.7, "bevel": 0.3},
    ),
    "storage_unit": Plan(
        (0.4, 2.2),
        (0.25, 0.6),
        (0.4, 2.1),
        _any,
        LEGS,
        LOW,
        {"flush": 0.5, "board": 0.4, "cornice": 0.1},
    ),
    "washstand": Plan(
        (0.5, 1.4),
        (0.4, 0.55),
        (0.35, 0.8),
        _base,
        LEGS,
        (0.05, 0.35),
        {"vessel": 0.6, "board": 0.4},
    ),
}

MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    name: partial(stored, plan) for name, plan in PLANS.items()
}
