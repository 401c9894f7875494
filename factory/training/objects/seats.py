"""Toilets."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .looks import BLACK, STEEL, WHITE, pick
from .parts import degrees
from .rounds import block, lathe, loft, pipe, ribbon
from .solids import Span, box, cylinder
from .trees import Limb, hinge, slider, tree


def toilet(rng: np.random.Generator) -> Articulation:
    """A bowl with a seat and a lid; most have a cistern with a lever or buttons, some hang on a wall.

    Seat and lid both turn about the pins behind the bowl, each on its own: who lifts the seat lifts
        the lid too.
    """
    u = rng.uniform
    rim, wide, front, back = u(0.36, 0.44), u(0.17, 0.2), u(0.26, 0.36), u(0.15, 0.2)
    skin, other = pick(rng, WHITE, BLACK), pick(rng, WHITE, STEEL)
    body = [_bowl(rng, rim, wide, front, back, skin)]
    pin_y, room = back + u(0.01, 0.03), u(0.06, 0.13)
    seat_thick, lid_thick, gap = u(0.012, 0.025), u(0.01, 0.025), u(0.001, 0.004)
    pin_z = rim + gap + seat_thick / 2
    wall = pin_y + room
    body.append(
        box((-0.6 * wide, 0.6 * wide), (0.8 * back, wall), (rim - u(0.1, 0.3), rim - 0.001), skin)
    )
    seat_z = (rim + gap, rim + gap + seat_thick)
    lid_z = (seat_z[1] + gap, seat_z[1] + gap + lid_thick)
    upper = np.radians(90.0) + np.arcsin(
        np.clip((room - (lid_z[1] - pin_z) - 0.045) / (front + pin_y), -0.1, 0.25)
    )
    limbs = [
        hinge(
            "seat",
            _seat(rng, wide, front, back, pin_y, seat_z, skin),
            (-1, 0, 0),
            (0, pin_y, pin_z),
            upper - 0.05,
        ),
        hinge(
            "lid",
            _lid(rng, wide, front, back, pin_y, lid_z, skin),
            (-1, 0, 0),
            (0, pin_y, pin_z),
            upper,
        ),
    ]
    for x in (-0.11, 0.11):
        body.append(cylinder(0, (pin_y, pin_z), 0.006, (x - 0.012, x + 0.012), other, sides=12))
        body.append(
            box((x - 0.01, x + 0.01), (pin_y + 0.001, wall), (rim - 0.02, pin_z - 0.007), other)
        )
    if rng.random() < 0.85:
        tank, more = _cistern(rng, wall, rim, skin, other)
        body += tank
        limbs += more
    else:
        body.append(box((-0.25, 0.25), (wall + 0.001, wall + 0.02), (0.0, rim + 0.25), other))
    return tree(body, limbs)


def _egg(wide: float, front: float, back: float, inset: float = 0.0, count: int = 32) -> FloatArray:
    """An oval that reaches ``front`` towards -Y and ``back`` towards +Y [m], shape [count, 2]."""
    angle = 2.0 * np.pi * np.arange(count) / count
    reach = np.where(np.sin(angle) < 0.0, front, back) - inset
    return np.stack([(wide - inset) * np.cos(angle), reach * np.sin(angle)], axis=1)


def _bowl(
    rng: np.random.Generator, rim: float, wide: float, front: float, back: float, skin: Material
) -> Mesh:
    """Foot, waist, rim, and down the inside: one surface."""
    u = rng.uniform
    foot = _egg(wide * u(0.5, 0.8), front * u(0.4, 0.7), back * u(0.8, 1.1))
    waist = _egg(wide * u(0.45, 0.65), front * u(0.35, 0.55), back * u(0.8, 1.0))
    floating = rng.random() < 0.2
    top, inside = _egg(wide, front, back), _egg(wide, front, back, u(0.03, 0.045))
    deep = _egg(0.35 * wide, 0.35 * front, 0.3 * back)
    rows = [
        (foot, 0.0),
        (waist, u(0.3, 0.5)),
        (0.97 * top, u(0.7, 0.9)),
        (top, 1.0),
        (inside, 1.0),
        (deep, 0.55),
    ]
    if floating:
        rows = [(deep, 0.3), (0.75 * top, 0.5), *rows[2:]]
    rings = [
        np.column_stack([outline, np.full(len(outline), rim * height)]) for outline, height in rows
    ]
    return loft(rings, skin)


def _seat(
    rng: np.random.Generator,
    wide: float,
    front: float,
    back: float,
    pin: float,
    z: Span,
    skin: Material,
) -> list[Mesh]:
    hole = rng.uniform(0.055, 0.08)
    outer, inner = (
        _egg(wide + 0.005, front + 0.005, back - 0.02),
        _egg(wide, front, back - 0.02, hole),
    )
    if rng.random() < 0.25:
        # Open at its front.
        outer, inner = (np.roll(line, 6, axis=0)[:-3] for line in (outer, inner))
        solids = [ribbon(2, outer, inner, z, skin)]
    else:
        solids = [ribbon(2, outer, inner, z, skin, looped=True)]
    return [*solids, *_tabs(0.06, back - 0.03, pin, z, skin)]


def _lid(
    rng: np.random.Generator,
    wide: float,
    front: float,
    back: float,
    pin: float,
    z: Span,
    skin: Material,
) -> list[Mesh]:
    egg = _egg(wide + 0.005, front + 0.005, back - 0.02)
    rise = z[1] - z[0]
    rings = [(egg, z[0]), (egg, z[0] + 0.6 * rise), (rng.uniform(0.85, 0.97) * egg, z[1])]
    solids = [
        loft([np.column_stack([line, np.full(len(line), height)]) for line, height in rings], skin)
    ]
    return [*solids, *_tabs(0.085, back - 0.03, pin, (z[0], z[0] + 0.5 * rise), skin)]


def _tabs(x: float, start: float, pin: float, z: Span, skin: Material) -> list[Mesh]:
    return [box((s * x - 0.011, s * x + 0.011), (start, pin + 0.004), (z[0] + 0.0002, z[1] - 0.0002), skin)
            for s in (-1, 1)]  # fmt: skip


def _cistern(
    rng: np.random.Generator, wall: float, rim: float, skin: Material, metal: Material
) -> tuple[list[Mesh], list[Limb]]:
    u = rng.uniform
    half, deep, low, high = u(0.17, 0.24), u(0.15, 0.2), rim - u(-0.01, 0.05), rim + u(0.32, 0.42)
    x, y = (-half, half), (wall + 0.0005, wall + deep)
    cap = (high + 0.001, high + u(0.02, 0.04))
    solids = [block(2, x, y, (low, high), skin, u(0.005, 0.05), taper=u(0.85, 1.0))]
    lid = block(2, (x[0] - 0.008, x[1] + 0.008), (y[0] - 0.008, y[1]), cap, skin, 0.02, bevel=0.004)
    style, limbs = rng.choice(["lever", "buttons", "side"]), []
    if rng.random() < 0.3 and style != "buttons":
        limbs.append(slider("cistern_lid", [lid], (0, 0, 1), (0, y[0], cap[0]), u(0.05, 0.15)))
    else:
        solids.append(lid)
    if style == "buttons":
        count, radius, top = int(rng.integers(1, 3)), u(0.016, 0.024), cap[1]
        middle = (y[0] + y[1]) / 2
        solids.append(
            lathe(2, (0, middle, top), [(0.06, 0.0002), (0.06, 0.0015)], metal, stretch=(1.0, 0.6))
        )
        for i in range(count):
            x_i = (i - (count - 1) / 2) * 0.052
            button = lathe(
                2,
                (x_i, middle, top + 0.0045),
                [(radius, 0), (radius, 0.004), (0.9 * radius, 0.006)],
                metal,
            )
            # The button dips into a well that nobody sees; it stops above the plate.
            limbs.append(slider(f"button_{i}", [button], (0, 0, -1), (x_i, middle, top), 0.002))
        return solids, limbs
    z, length, side = high - u(0.04, 0.09), u(0.06, 0.11), float(rng.choice([-1.0, 1.0]))
    if style == "lever":
        pivot, axis = (side * (half - u(0.04, 0.06)), y[0] - 0.008, z), (0.0, side, 0.0)
        start = np.array([pivot[0], y[0] - 0.022, z])
        stem = cylinder(1, (z, pivot[0]), 0.009, (y[0] - 0.028, y[0] - 0.006), metal, sides=14)
        end = start - [side * length, 0.0, 0.01]
    else:
        pivot, axis = (side * (half + 0.008), (y[0] + y[1]) / 2, z), (-side, 0.0, 0.0)
        spans = sorted((pivot[0] - side * 0.002, pivot[0] + side * 0.02))
        stem = cylinder(0, (pivot[1], z), 0.009, (spans[0], spans[1]), metal, sides=14)
        start = np.array([pivot[0] + side * 0.012, pivot[1], z])
        end = start - [0.0, length, 0.01]
    arm = pipe([start, (start + end) / 2, end], [0.006, 0.006, 0.008], metal, sides=8)
    return solids, [*limbs, hinge("lever", [stem, arm], axis, pivot, degrees(rng, 25, 50))]


MAKERS = {"toilet": toilet}
