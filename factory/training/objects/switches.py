"""Panels of switches, knobs and sliders."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material
from .looks import BLACK, BRASS, RED, STEEL, WHITE, pick
from .parts import degrees
from .rounds import block, lathe, pipe, ribbon
from .solids import box, cylinder
from .trees import Limb, hinge, slider, tree

PLAY = 0.0008
KINDS = ("rocker", "toggle", "knob", "slider", "button")


def switch_panel(rng: np.random.Generator) -> Articulation:
    """An upright plate or box with one to twelve controls, mostly of one kind."""
    u = rng.uniform
    skin, other = pick(rng, WHITE, BLACK, STEEL, BRASS), pick(rng, WHITE, BLACK, RED, STEEL)
    columns, rows = int(rng.integers(1, 5)), int(rng.choice([1, 1, 2, 3]))
    cell_x, cell_z, deep = u(0.028, 0.05), u(0.05, 0.09), u(0.004, 0.05)
    half, high = columns * cell_x / 2 + u(0.008, 0.025), rows * cell_z + u(0.015, 0.05)
    body = [
        block(
            1,
            (0.0, high),
            (-half, half),
            (0.0, deep),
            skin,
            u(0.001, 0.012),
            bevel=min(0.0015, 0.3 * deep),
        )
    ]
    main, mixed = str(rng.choice(KINDS)), rng.random() < 0.3
    start = (high - rows * cell_z) / 2
    limbs = []
    for row in range(rows):
        for column in range(columns):
            x, z = (column - (columns - 1) / 2) * cell_x, start + (row + 0.5) * cell_z
            kind = str(rng.choice(KINDS)) if mixed else main
            limbs.append(
                _control(
                    rng, kind, f"{kind}_{row}_{column}", x, z, 0.38 * cell_x, 0.38 * cell_z, other
                )
            )
            if rng.random() < 0.3:
                body.append(
                    box(
                        (x - 0.4 * cell_x, x + 0.4 * cell_x),
                        (-0.0004, 0.0),
                        (z - 0.46 * cell_z, z - 0.44 * cell_z),
                        other,
                    )
                )
    return tree(body, limbs)


def _control(
    rng: np.random.Generator,
    kind: str,
    name: str,
    x: float,
    z: float,
    wide: float,
    tall: float,
    skin: Material,
) -> Limb:
    """One control on the plane y = 0 that looks towards -Y, within ``wide`` and ``tall`` of its middle [m]."""
    u = rng.uniform
    if kind == "rocker":
        # A shallow wedge on a pin: its upper half stands out, and goes in.
        tilt = u(0.06, 0.14)
        rise = tall * np.tan(tilt)
        face = -PLAY - rise
        level = np.array([z - 0.95 * tall, z, z + 0.95 * tall])
        out = face - np.array([0.0015, 0.002 + 0.3 * rise, 0.002 + rise])
        solid = ribbon(
            0,
            np.stack([0 * level + face, level], axis=1),
            np.stack([out, level], axis=1),
            (x - wide, x + wide),
            skin,
        )
        return hinge(name, [solid], (-1, 0, 0), (x, face, z), tilt)
    if kind == "toggle":
        radius = min(0.35 * wide, 0.005)
        lean, long = u(0.25, 0.45), u(0.012, 0.025)
        end = (x, -PLAY - 0.003 - long * np.cos(lean), z + long * np.sin(lean))
        lever = pipe(
            [(x, -PLAY - 0.0035, z), end],
            [0.5 * radius, 0.8 * radius],
            STEEL,
            10,
            up=(1.0, 0.0, 0.0),
        )
        pivot = (x, -PLAY - 0.0075, z)
        return hinge(name, [lever], (1, 0, 0), pivot, 2 * lean)
    if kind == "knob":
        radius, out = 0.9 * min(wide, tall), u(0.01, 0.02)
        knob = lathe(1, (x, -PLAY, z), [(0.85 * radius, -out), (radius, 0.0)], skin, 24)
        mark = box(
            (x - 0.001, x + 0.001), (-PLAY - out - 0.001, -PLAY - out), (z, z + 0.8 * radius), BLACK
        )
        return hinge(name, [knob, mark], (0, 1, 0), (x, 0, z), degrees(rng, 180, 320))
    if kind == "slider":
        stem = box(
            (x - 0.001, x + 0.001),
            (-PLAY - 0.005, -PLAY),
            (z - 0.8 * tall, z - 0.8 * tall + 0.004),
            STEEL,
        )
        cap = block(
            1,
            (z - 0.95 * tall, z - 0.65 * tall + 0.004),
            (x - 0.5 * wide, x + 0.5 * wide),
            (-PLAY - 0.013, -PLAY - 0.005),
            skin,
            0.002,
        )
        return slider(name, [stem, cap], (0, 0, 1), (x, 0, z - 0.8 * tall), 1.5 * tall)
    depth, radius = u(0.001, 0.003), 0.8 * min(wide, tall)
    face = -depth - PLAY
    if rng.random() < 0.5:
        button = cylinder(1, (z, x), radius, (face - 0.004, face), skin, 20)
    else:
        button = block(
            1,
            (z - radius, z + radius),
            (x - radius, x + radius),
            (face - 0.004, face),
            skin,
            0.3 * radius,
        )
    return slider(name, [button], (0, 1, 0), (x, 0, z), depth)


MAKERS = {"switch_panel": switch_panel}
