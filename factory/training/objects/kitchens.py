"""Rows of kitchen units under one worktop, with what is built into them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from .casework import Style, casework
from .cooking import burners, knobs, rack
from .layouts import Node, drawers, filling, stack
from .limbs import Limb, built
from .looks import BLACK, RED, STEEL
from .panels import within
from .pieces import Block, Piece
from .solids import Span
from .stands import countertop, sink_top
from .styles import any_color, any_metal, any_style

#: Units of a row and how often each is drawn.
UNITS: dict[str, float] = {
    "door": 0.22, "drawers": 0.22, "drawer_over_door": 0.18, "double": 0.12, "oven": 0.12, "dishwasher": 0.07,
    "open": 0.07,
}  # fmt: skip


def _node(rng: np.random.Generator, unit: str) -> Node:
    if unit == "drawers":
        return drawers(rng, int(rng.integers(2, 5)))
    if unit == "drawer_over_door":
        return stack((0.78, "door"), (0.22, "drawer"))
    if unit == "oven":
        return (
            stack((0.8, "flap"), (0.16, "fixed"))
            if rng.random() < 0.6
            else stack((0.2, "drawer"), (0.64, "flap"), (0.16, "fixed"))
        )
    return {"dishwasher": "flap"}.get(unit, unit)


def _oven_style(style: Style) -> Style:
    return replace(
        style,
        panel="glazed",
        upper="glazed",
        drawer="slab",
        rail=0.07,
        hollow=True,
        face=STEEL,
        shelves=0,
        slide=0.7,
    )


def kitchen(rng: np.random.Generator) -> Articulation:
    """Two to five base units on a plinth; a worktop with a sink or a hob; wall units above at times."""
    depth, base, height = (
        float(rng.uniform(0.5, 0.65)),
        float(rng.uniform(0.07, 0.15)),
        float(rng.uniform(0.65, 0.78)),
    )
    style = replace(
        any_style(rng, None, 0.12, grip_at=(0.85, 0.8)),
        covered=True,
        crowded=True,
        reveal=0.0,
        shelves=2,
    )
    names = list(UNITS)
    weight = np.array(list(UNITS.values()))
    body: list[Piece] = []
    limbs: list[Limb] = []
    left = 0.0
    y, z = (0.0, depth), (base, base + height)
    hob_at: Span | None = None
    for i in range(int(rng.integers(2, 6))):
        unit = names[int(rng.choice(len(names), p=weight / weight.sum()))]
        width = float(
            rng.uniform(0.7, 1.0)
            if unit == "double"
            else rng.uniform(0.55, 0.65)
            if unit in ("oven", "dishwasher")
            else rng.uniform(0.3, 0.6)
        )
        x, mine = (left, left + width), _oven_style(style) if unit == "oven" else style
        parts = casework(rng, mine, x, y, z, _node(rng, unit), f"unit_{i}_")
        body += parts[0]
        limbs += parts[1]
        if unit == "oven":
            hob_at = x
            front = style.recess if style.inset else -style.behind - style.front
            level = z[1] - 0.08 * height
            dials = knobs(
                rng,
                within(x, style.board),
                level,
                front,
                0.16 * height - 2.4 * style.board,
                (any_metal(rng), RED),
            )
            limbs += [replace(dial, name=f"unit_{i}_{dial.name}") for dial in dials]
            body += rack(
                (x[0] + style.board, x[1] - style.board),
                (0.05, depth - 0.03),
                z[0] + 0.6 * height,
                8,
                True,
                STEEL,
            )
        left += width
    body.append(Block((0.01, left - 0.01), (0.05, depth), (0.0, base), BLACK))
    body += _worktop(rng, style, (0.0, left), y, z[1], hob_at)
    if rng.random() < 0.35:
        wall = _wall_units(rng, style, left, depth, z[1])
        body += wall[0]
        limbs += wall[1]
    if not limbs:
        parts = casework(rng, style, (left, left + 0.5), y, z, "door", "last_")
        body, limbs = body + parts[0], parts[1]
    return built(body, limbs)


def _worktop(
    rng: np.random.Generator, style: Style, x: Span, y: Span, z: float, hob: Span | None
) -> list[Piece]:
    over = float(rng.choice([0.0, 0.01, 0.025]))
    front = 0.0 if style.inset else style.behind + style.front
    look, deep = any_color(rng), (y[0] - front - over, y[1])
    if hob is None and not style.hollow and x[1] - x[0] > 0.9 and rng.random() < 0.5:
        return sink_top(rng, x, deep, z, 0.035, (look, STEEL))
    pieces = countertop(x, deep, z, 0.035, 0.0, look)
    if hob is not None and rng.random() < 0.7:
        pieces += burners(rng, (hob[0] + 0.03, hob[1] - 0.03), (0.06, y[1] - 0.05), z + 0.035)
    return pieces


def _wall_units(
    rng: np.random.Generator, style: Style, width: float, depth: float, z: float
) -> tuple[list[Piece], list[Limb]]:
    """Cabinets over the worktop, on a back wall that holds them."""
    deep, low = float(rng.uniform(0.28, 0.38)), z + float(rng.uniform(0.45, 0.6))
    high = low + float(rng.uniform(0.4, 0.8))
    body: list[Piece] = [Block((0.0, width), (depth, depth + 0.02), (0.0, high), any_color(rng))]
    limbs: list[Limb] = []
    count = max(1, round(width / float(rng.uniform(0.45, 0.8))))
    upper = replace(style, covered=False, grip_at=0.15)
    cuts = np.linspace(0.0, width, count + 1)
    for i in range(count):
        x = (float(cuts[i]), float(cuts[i + 1]))
        node = filling(
            rng, x[1] - x[0], high - low, {"door": 2.0, "double": 2.0, "lift": 0.5, "open": 0.5}
        )
        parts = casework(rng, upper, x, (depth - deep, depth), (low, high), node, f"wall_{i}_")
        body += parts[0]
        limbs += parts[1]
    return body, limbs


def oven_tower(rng: np.random.Generator) -> Articulation:
    """A tall unit around an oven, doors above and drawers or a door below."""
    width, depth, height = (
        float(rng.uniform(0.55, 0.68)),
        float(rng.uniform(0.5, 0.65)),
        float(rng.uniform(1.6, 2.2)),
    )
    base = float(rng.uniform(0.05, 0.12))
    style = replace(any_style(rng, None, 0.15), reveal=0.0, shelves=2)
    x, y = (0.0, width), (0.0, depth)
    cuts = np.cumsum([base, height * float(rng.uniform(0.25, 0.4)), float(rng.uniform(0.5, 0.62))])
    total = base + height
    levels = [
        (float(cuts[0]), float(cuts[1])),
        (float(cuts[1]), float(cuts[2])),
        (float(cuts[2]), total),
    ]
    door: Node = "double" if rng.random() < 0.4 else "door"
    below: Node = drawers(rng, int(rng.integers(1, 4))) if rng.random() < 0.6 else door
    above: Node = stack((1.0, "flap"), (1.2, door)) if rng.random() < 0.3 else door
    panel = stack((0.82, "flap"), (0.18, "fixed"))
    looks = (style, _oven_style(style), style)
    body: list[Piece] = [Block((0.01, width - 0.01), (0.04, depth), (0.0, base), BLACK)]
    limbs: list[Limb] = []
    for name, node, z, look in zip(
        ("low", "oven", "high"), (below, panel, above), levels, looks, strict=True
    ):
        # What lies above and below is a neighbour: fronts keep half a gap to the level's end.
        mine = replace(look, covered=True, reveal=style.gap / 2, taste=0.0)
        parts = casework(rng, mine, x, y, z, node, f"{name}_")
        body += parts[0]
        limbs += parts[1]
    high, low = levels[1][1], levels[1][1] - 0.18 * (levels[1][1] - levels[1][0])
    front = style.recess if style.inset else -style.behind - style.front
    limbs += knobs(
        rng,
        within(x, style.board),
        (low + high) / 2,
        front,
        high - low - 2.4 * style.board,
        (any_metal(rng), RED),
    )
    return built(body, limbs)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "kitchen": kitchen,
    "oven_tower": oven_tower,
}
