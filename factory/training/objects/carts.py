"""Trolleys, and whatever else stands on wheels."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .castors import castor, disc
from .looks import BLACK, BLUE, GREEN, OAK, RED, STEEL, WHITE, pick
from .parts import degrees
from .rounds import block, lathe, loft, pipe
from .solids import Span, box, cylinder
from .trees import Limb, hinge, tree, wheel

#: Between a wheel and the frame [m].
PLAY = 0.0012


def cart(rng: np.random.Generator) -> Articulation:
    """A platform, shelves or a basket on four wheels: on fixed axles, on castors, or castors in front only."""
    u = rng.uniform
    skin, metal = pick(rng, STEEL, BLUE, RED, OAK, WHITE, GREEN), pick(rng, STEEL, BLACK)
    half_x, half_y = u(0.18, 0.32), u(0.28, 0.5)
    radius, wide = u(0.03, 0.075), u(0.015, 0.035)
    deck = 2 * radius + u(0.015, 0.04)
    kind = str(rng.choice(["platform", "shelves", "basket"]))
    x, y = (-half_x, half_x), (-half_y, half_y)
    body: list[Mesh] = []
    if kind == "platform":
        body += _platform(rng, x, y, deck, skin, metal)
    elif kind == "shelves":
        body += _shelves(rng, x, y, deck, skin, metal)
    else:
        body += _basket(rng, x, y, deck, skin, metal)
    front, back = (
        ("castor", "axle") if rng.random() < 0.5 else (str(rng.choice(["castor", "axle"])),) * 2
    )
    limbs: list[Limb] = []
    heading = u(0.0, 2 * np.pi) if rng.random() < 0.3 else 0.0
    for row, style, along in (("front", front, y[0]), ("rear", back, y[1])):
        inset = 1.1 * radius
        wy = along + (inset if along < 0 else -inset)
        for name, side in (("left", -1.0), ("right", 1.0)):
            wx = side * (half_x - 0.6 * radius - wide)
            if style == "castor":
                limbs += castor(f"{row}_{name}", wx, wy, deck, radius, wide, heading, BLACK, metal)
            else:
                limbs.append(_fixed(f"{row}_{name}_wheel", wx, wy, radius, wide, metal))
                body += _bracket(wx, wy, radius, wide, deck, metal)
    return tree(body, limbs)


def _fixed(name: str, x: float, y: float, radius: float, wide: float, metal: Material) -> Limb:
    return wheel(name, disc((x, y, radius), radius, wide, BLACK, metal), (1, 0, 0), (x, y, radius))


def _bracket(
    x: float, y: float, radius: float, wide: float, deck: float, metal: Material
) -> list[Mesh]:
    reach = wide / 2 + 0.0008 + PLAY
    return [
        box(
            (low, low + 0.003),
            (y - 0.3 * radius, y + 0.3 * radius),
            (0.7 * radius, deck + 0.001),
            metal,
        )
        for low in (x - reach - 0.003, x + reach)
    ]


def _push_bar(
    rng: np.random.Generator, half_x: float, y: float, low: float, high: float, metal: Material
) -> Mesh:
    """An inverted U at the back, to push at."""
    h, r, lean = half_x - 0.02, rng.uniform(0.01, 0.016), rng.uniform(0.0, 0.12)
    path = [
        (-h, y, low),
        (-h, y + 0.8 * lean, high - 0.06),
        (-h + 0.05, y + lean, high),
        (h - 0.05, y + lean, high),
        (h, y + 0.8 * lean, high - 0.06),
        (h, y, low),
    ]
    return pipe(path, r, metal, 10, up=(0.0, 1.0, 0.0))


def _platform(
    rng: np.random.Generator, x: Span, y: Span, deck: float, skin: Material, metal: Material
) -> list[Mesh]:
    thick = rng.uniform(0.015, 0.04)
    solids = [block(2, x, y, (deck, deck + thick), skin, rng.uniform(0.003, 0.06), bevel=0.003)]
    solids.append(
        _push_bar(
            rng, x[1], y[1] - 0.03, deck + thick - 0.005, deck + rng.uniform(0.7, 0.95), metal
        )
    )
    return solids


def _shelves(
    rng: np.random.Generator, x: Span, y: Span, deck: float, skin: Material, metal: Material
) -> list[Mesh]:
    u = rng.uniform
    count, rise, r = int(rng.integers(2, 5)), u(0.22, 0.34), u(0.008, 0.014)
    levels = [deck + i * rise for i in range(count)]
    lip = u(0.0, 0.05)
    solids: list[Mesh] = []
    for level in levels:
        solids.append(block(2, x, y, (level, level + 0.012), skin, 0.02))
        if lip > 0.02:
            solids += [
                box(
                    (s * (x[1] - 0.001) - 0.003, s * (x[1] - 0.001) + 0.003),
                    y,
                    (level + 0.011, level + lip),
                    skin,
                )
                for s in (-1, 1)
            ]
            solids += [
                box(
                    (x[0], x[1]),
                    (s * y[1] - 0.003, s * y[1] + 0.003),
                    (level + 0.0112, level + lip - 0.0002),
                    skin,
                )
                for s in (-1, 1)
            ]
    top = levels[-1] + 0.012 + u(0.0, 0.05)
    for cx, cy in ((sx * (x[1] - 0.02), sy * (y[1] - 0.02)) for sx in (-1, 1) for sy in (-1, 1)):
        solids.append(cylinder(2, (cx, cy), r, (deck + 0.002, top), metal, 12))
    if rng.random() < 0.6:
        solids.append(
            _push_bar(rng, x[1], y[1] - 0.03, levels[-1], levels[-1] + u(0.1, 0.2), metal)
        )
    return solids


def _basket(
    rng: np.random.Generator, x: Span, y: Span, deck: float, skin: Material, metal: Material
) -> list[Mesh]:
    """A cage of wires on a frame."""
    u = rng.uniform
    low, high, wire = deck + u(0.15, 0.4), deck + u(0.55, 0.8), 0.003
    solids = [block(2, x, y, (deck, deck + 0.015), metal, 0.03)]
    for cx, cy in ((sx * (x[1] - 0.03), sy * (y[1] - 0.03)) for sx in (-1, 1) for sy in (-1, 1)):
        solids.append(cylinder(2, (cx, cy), 0.01, (deck + 0.014, high), metal, 10))
    if rng.random() < 0.4:
        wall = 0.005
        solids += [box((s * x[1] - wall, s * x[1] + wall), y, (low, high), skin) for s in (-1, 1)]
        solids += [
            box(x, (s * y[1] - wall, s * y[1] + wall), (low + 0.0003, high - 0.0003), skin)
            for s in (-1, 1)
        ]
        solids.append(box(x, y, (low + 0.0005, low + 0.006), skin))
    else:
        for z in np.linspace(low, high, 4):
            ring = [(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)]
            solids.append(pipe(ring, wire * (2 if z == high else 1), metal, 6, looped=True))
        for v in np.linspace(x[0], x[1], 6)[1:-1]:
            solids += [
                box(
                    (v - 0.002, v + 0.002), (s * y[1] - 0.002, s * y[1] + 0.002), (low, high), metal
                )
                for s in (-1, 1)
            ]
            solids.append(box((v - 0.002, v + 0.002), y, (low - 0.002, low + 0.002), metal))
        for v in np.linspace(y[0], y[1], 7)[1:-1]:
            solids += [
                box(
                    (s * x[1] - 0.002, s * x[1] + 0.002), (v - 0.002, v + 0.002), (low, high), metal
                )
                for s in (-1, 1)
            ]
    solids.append(_push_bar(rng, x[1], y[1] - 0.01, high - 0.02, high + u(0.08, 0.2), metal))
    return solids


def wheelbarrow(rng: np.random.Generator) -> Articulation:
    """A tray between two shafts, two legs behind, one wheel in front."""
    u = rng.uniform
    skin, metal = pick(rng, GREEN, BLUE, RED, STEEL), pick(rng, STEEL, BLACK)
    radius, wide, half = u(0.15, 0.2), u(0.06, 0.09), u(0.2, 0.28)
    long, level = u(0.65, 0.8), 2 * radius + 0.03
    middle = (0.0, 0.5 * long, 0.0)
    rings = []
    for share, z in ((0.55, 0.0), (1.0, 0.25), (0.985, 0.25), (0.54, 0.006)):
        hx, hy = half * share, 0.55 * long * share
        rings.append(
            [
                (-hx, middle[1] - hy, level + z),
                (hx, middle[1] - hy, level + z),
                (hx, middle[1] + hy, level + z),
                (-hx, middle[1] + hy, level + z),
            ]
        )
    body = [loft(rings, skin)]
    gap = wide / 2 + 0.004
    for side in (-1.0, 1.0):
        shaft = [
            (side * gap, -0.2 * long, radius),
            (side * 0.45 * half, 0.2 * long, level - 0.012),
            (side * 0.6 * half, long, level - 0.01),
            (side * half, 1.7 * long, level + 0.12),
        ]
        body.append(pipe(shaft, 0.012, metal, 8))
        leg = [
            (side * 0.62 * half, 0.95 * long, level - 0.015),
            (side * 0.72 * half, 0.85 * long, 0.0),
            (side * 0.72 * half, 0.7 * long, 0.004),
        ]
        body.append(pipe(leg, 0.011, metal, 8, up=(1.0, 0.0, 0.0)))
    wheel_y = -0.2 * long
    half_gap = gap - 0.012 - PLAY
    solids = disc((0.0, wheel_y, radius + 0.0), radius * 0.98, 2 * half_gap - 0.003, BLACK, metal)
    return tree(body, [wheel("wheel", solids, (1, 0, 0), (0, wheel_y, radius))])


def hand_truck(rng: np.random.Generator) -> Articulation:
    """An upright frame on two wheels with a toe plate, fixed or folding."""
    u = rng.uniform
    skin, metal = pick(rng, RED, BLUE, BLACK, STEEL), pick(rng, STEEL, BLACK)
    half, high, radius, wide, r = (
        u(0.18, 0.25),
        u(1.0, 1.3),
        u(0.08, 0.13),
        u(0.03, 0.05),
        u(0.012, 0.018),
    )
    path = [
        (-half, 0.0, 0.05),
        (-half, 0.0, high - 0.1),
        (-half + 0.08, 0.0, high),
        (half - 0.08, 0.0, high),
        (half, 0.0, high - 0.1),
        (half, 0.0, 0.05),
    ]
    body = [pipe(path, r, skin, 10, up=(0.0, 1.0, 0.0))]
    body += [
        box((-half, half), (-0.004, 0.004), (z - 0.012, z + 0.012), skin)
        for z in np.linspace(0.12, high - 0.25, int(rng.integers(2, 5)))
    ]
    body.append(
        cylinder(0, (0.05, radius), 0.007, (-half - r - 0.002, half + r + 0.002), metal, 10)
    )
    body += [
        box(
            (s * half - 0.004, s * half + 0.004),
            (0.0, 0.055),
            (radius - 0.01, radius + 0.01),
            metal,
        )
        for s in (-1, 1)
    ]
    limbs = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        x = side * (half + r + 0.002 + wide / 2 + 0.0008 + PLAY)
        limbs.append(
            wheel(
                f"{name}_wheel",
                disc((x, 0.05, radius), radius, wide, BLACK, metal),
                (1, 0, 0),
                (x, 0.05, radius),
            )
        )
    long = u(0.18, 0.28)
    toe = [
        block(
            2,
            (-half + 0.01, half - 0.01),
            (-long - r - PLAY, -r - PLAY),
            (0.004, 0.01),
            metal,
            0.02,
        )
    ]
    if rng.random() < 0.6:
        limbs.append(
            hinge("toe_plate", toe, (-1, 0, 0), (0, -r - PLAY, 0.01), degrees(rng, 85, 90))
        )
    else:
        body += [*toe, box((-half, half), (-r - PLAY - 0.004, 0.0), (0.0045, 0.06), metal)]
    return tree(body, limbs)


def skateboard(rng: np.random.Generator) -> Articulation:
    """A deck with kicked ends on two trucks of two wheels."""
    u = rng.uniform
    skin, metal = pick(rng, OAK, BLACK, RED), pick(rng, STEEL, WHITE)
    half, long, radius, wide = u(0.09, 0.12), u(0.32, 0.45), u(0.024, 0.034), u(0.028, 0.04)
    level = 2 * radius + u(0.012, 0.03)
    y = np.linspace(-long, long, 13)
    taper = half * np.sqrt(
        np.clip(1.0 - np.clip(np.abs(y) / long - 0.75, 0, 1) ** 2 * 14, 0.05, 1.0)
    )
    kick = level + u(0.0, 0.06) * np.clip(np.abs(y) / long - 0.7, 0, 1) / 0.3
    rings = np.stack(
        [
            np.stack([s * taper, y, kick + t], axis=1)
            for s, t in ((-1, 0.0), (1, 0.0), (1, 0.01), (-1, 0.01))
        ],
        axis=1,
    )
    body = [loft(rings, skin)]
    limbs = []
    for row, at in (("front", -0.62 * long), ("rear", 0.62 * long)):
        reach = half - wide - 0.003
        body.append(cylinder(0, (at, radius), 0.006, (-reach, reach), metal, 10))
        body.append(
            lathe(
                2, (0, at, radius - 0.004), [(0.012, 0.0), (0.03, level - radius + 0.005)], metal, 4
            )
        )
        for name, side in (("left", -1.0), ("right", 1.0)):
            x = side * (reach + wide / 2 + 0.0008 + PLAY)
            limbs.append(
                wheel(
                    f"{row}_{name}_wheel",
                    disc((x, at, radius), radius, wide, WHITE, metal),
                    (1, 0, 0),
                    (x, at, radius),
                )
            )
    return tree(body, limbs)


MAKERS = {
    "cart": cart,
    "wheelbarrow": wheelbarrow,
    "hand_truck": hand_truck,
    "skateboard": skateboard,
}
