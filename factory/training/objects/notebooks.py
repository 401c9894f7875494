"""Notebook computers of more shapes, and monitors."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .looks import BLACK, BLUE, GLASS, RED, STEEL, WHITE, pick
from .parts import degrees
from .rounds import block, ribbon, turned
from .solids import Span, box, cylinder
from .trees import Limb, hinge, tree

PLAY = 0.0008


def notebook(rng: np.random.Generator) -> Articulation:
    """A flat or wedge-shaped base, a lid on one, two or three barrels; from closed to flat, or all the way round.

    About half stand open at rest, as most models do.
    """
    u = rng.uniform
    half_x, deep, thick, lid_thick = u(0.12, 0.2), u(0.17, 0.27), u(0.006, 0.028), u(0.003, 0.009)
    skin = pick(rng, STEEL, BLACK, BLUE, WHITE, RED)
    radius, corner = u(0.003, 0.006), u(0.001, 0.02)
    nose = u(0.25, 1.0) * thick if rng.random() < 0.5 else thick
    top = max(thick, 2 * radius)
    y, x = (-deep, 0.0), (-half_x, half_x)
    rubber = 0.0015 if rng.random() < 0.6 else 0.0
    base_low = rubber + top - thick
    pin_y, pin_z = radius + PLAY, rubber + top + PLAY / 2
    body: list[Mesh] = []
    if nose < thick - 0.002:
        rows = np.array(
            [
                (y[0], rubber + top - nose, rubber + top),
                (0.6 * y[0], base_low, rubber + top),
                (0.0, base_low, rubber + top),
            ]
        )
        body.append(ribbon(0, rows[:, [0, 1]], rows[:, [0, 2]], x, skin))
    else:
        body.append(
            block(2, x, y, (base_low, rubber + top), skin, corner, bevel=min(0.001, 0.2 * thick))
        )
    if rubber:
        body += [box((cx - 0.012, cx + 0.012), (cy - 0.004, cy + 0.004), (0.0, base_low + 0.0005), BLACK)
                 for cx in (-0.8 * half_x, 0.8 * half_x) for cy in (-0.03, 0.5 * y[0])]  # fmt: skip
    body += _deck(rng, half_x, deep, rubber + top)
    level = rubber + top + 0.002
    lid = [
        block(2, x, y, (level, level + lid_thick), skin, corner, bevel=min(0.001, 0.2 * lid_thick))
    ]
    frame = u(0.003, 0.018)
    lid.append(
        box(
            (x[0] + frame, x[1] - frame),
            (y[0] + frame, y[1] - 1.5 * frame - 0.004),
            (level - 0.0006, level),
            GLASS,
        )
    )
    moves, holds = _barrels(rng, half_x, radius, pin_y, pin_z, level + 0.6 * lid_thick, skin)
    upper = degrees(rng, 115, 175)
    limb = hinge("lid", [*lid, *moves], (-1, 0, 0), (0, pin_y, pin_z), upper)
    if rng.random() < 0.5:
        value = float(np.radians(u(85, 115)))
        limb = Limb(
            "lid",
            tuple(turned(limb.solids, limb.axis, value, limb.origin)),
            limb.kind,
            limb.axis,
            limb.origin,
            upper - value,
            -value,
        )
    return tree([*body, *holds], [limb])


def _barrels(
    rng: np.random.Generator,
    half: float,
    radius: float,
    y: float,
    z: float,
    lid_z: float,
    skin: Material,
) -> tuple[list[Mesh], list[Mesh]]:
    """Knuckles that turn with the lid and knuckles that stay."""
    material = pick(rng, skin, BLACK)
    if rng.random() < 0.4:
        spans: list[Span] = [(-0.7 * half, 0.7 * half)]
    else:
        at, long = rng.uniform(0.45, 0.75) * half, rng.uniform(0.1, 0.2) * half
        spans = [(-at - long, -at + long), (at - long, at + long)]
    moves: list[Mesh] = []
    holds: list[Mesh] = []
    for low, high in spans:
        moves.append(cylinder(0, (y, z), radius, (low, high), material, 14))
        moves.append(
            box((low + 0.001, high - 0.001), (-0.004, y), (z + 0.0012 + PLAY, lid_z), material)
        )
        stub = min(0.02, 0.2 * half)
        for end in (low - PLAY - stub, high + PLAY):
            holds.append(cylinder(0, (y, z), 0.9 * radius, (end, end + stub), material, 12))
            holds.append(
                box(
                    (end + 0.0005, end + stub - 0.0005),
                    (-0.003, y),
                    (z - 0.9 * radius, z - 0.0015),
                    material,
                )
            )
    return moves, holds


def _deck(rng: np.random.Generator, half: float, deep: float, top: float) -> list[Mesh]:
    """Keys one by one, in rows, as one plate, or none; often a touch pad."""
    u = rng.uniform
    style = str(rng.choice(["keys", "rows", "plate", "none"]))
    proud = u(0.0003, 0.001)
    solids: list[Mesh] = []
    far, near = -u(0.02, 0.04), -u(0.5, 0.62) * deep
    rows = int(rng.integers(4, 7))
    pitch = (far - near) / rows
    if style == "plate":
        solids.append(
            block(2, (-0.88 * half, 0.88 * half), (near, far), (top, top + proud), BLACK, 0.004)
        )
    elif style != "none":
        columns = int(rng.integers(8, 15)) if style == "keys" else 1
        for row in range(rows):
            v = near + row * pitch
            spread = [3, 1, 1, 5, 1, 2] if row == 0 and columns > 10 else [1] * columns
            at = -0.88 * half
            unit = 1.76 * half / sum(spread)
            for share in spread:
                solids.append(
                    box(
                        (at, at + share * unit - 0.002),
                        (v, v + pitch - 0.002),
                        (top, top + proud),
                        BLACK,
                    )
                )
                at += share * unit
    if rng.random() < 0.8:
        pad, edge = u(0.2, 0.45) * half, u(0.006, 0.02)
        solids.append(box((-pad, pad), (-deep + edge, near - edge), (top, top + 0.0003), GLASS))
    return solids


def monitor(rng: np.random.Generator) -> Articulation:
    """A screen that tilts at the top of a stem on a foot."""
    u = rng.uniform
    skin = pick(rng, BLACK, STEEL, WHITE)
    half, high, thick = u(0.1, 0.32), u(0.08, 0.19), u(0.007, 0.03)
    foot_x, foot_y, rise = u(0.4, 0.7) * half, u(0.06, 0.11), u(0.06, 0.2)
    body: list[Mesh] = [
        block(
            2, (-foot_x, foot_x), (-foot_y, foot_y), (0.0, 0.012), skin, u(0.005, 0.05), bevel=0.002
        )
    ]
    post = u(0.012, 0.03)
    top = 0.012 + rise + high
    body.append(box((-post, post), (0.02, 0.035), (0.0115, top - 0.013), skin))
    y = (-0.012 - thick, -0.012)
    panel = [
        block(1, (top - high, top + high), (-half, half), y, skin, u(0.002, 0.02), bevel=0.002)
    ]
    frame = u(0.003, 0.015)
    panel.append(
        box(
            (-half + frame, half - frame),
            (y[0] - 0.0005, y[0]),
            (top - high + frame, top + high - frame),
            GLASS,
        )
    )
    panel.append(box((-0.03, 0.03), (-0.0121, 0.002), (top - 0.03, top + 0.03), skin))
    knuckle = [cylinder(0, (0.027, top), 0.01, (-0.012, 0.012), skin, 14)]
    panel += [*knuckle, box((-0.008, 0.008), (0.0, 0.027), (top - 0.006, top + 0.006), skin)]
    body += [
        box(
            (s * 0.016 - 0.003, s * 0.016 + 0.003), (0.02, 0.034), (top - 0.0135, top + 0.008), skin
        )
        for s in (-1, 1)
    ]
    tilt = degrees(rng, 10, 25)
    limbs = [hinge("screen", panel, (-1, 0, 0), (0, 0.027, top), tilt, -degrees(rng, 3, 10))]
    return tree(body, limbs)


MAKERS = {"notebook": notebook, "monitor": monitor}
