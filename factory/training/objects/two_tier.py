"""Furniture of a lower case and something else upon it: hutches, secretaires, beds with drawers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from .casework import casework
from .layouts import Node, drawers, filling, grid, stack
from .limbs import built
from .looks import WHITE
from .pieces import Block
from .stands import cornice, stood
from .storage import LEGS
from .styles import any_color, any_style, drawn

MIX = {"double": 1.5, "door": 1.0, "drawers": 1.0, "open": 0.2}


def hutch(rng: np.random.Generator) -> Articulation:
    """A deep case below, a shallow one upon it, a gap between them at times."""
    width, depth = float(rng.uniform(0.7, 1.6)), float(rng.uniform(0.38, 0.55))
    low, high = float(rng.uniform(0.6, 0.9)), float(rng.uniform(0.7, 1.2))
    base = float(rng.uniform(0.03, 0.15))
    style = replace(any_style(rng), covered=True, reveal=0.0)
    columns = max(1, round(width / float(rng.uniform(0.4, 0.7))))
    below: Node = (
        "h",
        tuple(
            (1.0, filling(rng, width / columns, low, MIX | {"open": 0.0})) for _ in range(columns)
        ),
    )
    if rng.random() < 0.5:
        below = stack((0.75, below), (0.25, grid(rng, columns, 1)))
    x, y = (0.0, width), (0.0, depth)
    body, limbs = casework(rng, style, x, y, (base, base + low), below, "low_")
    front = 0.0 if style.inset else style.behind + style.front
    top = base + low
    body.append(
        Block((-0.01, width + 0.01), (-front - 0.01, depth), (top, top + 0.025), any_color(rng))
    )
    body += stood(rng, drawn(rng, LEGS), x, y, base, style.body)
    start = top + 0.025
    if rng.random() < 0.4:
        rise = float(rng.uniform(0.1, 0.35))
        body += [
            Block((edge, edge + 0.02), (depth - 0.25, depth), (start, start + rise), style.body)
            for edge in (0.0, width - 0.02)
        ]
        body.append(
            Block((0.02, width - 0.02), (depth - 0.015, depth), (start, start + rise), style.body)
        )
        start += rise
    upper = replace(
        style,
        panel=drawn(rng, {"glazed": 0.4, "mullion": 0.25, style.panel: 0.35}),
        hollow=True,
        grip_at=0.3,
    )
    upper = replace(upper, upper=upper.panel, covered=False)
    above: Node = (
        "h",
        tuple(
            (1.0, filling(rng, width / columns, high, {"double": 1.0, "door": 1.5, "open": 0.7}))
            for _ in range(columns)
        ),
    )
    # The lower top stands out before the upper fronts: they keep a gap to it.
    span = (start + 0.003, start + 0.003 + high)
    body.append(Block((0.01, width - 0.01), (depth - 0.2, depth), (start, span[0]), style.body))
    parts = casework(
        rng, upper, x, (depth - float(rng.uniform(0.25, 0.33)), depth), span, above, "high_"
    )
    body += parts[0]
    limbs += parts[1]
    if rng.random() < 0.5:
        body += cornice(x, (depth - 0.36, depth), span[1], style.body)
    return built(body, limbs)


def secretaire(rng: np.random.Generator) -> Articulation:
    """A writing cabinet: drawers, and over them a flap to write on."""
    width, depth, height = (
        float(rng.uniform(0.6, 1.0)),
        float(rng.uniform(0.3, 0.5)),
        float(rng.uniform(0.95, 1.5)),
    )
    base = float(rng.uniform(0.03, 0.3))
    style = replace(any_style(rng), covered=True)
    node = stack(
        (float(rng.uniform(0.8, 1.4)), drawers(rng, int(rng.integers(2, 4)))), (1.0, "flap")
    )
    if rng.random() < 0.4:
        node = stack((0.8, node), (0.2, grid(rng, int(rng.integers(1, 3)), 1)))
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, drawn(rng, LEGS), x, y, base, style.body)
    body.append(Block((-0.015, width + 0.015), (-0.04, depth), (z[1], z[1] + 0.02), any_color(rng)))
    return built(body, limbs)


def storage_bed(rng: np.random.Generator) -> Articulation:
    """A bed seen from its long side, drawers under the mattress, a headboard at one end."""
    length, width = float(rng.uniform(1.7, 2.1)), float(rng.uniform(0.8, 1.6))
    base, low = float(rng.uniform(0.02, 0.08)), float(rng.uniform(0.2, 0.35))
    style = replace(any_style(rng), reveal=0.0, covered=False)
    count = int(rng.integers(1, 4))
    parts: list[tuple[float, Node]] = [(1.0, "drawer")] * count
    if rng.random() < 0.4:
        parts.append((1.0, "fixed"))
    node: Node = ("h", tuple(parts)) if len(parts) > 1 else "drawer"
    x, y, z = (0.0, length), (0.0, width), (base, base + low)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, drawn(rng, {"feet": 0.5, "plinth": 0.5}), x, y, base, style.body)
    soft = float(rng.uniform(0.12, 0.28))
    body.append(Block((0.02, length - 0.02), (0.02, width - 0.02), (z[1], z[1] + soft), WHITE))
    end = (-0.05, 0.0) if rng.random() < 0.5 else (length, length + 0.05)
    tall = z[1] + soft + float(rng.uniform(0.1, 0.6))
    body.append(Block(end, (0.0, width), (0.0, tall), style.body))
    pillow = (0.05, 0.45) if end[0] < 0 else (length - 0.45, length - 0.05)
    body.append(Block(pillow, (0.1, width - 0.1), (z[1] + soft, z[1] + soft + 0.09), WHITE))
    return built(body, limbs)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "hutch": hutch,
    "secretaire": secretaire,
    "storage_bed": storage_bed,
}
