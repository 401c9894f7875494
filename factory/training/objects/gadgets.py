"""Things for the hand and the desk: USB sticks, phones, lighters, cameras, remote controls, clocks."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .looks import BLACK, BLUE, BRASS, GLASS, GREEN, OAK, RED, STEEL, WHITE, pick
from .parts import degrees
from .rounds import ball, block, lathe, ribbon, rounded, shifted
from .solids import Span, box, cylinder
from .trees import Limb, hinge, slider, tree, wheel

PLAY = 0.0005


def usb_stick(rng: np.random.Generator) -> Articulation:
    """A stick with a cap that pulls off, a bracket that swings round, or a plug that slides out."""
    u = rng.uniform
    half, long, thick = u(0.006, 0.011), u(0.025, 0.045), u(0.005, 0.011)
    skin, other = pick(rng, BLACK, BLUE, RED, WHITE), pick(rng, STEEL, BLACK, GREEN)
    plug = 0.012
    z = (0.0, thick)
    center = thick / 2
    style = str(rng.choice(["cap", "bracket", "slide"]))
    if style == "slide":
        wall = 0.001
        outer, inner = (
            rounded((-half, half), z, 0.002),
            rounded((-half + wall, half - wall), (wall, thick - wall), 0.001),
        )
        body = [ribbon(1, outer[:, ::-1], inner[:, ::-1], (0.0, long), skin, looped=True)]
        body.append(
            block(
                1,
                (wall, thick - wall),
                (-half + wall, half - wall),
                (long - 0.001, long),
                skin,
                0.001,
            )
        )
        core = [
            box(
                (-half + wall + PLAY, half - wall - PLAY),
                (0.012, 0.7 * long),
                (wall + PLAY, thick - wall - PLAY),
                other,
            )
        ]
        tip = min(half - wall - PLAY, 0.006)
        core.append(
            box(
                (-tip, tip),
                (0.0005, 0.012),
                (wall + PLAY + 0.0002, thick - wall - PLAY - 0.0002),
                STEEL,
            )
        )
        return tree(body, [slider("plug", core, (0, -1, 0), (0, 0, center), 0.0115)])
    body = [block(1, z, (-half, half), (0.0, long), skin, u(0.0005, 0.003), bevel=0.0005)]
    body.append(
        box(
            (-min(half - 0.001, 0.006), min(half - 0.001, 0.006)),
            (-plug, 0.0),
            (center - 0.0022, center + 0.0022),
            STEEL,
        )
    )
    if style == "cap":
        wall = 0.001
        end = -plug - 0.001
        hole_x, hole_z = min(half - 0.001, 0.006) + PLAY, 0.0022 + PLAY
        outer = rounded((-half, half), (0.0, thick), 0.001, 2)
        inner = rounded((-hole_x, hole_x), (center - hole_z, center + hole_z), 0.0004, 2)
        cap = [ribbon(1, outer[:, ::-1], inner[:, ::-1], (end, -PLAY), other, looped=True)]
        cap.append(block(1, z, (-half, half), (end - 0.002, end), other, 0.001))
        return tree(body, [slider("cap", cap, (0, -1, 0), (0, 0, center), u(0.012, 0.03))])
    pivot, cover = 0.75 * long, 0.0008
    reach = (-plug - 0.001, pivot + 0.8 * half)
    plates = [(-PLAY - cover, -PLAY), (thick + PLAY, thick + PLAY + cover)]
    bracket = [box((-half, half), reach, span, other) for span in plates]
    bracket.append(
        box((-half, half), (reach[0] - cover, reach[0]), (plates[0][0], plates[1][1]), other)
    )
    bracket.append(
        cylinder(2, (0.0, pivot), 0.4 * half, (plates[1][1], plates[1][1] + 0.0005), STEEL, 14)
    )
    # The closed end comes round behind the body.
    far = float(np.hypot(half, long - pivot))
    upper = np.pi if far < pivot + plug else degrees(rng, 90, 120)
    return tree(body, [hinge("bracket", bracket, (0, 0, 1), (0, pivot, center), upper, -upper)])


def _pad(
    half: float, y: Span, top: float, rows: int, columns: int, tall: float, skin: Material
) -> list[tuple[str, Mesh, tuple[float, float]]]:
    """Buttons in rows, each with its name and its middle [m]."""
    dx, dy = 1.7 * half / columns, (y[1] - y[0]) / rows
    found = []
    for r in range(rows):
        for c in range(columns):
            cx, cy = (c - (columns - 1) / 2) * dx, y[0] + (r + 0.5) * dy
            key = block(
                2,
                (cx - 0.4 * dx, cx + 0.4 * dx),
                (cy - 0.38 * dy, cy + 0.38 * dy),
                (top, top + tall),
                skin,
                0.3 * min(dx, dy),
            )
            found.append((f"key_{r}_{c}", key, (cx, cy)))
    return found


def phone(rng: np.random.Generator) -> Articulation:
    """A phone that flips, or whose screen slides up or sideways over its keys."""
    u = rng.uniform
    half, long, thick = u(0.022, 0.03), u(0.08, 0.12), u(0.006, 0.011)
    skin, other = pick(rng, BLACK, STEEL, BLUE, RED), pick(rng, BLACK, STEEL, WHITE)
    r, y = u(0.002, 0.012), (-long / 2, long / 2)
    body = [block(2, (-half, half), y, (0.0, thick), skin, r, bevel=0.001)]
    keys = [
        key
        for _, key, _ in _pad(half, (y[0] + 0.006, y[0] + 0.5 * long), thick, 4, 3, 0.0006, other)
    ]
    body += keys
    level = thick + 0.0006 + PLAY
    up = level + u(0.004, 0.008)
    lid = [block(2, (-half, half), y, (level, up), other, r, bevel=0.0008)]
    if rng.random() < 0.5:
        lid.append(
            box(
                (-half + 0.004, half - 0.004),
                (y[0] + 0.012, y[1] - 0.008),
                (up, up + 0.0004),
                GLASS,
            )
        )
        lid += [cylinder(2, (0.0, y[0] + 0.006), 0.003, (up, up + 0.0005), GLASS, 12)]
        sideways = rng.random() < 0.3
        axis = (1.0, 0.0, 0.0) if sideways else (0.0, 1.0, 0.0)
        return tree(
            body,
            [
                slider(
                    "screen",
                    lid,
                    axis,
                    (0, 0, level),
                    u(0.4, 0.6) * (2 * half if sideways else long),
                )
            ],
        )
    pin = (0.0, y[1] + 0.004, level - PLAY / 2)
    lid.append(
        box(
            (-half + 0.004, half - 0.004),
            (y[0] + 0.01, y[1] - 0.01),
            (level - 0.0004, level),
            GLASS,
        )
    )
    lid.append(cylinder(0, (pin[1], pin[2]), 0.0035, (-0.5 * half, 0.5 * half), other, 14))
    lid.append(
        box(
            (-0.48 * half, 0.48 * half),
            (y[1] - 0.002, pin[1]),
            (level + 0.001, level + 0.003),
            other,
        )
    )
    for s in (-1.0, 1.0):
        span = sorted((s * (0.5 * half + PLAY), s * 0.9 * half))
        body.append(cylinder(0, (pin[1], pin[2]), 0.0035, (span[0], span[1]), skin, 14))
        body.append(
            box(
                (span[0] + 0.0003, span[1] - 0.0003),
                (y[1] - 0.002, pin[1]),
                (thick - 0.003, thick - 0.0008),
                skin,
            )
        )
    return tree(body, [hinge("lid", lid, (-1, 0, 0), pin, degrees(rng, 130, 165))])


def remote(rng: np.random.Generator) -> Articulation:
    """A remote control or a keypad: buttons that go down, at times a battery lid that slides off."""
    u = rng.uniform
    half, long, thick = u(0.018, 0.05), u(0.05, 0.1), u(0.01, 0.02)
    skin, other = pick(rng, BLACK, WHITE, STEEL), pick(rng, WHITE, RED, BLUE, STEEL)
    y = (-long, long)
    body = [block(2, (-half, half), y, (0.0, thick), skin, u(0.002, 0.8 * half), bevel=0.002)]
    rows, columns = int(rng.integers(2, 5)), int(rng.integers(1, 4))
    depth = u(0.001, 0.002)
    limbs = [
        slider(
            name,
            shifted([key], (0, 0, depth + PLAY)),
            (0, 0, -1),
            (at[0], at[1], thick),
            depth,
        )
        for name, key, at in _pad(
            0.8 * half, (y[0] + 0.01, u(0.2, 0.7) * long), thick, rows, columns, 0.002, other
        )
    ]
    return tree(body, limbs)


def lighter(rng: np.random.Generator) -> Articulation:
    """A flip lighter: a lid, and under it a wheel."""
    u = rng.uniform
    half, deep, high = u(0.016, 0.021), u(0.005, 0.007), u(0.03, 0.04)
    skin = pick(rng, STEEL, BRASS, BLACK)
    x, y = (-half, half), (-deep, deep)
    r, top = 0.002, high + u(0.016, 0.02)
    body = [block(2, x, y, (0.0, high), skin, r)]
    body.append(
        block(
            2,
            (-half + 0.003, half - 0.006),
            (-deep + 0.002, deep - 0.002),
            (high + 0.0002, high + 0.007),
            STEEL,
            0.001,
        )
    )
    wall, level = 0.0008, high + PLAY
    outer = rounded(x, y, r)
    inner = rounded((x[0] + wall, x[1] - wall), (y[0] + wall, y[1] - wall), r - wall)
    lid = [
        ribbon(2, outer, inner, (level, top), skin, looped=True),
        block(2, x, y, (top, top + wall), skin, r),
    ]
    pin = (half + 0.001, 0.0, level)
    spin = cylinder(1, (high + 0.0105, -0.004), 0.003, (-0.0025, 0.0025), STEEL, 14)
    limbs = [
        hinge("lid", lid, (0, 1, 0), pin, degrees(rng, 100, 140)),
        wheel("spark_wheel", [spin], (0, 1, 0), (-0.004, 0, high + 0.0105)),
    ]
    return tree(body, limbs)


def camera(rng: np.random.Generator) -> Articulation:
    """A body with a lens that turns or pulls out, dials and a release on top."""
    u = rng.uniform
    half, deep, high = u(0.045, 0.075), u(0.015, 0.03), u(0.055, 0.09)
    skin, metal = pick(rng, BLACK, STEEL), pick(rng, BLACK, STEEL)
    x, y = (-half, half), (-deep, deep)
    body = [block(2, x, y, (0.0, high), skin, u(0.003, 0.014), bevel=0.002)]
    if rng.random() < 0.5:
        w = u(0.15, 0.24) * half
        body.append(
            ribbon(
                1,
                [(high - 0.001, -w), (high + 0.014, -0.6 * w)],
                [(high - 0.001, w), (high + 0.014, 0.6 * w)],
                (-deep - 0.004, 0.6 * deep),
                skin,
            )
        )
    radius, z, at = u(0.36, 0.45) * high, 0.47 * high, u(-0.1, 0.1) * half
    front = -deep - PLAY
    limbs: list[Limb] = []
    body.append(
        lathe(1, (at, front - 0.0035, z), [(radius * 0.95, 0.004), (radius * 0.95, 0.0)], metal, 28)
    )
    face = front - 0.0035 - PLAY
    long = u(0.02, 0.06)
    barrel = [
        lathe(
            1,
            (at, face, z),
            [
                (radius * 0.9, 0.0),
                (radius * 0.9, -0.6 * long),
                (radius * 0.8, -long),
                (radius * 0.6, -long),
                (radius * 0.5, -0.8 * long),
            ],
            metal,
            28,
        )
    ]
    kind = rng.random()
    if kind < 0.4:
        limbs.append(wheel("lens", barrel, (0, -1, 0), (at, face, z), slide=u(0.01, 0.03)))
    elif kind < 0.7:
        limbs.append(wheel("lens", barrel, (0, -1, 0), (at, face, z)))
    else:
        limbs.append(slider("lens", barrel, (0, -1, 0), (at, face, z), u(0.01, 0.04)))
    for i in range(int(rng.integers(1, 3))):
        cx, size = half * (0.78 - 0.32 * i), 0.14 * half
        dial = lathe(2, (cx, 0.2 * deep, high + PLAY), [(size, 0.0), (size, 0.006)], metal, 16)
        limbs.append(wheel(f"dial_{i}", [dial], (0, 0, 1), (cx, 0.2 * deep, high)))
    button = lathe(
        2, (-0.7 * half, -0.2 * deep, high + 0.002), [(0.006, 0.0), (0.005, 0.003)], metal, 14
    )
    limbs.append(slider("release", [button], (0, 0, -1), (-0.7 * half, -0.2 * deep, high), 0.0015))
    return tree(body, limbs)


def clock(rng: np.random.Generator) -> Articulation:
    """A dial with two or three hands, in a round or square case; at times a pendulum below."""
    u = rng.uniform
    radius, deep, rim = u(0.05, 0.18), u(0.015, 0.05), u(0.006, 0.02)
    skin, hand_skin = pick(rng, WHITE, OAK, BLACK, RED, STEEL), pick(rng, BLACK, RED, BRASS)
    level = radius + rim + 0.3
    if rng.random() < 0.6:
        profile = [
            (radius + rim, 0.0),
            (radius + rim, -deep),
            (radius, -deep),
            (radius, -0.4 * deep),
        ]
        body = [lathe(1, (0, 0, level), profile, skin, 40)]
    else:
        half = radius + rim
        outer, inner = (
            rounded((level - half, level + half), (-half, half), 0.02),
            rounded((level - radius, level + radius), (-radius, radius), 0.01),
        )
        body = [
            ribbon(1, outer, inner, (-deep, 0.0), skin, looped=True),
            block(
                1,
                (level - radius, level + radius),
                (-radius, radius),
                (-0.4 * deep, -0.001),
                skin,
                0.01,
            ),
        ]
    for i in range(12):
        a = np.pi * i / 6
        c, s = 0.88 * radius * np.cos(a), 0.88 * radius * np.sin(a)
        body.append(ball((c, -0.4 * deep, level + s), 0.02 * radius, hand_skin, 6))
    face = -0.4 * deep - 0.02 * radius
    limbs: list[Limb] = []
    step = 0.0014
    for i, (name, share) in enumerate(
        (("hour", 0.5), ("minute", 0.8), ("second", 0.78))[: int(rng.integers(2, 4))]
    ):
        y = (face - PLAY - (i + 1) * step, face - 2 * PLAY - i * step)
        wide = radius * (0.05, 0.035, 0.012)[i]
        angle = u(0, 2 * np.pi)
        plate = ribbon(
            1,
            [(-0.15 * radius, -wide), (share * radius, -0.3 * wide)],
            [(-0.15 * radius, wide), (share * radius, 0.3 * wide)],
            y,
            hand_skin,
        )
        boss = cylinder(1, (0.0, 0.0), 1.6 * wide, y, hand_skin, 12)
        turn = np.array(
            [
                [np.cos(angle), 0, np.sin(angle), 0],
                [0, 1, 0, 0],
                [-np.sin(angle), 0, np.cos(angle), level],
                [0, 0, 0, 1],
            ]
        )
        limbs.append(
            wheel(
                f"{name}_hand",
                [s.transformed(turn) for s in (plate, boss)],
                (0, 1, 0),
                (0, face, level),
            )
        )
    if rng.random() < 0.3:
        long = u(0.1, 0.25)
        low = level - radius - rim
        rod = [
            box(
                (-0.002, 0.002),
                (-0.6 * deep, -0.6 * deep + 0.002),
                (low - long, low - 0.003),
                BRASS,
            ),
            lathe(
                1,
                (0, -0.6 * deep, low - long),
                [(0.02, 0.004), (0.025, 0.001), (0.02, -0.002)],
                BRASS,
                24,
            ),
        ]
        limbs.append(hinge("pendulum", rod, (0, 1, 0), (0, -0.6 * deep, low), 0.25, -0.25))
    return tree(body, limbs)


MAKERS = {
    "usb_stick": usb_stick,
    "phone": phone,
    "remote": remote,
    "lighter": lighter,
    "camera": camera,
    "clock": clock,
}
