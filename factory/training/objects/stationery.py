"""What lies on a desk: pens, mice, printers, calculators."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .looks import BLACK, BLUE, GLASS, RED, STEEL, WHITE, pick
from .parts import degrees, tub
from .rounds import block, lathe, loft, pipe, rounded, shifted, swept
from .solids import Span, box, cylinder
from .trees import Limb, hinge, slider, tree, wheel

PLAY = 0.0005


def pen(rng: np.random.Generator) -> Articulation:
    """A pen lying along Y: with a cap that pulls off and turns, or with a button at its end."""
    u = rng.uniform
    skin, other = pick(rng, BLACK, BLUE, RED, STEEL), pick(rng, BLACK, STEEL, BLUE)
    radius, long = u(0.0035, 0.007), u(0.11, 0.15)
    sides = int(rng.choice([6, 12, 20]))
    tip = [(0.0006, 0.0), (0.35 * radius, 0.008), (0.8 * radius, 0.02)]
    if rng.random() < 0.55:
        body = [
            lathe(
                1,
                (0, 0, 0),
                [*tip, (0.8 * radius, 0.045), (radius, 0.046), (0.9 * radius, long)],
                skin,
                sides,
            )
        ]
        bore, edge = 0.8 * radius / np.cos(np.pi / 20) + PLAY, 0.045 - PLAY
        shape = [
            (bore, -0.002),
            (bore, edge),
            (1.12 * radius, edge),
            (1.12 * radius, 0.0),
            (0.8 * radius, -0.008),
        ]
        cap = [lathe(1, (0, 0, 0), shape, other, 20)]
        cap += _clip(1.12 * radius, (0.0, 0.038), other)
        reach, axis = u(0.045, 0.08), (0.0, -1.0, 0.0)
        if rng.random() < 0.5:
            return tree(body, [slider("cap", cap, axis, (0, edge, 0), reach)])
        return tree(body, [wheel("cap", cap, axis, (0, edge, 0), slide=reach)])
    out, stroke = u(0.006, 0.014), u(0.002, 0.005)
    body = [lathe(1, (0, 0, 0), [*tip, (radius, 0.03), (radius, long)], skin, sides)]
    body += _clip(radius, (long - 0.045, long - 0.002), other, front=False)
    start = long + stroke + PLAY
    button = [cylinder(1, (0.0, 0.0), 0.5 * radius, (start, start + out), other, 14)]
    return tree(body, [slider("button", button, (0, -1, 0), (0, start, 0), stroke)])


def _clip(radius: float, y: Span, material: Material, front: bool = True) -> list[Mesh]:
    """A flat bar along the top, held at one end."""
    foot = (y[0], y[0] + 0.004) if front else (y[1] - 0.004, y[1])
    bar = box((-0.0015, 0.0015), y, (radius + 0.001, radius + 0.002), material)
    return [bar, box((-0.0014, 0.0014), foot, (0.7 * radius, radius + 0.001), material)]


def mouse(rng: np.random.Generator) -> Articulation:
    """A computer mouse: a wheel that turns without end, two buttons that tip, at times a wire."""
    u = rng.uniform
    half, long, high = u(0.024, 0.034), u(0.045, 0.062), u(0.024, 0.04)
    skin, other = pick(rng, BLACK, WHITE, STEEL, RED), pick(rng, BLACK, STEEL)
    y = np.linspace(-long, long, 9)
    wide = half * (1.0 - u(0.1, 0.35) * np.abs(y / long) ** 3)
    crown = high * np.cos(0.9 * (y / long - u(0.0, 0.3))) ** 0.8
    split = -0.05 * long
    body = [
        _hump(
            y[y > split - 0.2 * long],
            wide[y > split - 0.2 * long],
            crown[y > split - 0.2 * long],
            0.0,
            skin,
        )
    ]
    seam = float(y[y > split - 0.2 * long][0]) - PLAY
    front = np.linspace(-long, seam, 5)
    low = 0.45 * np.interp(front, y, crown)
    body.append(_plate(front, np.interp(front, y, wide), 0.0 * low, low, skin))
    slot, lift = u(0.0035, 0.006), low + 0.002
    limbs: list[Limb] = []
    top = np.maximum(np.interp(front, y, crown), lift + 0.002)
    for name, side in (("left", -1.0), ("right", 1.0)):
        edge = np.interp(front, y, wide)
        rings = np.stack(
            [
                np.stack([side * (slot + f * (edge - slot)), front, z], axis=1)
                for f, z in (
                    (0.0, lift),
                    (1.0, lift),
                    (0.95, 0.6 * top + 0.4 * lift),
                    (0.55, top),
                    (0.0, top),
                )
            ],
            axis=1,
        )
        pivot = (0.0, seam, float(top[-1]))
        limbs.append(
            hinge(f"{name}_button", [loft(rings, skin)], (1, 0, 0), pivot, 0.6 * 0.002 / (2 * long))
        )
    at = -0.55 * long
    radius = float(np.interp(at, front, top) - np.interp(at, front, low)) / 2 + 0.001
    center = (0.0, at, float(np.interp(at, front, low)) + radius + 0.0015)
    spin = lathe(
        0,
        center,
        [
            (0.8 * radius, -slot + 0.001),
            (radius, -0.3 * slot),
            (radius, 0.3 * slot),
            (0.8 * radius, slot - 0.001),
        ],
        other,
        20,
    )
    limbs.append(wheel("wheel", [spin], (1, 0, 0), center))
    if rng.random() < 0.5:
        wire = [
            (0.0, -long + 0.002, 0.3 * low[0]),
            (0.0, -long - 0.01, 0.004),
            (0.01, -long - 0.05, 0.002),
        ]
        body.append(pipe(wire, 0.0016, other, 8))
    return tree(body, limbs)


def _hump(y: FloatArray, wide: FloatArray, crown: FloatArray, low: float, skin: Material) -> Mesh:
    """Arches one behind the other."""
    angle = np.linspace(0.0, np.pi, 9)
    across = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** 0.6
    rings = np.stack(
        [
            wide[:, None] * across,
            np.repeat(y[:, None], 9, axis=1),
            low + crown[:, None] * np.sin(angle) ** 0.7,
        ],
        axis=2,
    )
    return loft(rings, skin)


def _plate(
    y: FloatArray, wide: FloatArray, low: FloatArray, high: FloatArray, skin: Material
) -> Mesh:
    corners = ((-1.0, low), (1.0, low), (1.0, high), (-1.0, high))
    return loft(
        np.stack([np.stack([side * wide, y, z], axis=1) for side, z in corners], axis=1), skin
    )


def printer(rng: np.random.Generator) -> Articulation:
    """A box with a scanner lid, a paper drawer, an output flap in front, a feed flap behind, and buttons."""
    u = rng.uniform
    skin, dark = pick(rng, WHITE, BLACK, STEEL), pick(rng, BLACK, STEEL)
    half, deep, high, wall = u(0.19, 0.26), u(0.15, 0.22), u(0.13, 0.3), 0.006
    x, y = (-half, half), (-deep, deep)
    r = u(0.004, 0.03)
    shelf = u(0.3, 0.5) * high
    body: list[Mesh] = [block(2, x, y, (shelf, high), skin, r)]
    limbs: list[Limb] = []
    if rng.random() < 0.8:
        body += [
            box(
                (s * half - (wall if s > 0 else 0.0), s * half + (wall if s < 0 else 0.0)),
                (y[0] + r, y[1] - r),
                (0.0, shelf),
                skin,
            )
            for s in (-1.0, 1.0)
        ]
        body.append(box((-half + wall, half - wall), (y[0] + r, y[1] - r), (0.0, wall), skin))
        inner = (x[0] + wall + 0.001, x[1] - wall - 0.001)
        tray = tub(inner, (y[0] + 0.008, 0.7 * deep), (wall + 0.001, 0.6 * shelf), 0.003, dark)
        tray.append(
            block(
                1,
                (wall + 0.001, shelf - 0.002),
                inner,
                (y[0], y[0] + 0.008),
                pick(rng, skin, dark),
                0.003,
            )
        )
        limbs.append(slider("drawer", tray, (0, -1, 0), (0, y[0], wall), u(0.8, 1.3) * deep))
    else:
        body.append(block(2, x, y, (0.0, shelf), skin, r))
    level = high + 0.001
    if rng.random() < 0.8:
        thick = u(0.012, 0.04)
        lid = [
            block(
                2,
                x,
                (y[0] + u(0.0, 0.04), y[1] - 0.004),
                (level, level + thick),
                pick(rng, skin, dark),
                r,
                bevel=0.003,
            )
        ]
        limbs.append(hinge("lid", lid, (-1, 0, 0), (0, y[1] - 0.003, level), degrees(rng, 60, 90)))
        body.append(
            box((-0.8 * half, 0.8 * half), (-0.7 * deep, 0.7 * deep), (high, high + 0.0006), GLASS)
        )
    front = y[0] - 0.001
    if rng.random() < 0.7:
        z = (shelf + 0.005, shelf + u(0.5, 0.7) * (high - shelf))
        flap = [
            block(
                1,
                z,
                (-0.7 * half, 0.7 * half),
                (front - 0.006, front),
                pick(rng, skin, dark),
                0.004,
            )
        ]
        limbs.append(
            hinge("front_flap", flap, (1, 0, 0), (0, front - 0.006, z[0]), degrees(rng, 70, 100))
        )
    count, size = int(rng.integers(0, 5)), u(0.005, 0.009)
    z_row = high - 0.012 - size / 2
    for i in range(count):
        cx = -0.75 * half + i * 3 * size
        button = block(
            1,
            (z_row - size, z_row + size),
            (cx - size, cx + size),
            (front - 0.005, front - 0.0015),
            dark,
            u(0.2, 0.95) * size,
        )
        limbs.append(slider(f"button_{i}", [button], (0, 1, 0), (cx, front, z_row), 0.0015))
    if rng.random() < 0.4 or not limbs:
        low, back = 0.5 * high, y[1] + 0.001
        feed = [box((-0.6 * half, 0.6 * half), (back, back + 0.005), (low, high - 0.002), dark)]
        limbs.append(
            hinge("rear_feed", feed, (-1, 0, 0), (0, back + 0.005, low), degrees(rng, 20, 60))
        )
    return tree(body, limbs)


def calculator(rng: np.random.Generator) -> Articulation:
    """A wedge with a display and rows of keys that go down."""
    u = rng.uniform
    half, long, thick = u(0.03, 0.08), u(0.05, 0.09), u(0.006, 0.014)
    skin, other = pick(rng, BLACK, WHITE, STEEL, BLUE), pick(rng, WHITE, BLACK, RED, STEEL)
    body: list[Mesh] = [
        block(2, (-half, half), (-long, long), (0.0, thick), skin, u(0.002, 0.012), bevel=0.001)
    ]
    body.append(
        box((-0.85 * half, 0.85 * half), (0.45 * long, 0.85 * long), (thick, thick + 0.0006), GLASS)
    )
    rows, columns = int(rng.integers(2, 4)), int(rng.integers(3, 5))
    dx, dy, depth = 1.75 * half / columns, 1.25 * long / rows, u(0.0012, 0.003)
    tall, share = u(0.0015, 0.005), u(0.32, 0.44)
    outline = rounded(
        (-share * dx, share * dx), (-share * dy, share * dy), u(0.1, 0.45) * min(dx, dy)
    )
    key = loft(swept(2, np.array([outline, u(0.8, 1.0) * outline]), [0.0, tall]), other)
    limbs = []
    for row in range(rows):
        for column in range(columns):
            place = (
                (column - (columns - 1) / 2) * dx,
                -0.9 * long + (row + 0.5) * dy,
                thick + depth + PLAY,
            )
            limbs.append(
                slider(f"key_{row}_{column}", shifted([key], place), (0, 0, -1), place, depth)
            )
    return tree(body, limbs)


MAKERS = {"pen": pen, "mouse": mouse, "printer": printer, "calculator": calculator}
