"""What furniture stands on, and what lies on top of it."""

from __future__ import annotations

import numpy as np

from ...mesh import Material
from .looks import BLACK
from .pieces import Block, Piece, frustum, hoop, rod, turned
from .solids import Span


def stood(
    rng: np.random.Generator, kind: str, x: Span, y: Span, height: float, material: Material
) -> list[Piece]:
    """Supports from the ground to z = ``height`` under a body.

    Args:
        rng: draws their sizes.
        kind: ``plinth``, ``feet``, ``tapered``, ``round``, ``turned``, ``sled``, ``castors``,
            ``skirt`` or ``none``.
        x: span of the body [m].
        y: span of the body [m].
        height: of its underside [m].
        material: of the supports.
    """
    if kind == "none" or height <= 0.0:
        return []
    if kind == "plinth":
        back, side = float(rng.choice([0.0, 0.03, 0.06])), float(rng.choice([0.0, 0.0, 0.01]))
        return [Block((x[0] + side, x[1] - side), (y[0] + back, y[1]), (0.0, height), material)]
    size = float(rng.uniform(0.025, 0.06))
    if kind == "skirt":
        return [
            Block((x[0], x[0] + 0.02), y, (0.0, height), material),
            Block((x[1] - 0.02, x[1]), y, (0.0, height), material),
            Block(
                (x[0] + 0.02, x[1] - 0.02), (y[0], y[0] + 0.02), (0.35 * height, height), material
            ),
        ]
    if kind == "sled":
        return _sled(x, y, height, size, material)
    inset = float(rng.uniform(0.0, 0.03)) + size / 2
    return [
        piece
        for cx in (x[0] + inset, x[1] - inset)
        for cy in (y[0] + inset, y[1] - inset)
        for piece in _leg(kind, cx, cy, height, size / 2, material)
    ]


def _leg(
    kind: str, x: float, y: float, height: float, half: float, material: Material
) -> list[Piece]:
    square = ((x - half, x + half), (y - half, y + half))
    if kind == "feet":
        return [Block(*square, (0.0, height), material)]
    if kind == "tapered":
        foot = ((x - 0.6 * half, x + 0.6 * half), (y - 0.6 * half, y + 0.6 * half))
        return [frustum(2, foot, square, (0.0, height), material)]
    if kind == "round":
        return [turned(2, (x, y), [(0.0, 0.6 * half), (height, half)], material, 12)]
    if kind == "turned":
        shares = (
            (0.0, 0.5),
            (0.12, 0.8),
            (0.2, 0.45),
            (0.75, 0.9),
            (0.8, 0.6),
            (0.85, 1.0),
            (1.0, 1.0),
        )
        return [turned(2, (x, y), [(a * height, r * half) for a, r in shares], material, 12)]
    wheel = min(0.03, 0.4 * height)
    fork = [
        Block((x - 0.014, x - 0.01), (y - 0.01, y + 0.01), (wheel, 2 * wheel + 0.004), material),
        Block((x + 0.01, x + 0.014), (y - 0.01, y + 0.01), (wheel, 2 * wheel + 0.004), material),
        Block(
            (x - 0.014, x + 0.014), (y - 0.014, y + 0.014), (2 * wheel + 0.004, height), material
        ),
    ]
    return [
        rod(0, (y, wheel / np.cos(np.pi / 12)), wheel, (x - 0.009, x + 0.009), BLACK, 12),
        *fork,
    ]


def _sled(x: Span, y: Span, height: float, size: float, material: Material) -> list[Piece]:
    pieces: list[Piece] = []
    t = 0.5 * size
    for low in (x[0] + 0.02, x[1] - 0.02 - t):
        across = (low, low + t)
        pieces += [
            Block(across, (y[0] + 0.02, y[1] - 0.02), (0.0, t), material),
            Block(across, (y[0] + 0.02, y[0] + 0.02 + t), (t, height), material),
            Block(across, (y[1] - 0.02 - t, y[1] - 0.02), (t, height), material),
        ]
    return pieces


def countertop(
    x: Span, y: Span, z: float, thickness: float, over: float, material: Material
) -> list[Piece]:
    """A board over a body, standing out at its front and its sides by ``over`` [m]."""
    return [Block((x[0] - over, x[1] + over), (y[0] - over, y[1]), (z, z + thickness), material)]


def cornice(x: Span, y: Span, z: float, material: Material) -> list[Piece]:
    """Two steps around a body's top."""
    return [
        *countertop(x, y, z, 0.03, 0.012, material),
        *countertop(x, y, z + 0.03, 0.025, 0.03, material),
    ]


def sink_top(
    rng: np.random.Generator,
    x: Span,
    y: Span,
    z: float,
    thickness: float,
    looks: tuple[Material, Material],
) -> list[Piece]:
    """A countertop around a basin that hangs in the body under it, and a spout."""
    top = (z, z + thickness)
    middle, half = (x[0] + x[1]) / 2, min(0.25, 0.35 * (x[1] - x[0]))
    bx = (middle - half, middle + half)
    by = (y[0] + 0.08, y[1] - 0.13)
    depth, t = float(rng.uniform(0.1, 0.18)), 0.006
    stone, metal = looks
    pieces: list[Piece] = [
        Block((x[0], bx[0]), y, top, stone),
        Block((bx[1], x[1]), y, top, stone),
        Block(bx, (y[0], by[0]), top, stone),
        Block(bx, (by[1], y[1]), top, stone),
        Block((bx[0] - t, bx[0]), by, (z - depth, z), metal),
        Block((bx[1], bx[1] + t), by, (z - depth, z), metal),
        Block(bx, (by[0] - t, by[0]), (z - depth, z), metal),
        Block(bx, (by[1], by[1] + t), (z - depth, z), metal),
        Block(bx, by, (z - depth - t, z - depth), metal),
    ]
    spout = (middle, by[1] + 0.06)
    high = top[1] + float(rng.uniform(0.15, 0.3))
    pieces.append(rod(2, spout, 0.012, (top[1], high), metal))
    pieces.append(rod(1, (high, middle), 0.01, (spout[1] - 0.16, spout[1] + 0.01), metal))
    return [*pieces, hoop(2, spout, (0.011, 0.025), (top[1], top[1] + 0.008), metal, 16)]


def vessel_top(
    rng: np.random.Generator,
    x: Span,
    y: Span,
    z: float,
    thickness: float,
    looks: tuple[Material, Material],
) -> list[Piece]:
    """A countertop with a round bowl upon it; arguments as in :func:`sink_top`."""
    stone, metal = looks
    at = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2 - 0.02)
    radius, top = min(0.2, 0.38 * min(x[1] - x[0], y[1] - y[0])), z + thickness
    spout = (at[0], at[1] + radius + 0.03)
    high = top + float(rng.uniform(0.15, 0.3))
    return [
        *countertop(x, y, z, thickness, 0.0, stone),
        turned(2, at, [(top, 0.7 * radius), (top + 0.01, 0.75 * radius)], metal, 24),
        hoop(2, at, (0.72 * radius, 0.8 * radius), (top + 0.01, top + 0.06), metal),
        hoop(2, at, (0.8 * radius, radius), (top + 0.05, top + 0.12), metal),
        rod(2, spout, 0.012, (top, high), metal),
        rod(1, (high, at[0]), 0.01, (at[1] + 0.3 * radius, spout[1] + 0.01), metal),
    ]
