"""Tables and desks: drawers under a top, cases beside the knees, leaves that fold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from .casework import casework
from .layouts import Node, drawers, grid, row, stack
from .limbs import Limb, built, turning
from .pieces import Block, Piece, extruded
from .solids import Span
from .stands import stood
from .styles import any_color, any_style, drawn

UNDER = {"tapered": 0.35, "round": 0.25, "feet": 0.2, "turned": 0.2}


def _board(x: Span, y: Span, z: float, rng: np.random.Generator) -> tuple[Piece, float]:
    """A table top under z = ``z``, square or with rounded corners, and the height of its underside [m]."""
    thick, look = float(rng.uniform(0.015, 0.05)), any_color(rng)
    if rng.random() < 0.7:
        return Block(x, y, (z - thick, z), look), z - thick
    radius = float(rng.uniform(0.02, 0.1))
    return extruded(2, rounded(x, y, radius), (z - thick, z), look), z - thick


def rounded(x: Span, y: Span, radius: float) -> list[tuple[float, float]]:
    """A rectangle with round corners, counter-clockwise [m]."""
    turns = ((x[1], y[0], -1), (x[1], y[1], 0), (x[0], y[1], 1), (x[0], y[0], 2))
    return [
        (
            cx + (radius if cx == x[0] else -radius) + radius * float(np.cos(a)),
            cy + (radius if cy == y[0] else -radius) + radius * float(np.sin(a)),
        )
        for cx, cy, quarter in turns
        for a in np.linspace(quarter, quarter + 1, 5) * np.pi / 2
    ]


def table(rng: np.random.Generator) -> Articulation:
    """A table with one to four drawers in its apron; a shelf below at times."""
    width, depth, height = (
        float(rng.uniform(0.4, 1.9)),
        float(rng.uniform(0.35, 0.9)),
        float(rng.uniform(0.4, 0.95)),
    )
    style = replace(any_style(rng, {"slab": 0.7, "bevel": 0.3}, 0.6), shelves=0, covered=True)
    over = float(rng.choice([0.0, 0.01, 0.03, 0.06]))
    top, under = _board((-over, width + over), (-over - 0.03, depth + over), height, rng)
    apron = float(rng.uniform(0.08, 0.2))
    count = int(np.clip(round(width / rng.uniform(0.35, 0.9)), 1, 4))
    parts: list[tuple[float, Node]] = [(1.0, "drawer")] * count
    if count < 3 and rng.random() < 0.3:
        parts = [(1.0, "fixed"), *parts, (1.0, "fixed")]
    node: Node = "drawer" if len(parts) == 1 else ("h", tuple(parts))
    x, y, low = (0.0, width), (0.0, depth), under - apron
    body, limbs = casework(rng, style, x, y, (low, under), node)
    body += stood(rng, drawn(rng, UNDER), x, y, low, style.body)
    if rng.random() < 0.3:
        level = float(rng.uniform(0.15, 0.5)) * low
        body.append(
            Block((0.03, width - 0.03), (0.03, depth - 0.03), (level, level + 0.018), style.body)
        )
    return built([*body, top], limbs)


def desk(rng: np.random.Generator) -> Articulation:
    """A desk: a case on one side or on both, drawers over the knees at times."""
    width, depth, height = (
        float(rng.uniform(0.9, 2.0)),
        float(rng.uniform(0.45, 0.85)),
        float(rng.uniform(0.68, 0.8)),
    )
    style = replace(
        any_style(rng, {"slab": 0.5, "bevel": 0.15, "shaker": 0.2, "raised": 0.15}),
        covered=True,
        crowded=True,
        shelves=2,
    )
    over = float(rng.choice([0.0, 0.01, 0.03]))
    top, under = _board((-over, width + over), (-over - 0.03, depth + over), height, rng)
    side = float(rng.uniform(0.24, 0.4)) * min(width, 1.4)
    base = float(rng.choice([0.0, 0.03, 0.08, 0.2]))
    both, left = bool(rng.random() < 0.45), bool(rng.random() < 0.5)
    body: list[Piece] = [top]
    limbs: list[Limb] = []
    spans = (
        [(0.0, side), (width - side, width)]
        if both
        else [(0.0, side) if left else (width - side, width)]
    )
    for i, x in enumerate(spans):
        node: Node = drawers(rng, int(rng.integers(2, 5)))
        if rng.random() < 0.3:
            node = stack((0.65, "door"), (0.35, "drawer")) if rng.random() < 0.7 else "door"
        parts = casework(rng, style, x, (0.0, depth), (base, under), node, f"side_{i}_")
        body += parts[0]
        limbs += parts[1]
        body += stood(rng, drawn(rng, UNDER | {"plinth": 1.0}), x, (0.0, depth), base, style.body)
    knees = (side, width - side) if both else (side, width) if left else (0.0, width - side)
    if not both:
        post = (width - 0.03, width) if left else (0.0, 0.03)
        if rng.random() < 0.5:
            body.append(Block(post, (0.0, depth), (0.0, under), style.body))
        else:
            body += [
                Block(post, (v, v + 0.03), (0.0, under), style.body) for v in (0.0, depth - 0.03)
            ]
        knees = (knees[0], post[0]) if left else (post[1], knees[1])
    if rng.random() < 0.5:
        high = float(rng.uniform(0.08, 0.13))
        node = grid(rng, int(np.clip(round((knees[1] - knees[0]) / 0.5), 1, 3)), 1)
        inset = replace(style, board=0.012)
        parts = casework(rng, inset, knees, (0.0, depth), (under - high, under), node, "knee_")
        body += parts[0]
        limbs += parts[1]
    if rng.random() < 0.5:
        body.append(
            Block(knees, (depth - 0.03, depth - 0.012), (0.35 * under, under - 0.15), style.body)
        )
    return built(body, limbs)


def folding_table(rng: np.random.Generator) -> Articulation:
    """A table whose side leaves hang and come up."""
    width, depth, height = (
        float(rng.uniform(0.3, 0.8)),
        float(rng.uniform(0.6, 1.2)),
        float(rng.uniform(0.6, 0.8)),
    )
    thick, look = float(rng.uniform(0.015, 0.03)), any_color(rng)
    x, y = (0.0, width), (0.0, depth)
    gap = float(rng.uniform(0.001, 0.004))
    body: list[Piece] = [Block(x, y, (height - thick, height), look)]
    legs = (0.04, width - 0.04)
    body += stood(
        rng, drawn(rng, UNDER), legs, (0.08, depth - 0.08), height - thick, any_color(rng)
    )
    apron = (height - thick - 0.08, height - thick)
    body += [Block((legs[0], legs[1]), (v, v + 0.018), apron, look) for v in (0.08, depth - 0.098)]
    length = float(rng.uniform(0.25, 0.6)) * height
    limbs = []
    sides = (-1.0, 1.0) if rng.random() < 0.7 else (1.0,)
    for i, sign in enumerate(sides):
        # The axis lies at the edge's lower corner, a gap outside: hanging, the leaf's face looks
        # outwards.
        edge, level = (x[1] + gap if sign > 0 else x[0] - gap), height - thick
        span = (edge, edge + thick) if sign > 0 else (edge - thick, edge)
        leaf = Block(span, y, (level - length, level), look)
        limbs.append(
            turning(
                f"leaf_{i}", [leaf], (0.0, -sign, 0.0), (edge, depth / 2, level), float(np.pi / 2)
            )
        )
    return built(body, limbs)


def vanity(rng: np.random.Generator) -> Articulation:
    """A dressing table: drawers under the top, a mirror on it that tilts."""
    width, depth, height = (
        float(rng.uniform(0.7, 1.4)),
        float(rng.uniform(0.35, 0.5)),
        float(rng.uniform(0.68, 0.8)),
    )
    style = replace(
        any_style(rng, {"slab": 0.6, "bevel": 0.2, "raised": 0.2}), covered=True, shelves=0
    )
    top, under = _board((-0.01, width + 0.01), (-0.035, depth + 0.01), height, rng)
    high = float(rng.uniform(0.1, 0.35))
    columns = int(rng.integers(1, 4))
    node = (
        row((1.0, drawers(rng, 2)), (1.2, "drawer"), (1.0, drawers(rng, 2)))
        if high > 0.22
        else grid(rng, columns, 1)
    )
    body, limbs = casework(rng, style, (0.0, width), (0.0, depth), (under - high, under), node)
    body += [
        top,
        *stood(rng, drawn(rng, UNDER), (0.0, width), (0.0, depth), under - high, style.body),
    ]
    half, tall = float(rng.uniform(0.2, 0.4)) * width, float(rng.uniform(0.4, 0.7))
    middle, y, low = width / 2, depth - 0.06, height + 0.04
    for edge in (middle - half - 0.025, middle + half + 0.005):
        body.append(
            Block((edge, edge + 0.02), (y - 0.01, y + 0.02), (height, low + 0.6 * tall), style.body)
        )
    mirror = Block(
        (middle - half, middle + half), (y, y + 0.015), (low, low + tall), any_color(rng)
    )
    axis = (-1.0, 0.0, 0.0) if rng.random() < 0.5 else (1.0, 0.0, 0.0)
    origin = (middle, y + 0.0075, low + 0.5 * tall)
    limbs.append(turning("mirror", [mirror], axis, origin, float(np.radians(rng.integers(15, 31)))))
    return built(body, limbs)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "table": table,
    "desk": desk,
    "folding_table": folding_table,
    "vanity": vanity,
}
