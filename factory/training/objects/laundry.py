"""Washing machines and dryers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...mesh import Material
from .grips import any_grip, button, dial, gripped
from .limbs import Limb, built, sliding, swinging, turning
from .looks import BLACK, GLASS, RED, STEEL, WHITE, pick
from .pieces import Block, Piece, holed, hoop, rod, turned
from .solids import Span
from .stands import stood
from .styles import any_metal


def front_loader(rng: np.random.Generator) -> Articulation:
    """A round or square door before a drum; a soap drawer, knobs and buttons above it."""
    width, depth, height = (
        float(rng.uniform(0.45, 0.7)),
        float(rng.uniform(0.4, 0.7)),
        float(rng.uniform(0.7, 1.0)),
    )
    base = float(rng.choice([0.0, 0.015, 0.03]))
    skin, hollow = pick(rng, WHITE, WHITE, STEEL, BLACK), bool(rng.random() < 0.72)
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    radius = float(rng.uniform(0.26, 0.36)) * width
    split = z[1] - float(rng.uniform(0.1, 0.16))
    radius = min(radius, 0.48 * (split - z[0] - 0.09))
    at = (width / 2, float(rng.uniform(z[0] + radius + 0.06, split - radius - 0.03)))
    body = stood(rng, "feet", x, y, base, BLACK)
    limbs = [_porthole(rng, at, radius)]
    if hollow:
        body += _tub(x, y, z, at, radius, skin)
        drum = _drum(at, 0.95 * radius, (0.07, depth - 0.05))
        if rng.random() < 0.3:
            limbs.append(turning("drum", drum, (0.0, 1.0, 0.0), (at[0], 0.07, at[1]), 6.2))
        else:
            body += drum
    else:
        body.append(Block(x, y, z, skin))
    return built(body, limbs + _controls(rng, x, (split, z[1])))


def _tub(
    x: Span, y: Span, z: Span, at: tuple[float, float], radius: float, look: Material
) -> list[Piece]:
    t = 0.012
    inner = (x[0] + t, x[1] - t)
    return [
        holed(x, z, at, 0.9 * radius, (0.0, 0.02), look),
        Block((x[0], inner[0]), (0.02, y[1]), z, look),
        Block((inner[1], x[1]), (0.02, y[1]), z, look),
        Block(inner, (0.02, y[1]), (z[0], z[0] + t), look),
        Block(inner, (0.02, y[1]), (z[1] - t, z[1]), look),
        Block(inner, (y[1] - t, y[1]), (z[0] + t, z[1] - t), look),
    ]


def _drum(at: tuple[float, float], radius: float, y: Span) -> list[Piece]:
    center = (at[1], at[0])
    pieces: list[Piece] = [
        hoop(1, center, (radius - 0.004, radius), y, STEEL, 28),
        rod(1, center, radius - 0.002, (y[1] - 0.004, y[1]), STEEL, 28),
    ]
    for k in range(3):
        angle = 2.0 * np.pi * k / 3.0
        px, pz = at[0] + 0.85 * radius * np.cos(angle), at[1] + 0.85 * radius * np.sin(angle)
        pieces.append(rod(1, (pz, px), 0.08 * radius, (y[0] + 0.01, y[1] - 0.01), STEEL, 8))
    return pieces


def _porthole(rng: np.random.Generator, at: tuple[float, float], radius: float) -> Limb:
    look = pick(rng, WHITE, STEEL, BLACK)
    t, center = float(rng.uniform(0.02, 0.05)), (at[1], at[0])
    gap = float(rng.uniform(0.0005, 0.003))
    face, back = -gap - t, -gap
    side = "left" if rng.random() < 0.7 else "right"
    x, z = (at[0] - radius, at[0] + radius), (at[1] - radius, at[1] + radius)
    pieces: list[Piece]
    if rng.random() < 0.75:
        width = float(rng.uniform(0.12, 0.3)) * radius
        bowl = turned(
            1,
            center,
            [(face + 0.3 * t, 0.55 * radius), (face + 0.6 * t, radius - width + 0.004)],
            GLASS,
            28,
        )
        pieces = [hoop(1, center, (radius - width, radius), (face, back), look, 32), bowl]
    else:
        pieces = [
            Block(x, (face, back), z, look),
            rod(1, center, 0.7 * radius, (face - 0.002, face), GLASS, 28),
        ]
    grip = replace(
        any_grip(rng, any_metal(rng), ("bar", "bow", "recess", "rail")), length=0.35 * radius
    )
    sign = 1.0 if side == "left" else -1.0
    pieces += gripped(grip, at[0] + 0.92 * sign * radius, at[1], face, True, radius)
    setback = float(rng.choice([0.0, 0.5, 1.0])) * t
    # Behind its face the axis swings the hinge edge into the front beside it.
    upper = rng.integers(85, 165) if setback == 0.0 else rng.integers(80, 91)
    return swinging("door", pieces, x, z, face + setback, side, float(np.radians(upper)))


def _controls(rng: np.random.Generator, x: Span, z: Span) -> list[Limb]:
    """A soap drawer at one end, a knob and buttons along the rest; a display stays where it is."""
    limbs: list[Limb] = []
    level, tall, width = (z[0] + z[1]) / 2, z[1] - z[0], x[1] - x[0]
    left = bool(rng.random() < 0.8)
    if rng.random() < 0.7:
        span = (x[0] + 0.02, x[0] + 0.32 * width) if left else (x[1] - 0.32 * width, x[1] - 0.02)
        high = (level - 0.32 * tall, level + 0.32 * tall)
        pieces: list[Piece] = [Block(span, (-0.018, -0.001), high, pick(rng, WHITE, STEEL, BLACK))]
        pieces.append(
            Block(
                (span[0] + 0.02, span[1] - 0.02),
                (-0.026, -0.018),
                (high[1] - 0.012, high[1] - 0.006),
                BLACK,
            )
        )
        limbs.append(sliding("drawer", pieces, (0.0, -1.0, 0.0), (sum(span) / 2, 0.0, level), 0.2))
    places = np.linspace(0.42, 0.92, int(rng.integers(3, 9)))
    places = places if left else 1.0 - places
    radius = min(0.3 * tall, 0.035)
    limbs.append(
        dial(
            rng, "knob", float(x[0] + places[0] * width), level, 0.0, radius, (any_metal(rng), RED)
        )
    )
    if rng.random() < 0.6:
        half = 0.3 * 0.5 * width / len(places)
        for i, share in enumerate(places[2:]):
            at = x[0] + float(share) * width
            limbs.append(
                button(
                    f"button_{i}",
                    (at - half, at + half),
                    (level - half, level + half),
                    0.0,
                    0.004,
                    WHITE,
                    True,
                )
            )
    return limbs


def top_loader(rng: np.random.Generator) -> Articulation:
    """A lid that lifts, before a console with knobs."""
    width, depth, height = (
        float(rng.uniform(0.45, 0.72)),
        float(rng.uniform(0.5, 0.7)),
        float(rng.uniform(0.8, 1.0)),
    )
    skin, t = pick(rng, WHITE, WHITE, STEEL), 0.02
    x, y = (0.0, width), (0.0, depth)
    console = float(rng.uniform(0.1, 0.18))
    tall = float(rng.uniform(0.08, 0.2))
    mouth_x, mouth_y = (0.05, width - 0.05), (0.05, depth - console - 0.06)
    body: list[Piece] = [
        Block((0.0, mouth_x[0]), y, (height - t, height), skin),
        Block((mouth_x[1], width), y, (height - t, height), skin),
        Block(mouth_x, (0.0, mouth_y[0]), (height - t, height), skin),
        Block(mouth_x, (mouth_y[1], depth), (height - t, height), skin),
        Block((0.0, t), y, (0.0, height - t), skin),
        Block((width - t, width), y, (0.0, height - t), skin),
        Block((t, width - t), (0.0, t), (0.0, height - t), skin),
        Block((t, width - t), (depth - t, depth), (0.0, height - t), skin),
        Block((t, width - t), (t, depth - t), (0.0, t), skin),
        Block(x, (depth - console, depth), (height, height + tall), skin),
    ]
    middle = (sum(mouth_x) / 2, sum(mouth_y) / 2)
    radius = 0.48 * min(mouth_x[1] - mouth_x[0], mouth_y[1] - mouth_y[0])
    body.append(
        hoop(2, middle, (radius - 0.005, radius), (0.3 * height, height - t - 0.01), STEEL, 28)
    )
    body.append(rod(2, middle, radius - 0.002, (0.3 * height - 0.01, 0.3 * height), STEEL, 28))
    thick, gap = float(rng.uniform(0.012, 0.03)), 0.002
    lid_y = (mouth_y[0] - 0.03, mouth_y[1] + 0.01)
    lid_x = (mouth_x[0] - 0.03, mouth_x[1] + 0.03)
    low = height + gap
    lid: list[Piece] = [Block(lid_x, lid_y, (low, low + thick), pick(rng, skin, GLASS))]
    lid.append(
        Block(
            (middle[0] - 0.06, middle[0] + 0.06),
            (lid_y[0] - 0.012, lid_y[0]),
            (low, low + 0.01),
            skin,
        )
    )
    upper = float(np.radians(rng.integers(70, 89)))
    limbs = [turning("lid", lid, (-1.0, 0.0, 0.0), (middle[0], lid_y[1], low + thick), upper)]
    count = int(rng.integers(1, 5))
    for i, v in enumerate(np.linspace(0.15, 0.85, count + 2)[1:-1]):
        knob = dial(
            rng,
            f"knob_{i}",
            float(v) * width,
            height + 0.65 * tall,
            depth - console,
            0.025,
            (STEEL, RED),
        )
        limbs.append(knob)
    return built(body, limbs)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "front_loader": front_loader,
    "top_loader": top_loader,
}
