"""Pots, kettles, bottles, dispensers, pepper mills: what is turned on a lathe and has a lid, a cap or a pump."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .looks import BLACK, BLUE, BRASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE, pick
from .parts import degrees
from .rounds import arc, ball, block, lathe, pipe, shifted
from .solids import box, cylinder
from .trees import Limb, hinge, slider, tree, wheel

#: Between a lid or a cap and what it lies on [m].
PLAY = 0.0006

Profile = list[tuple[float, float]]


def _walled(outer: Profile, wall: float, floor: float) -> Profile:
    """Up the outside and down the inside of a vessel, both [m]."""
    inner = [(max(r - wall, 0.002), h) for r, h in reversed(outer) if h > floor]
    return [*outer, *inner, (max(min(inner[-1][0], outer[0][0] - wall), 0.002), floor)]


def _side_curve(
    rng: np.random.Generator, foot: float, belly: float, rim: float, high: float
) -> Profile:
    """From foot to rim through a belly, smooth [m]."""
    t = np.linspace(0.0, 1.0, int(rng.integers(4, 9)))
    top = rng.uniform(0.35, 0.7)
    bulge = np.where(
        t < top, np.sin(np.pi / 2 * t / top), np.cos(np.pi / 2 * (t - top) / (1 - top))
    )
    base = np.where(t < top, foot, rim)
    return [
        (float(b + (belly - b) * s), float(high * v))
        for b, s, v in zip(base, bulge, t, strict=True)
    ]


def _round_knob(rng: np.random.Generator, z: float, size: float, material: Material) -> list[Mesh]:
    style = rng.random()
    if style < 0.4:
        return [
            lathe(
                2,
                (0, 0, z),
                [
                    (0.5 * size, 0.0),
                    (0.4 * size, 0.5 * size),
                    (size, size),
                    (0.9 * size, 1.6 * size),
                ],
                material,
                16,
            )
        ]
    if style < 0.7:
        return [
            cylinder(2, (0.0, 0.0), 0.3 * size, (z, z + 0.7 * size), material, 10),
            ball((0, 0, z + 1.2 * size), 0.8 * size, material),
        ]
    half = 1.6 * size
    line = np.column_stack([arc((0.0, 0.0), half, np.pi, 0.0, 9), np.zeros(9)])
    path = np.stack([line[:, 0], line[:, 2], z - 0.15 * size + 0.8 * line[:, 1]], axis=1)
    return [pipe(path, 0.25 * size, material, 8, up=(0.0, 1.0, 0.0))]


def pot(rng: np.random.Generator) -> Articulation:
    """A pot or a pan with a lid that lifts, and at times turns as well; two ears or one long handle."""
    u = rng.uniform
    skin, dark = pick(rng, STEEL, RED, BLACK, GREEN, BLUE), pick(rng, BLACK, STEEL, BRASS)
    wide = u(0.08, 0.16)
    high, wall = wide * u(0.45, 1.5), u(0.002, 0.006)
    sides = int(rng.choice([20, 32, 40]))
    if rng.random() < 0.6:
        outer = [(0.94 * wide, 0.0), (wide, 0.06 * high), (wide, high)]
    else:
        outer = _side_curve(rng, u(0.5, 0.8) * wide, wide * u(1.0, 1.15), wide, high)
    if rng.random() < 0.5:
        outer += [(wide + 0.004, high + 0.0005), (wide + 0.004, high + 0.003)]
    body = [lathe(2, (0, 0, 0), _walled(outer, wall, 0.05 * high + 0.002), skin, sides)]
    top = outer[-1][1]
    body += (
        _ears(rng, wide, 0.7 * high, dark)
        if rng.random() < 0.7
        else _long_handle(rng, wide, 0.75 * high, dark)
    )
    rise, rim = u(0.0, 0.35) * wide, outer[-1][0]
    arch = [
        (rim * np.cos(a) + 0.006 * (1 - np.cos(a)), rise * np.sin(a))
        for a in np.linspace(0.0, 1.5, 5)
    ]
    shape = [(rim, 0.0), (rim, 0.003), *[(float(r), 0.004 + float(h)) for r, h in arch[1:]]]
    lid = [lathe(2, (0, 0, top + PLAY), shape, skin, sides)]
    lid.append(
        lathe(
            2,
            (0, 0, top),
            [(wide - wall - 0.003, -0.006), (wide - wall - 0.003, 0.0008)],
            skin,
            sides,
        )
    )
    lid += _round_knob(rng, top + PLAY + shape[-1][1], u(0.012, 0.022), dark)
    reach = u(0.3, 1.0) * high
    z = (0.0, 0.0, top)
    if rng.random() < 0.35:
        return tree(body, [wheel("lid", lid, (0, 0, 1), z, slide=reach)])
    return tree(body, [slider("lid", lid, (0, 0, 1), z, reach)])


def _ears(rng: np.random.Generator, wide: float, z: float, material: Material) -> list[Mesh]:
    u = rng.uniform
    half, out, thick = wide * u(0.2, 0.4), u(0.02, 0.045), u(0.004, 0.008)
    solids: list[Mesh] = []
    style = rng.random()
    for side in (-1.0, 1.0):
        if style < 0.65:
            path = [
                (side * 0.96 * wide, -half, z),
                (side * (wide + out), -half, z),
                (side * (wide + out), half, z),
                (side * 0.96 * wide, half, z),
            ]
            solids.append(pipe(path, thick, material, 8))
        else:
            spans = sorted((side * 0.95 * wide, side * (wide + out)))
            solids.append(
                block(
                    2,
                    (spans[0], spans[1]),
                    (-half, half),
                    (z - thick, z + thick),
                    material,
                    0.4 * out,
                    bevel=0.3 * thick,
                )
            )
    return solids


def _long_handle(rng: np.random.Generator, wide: float, z: float, material: Material) -> list[Mesh]:
    u = rng.uniform
    long, rise = u(0.12, 0.22), u(0.0, 0.05)
    path = [
        (0.97 * wide, 0.0, z),
        (wide + 0.3 * long, 0.0, z + 0.5 * rise),
        (wide + long, 0.0, z + rise),
    ]
    return [
        pipe(
            path,
            [u(0.005, 0.009), 0.009, u(0.009, 0.013)],
            material,
            int(rng.choice([4, 10])),
            flat=u(0.6, 1.0),
        )
    ]


def kettle(rng: np.random.Generator) -> Articulation:
    """A body with a spout and a handle; its lid lifts off or is hinged; electric ones have a switch and a base."""
    u = rng.uniform
    skin, dark = pick(rng, STEEL, WHITE, RED, BLACK), pick(rng, BLACK, WALNUT, STEEL)
    rim, belly = u(0.04, 0.065), u(0.07, 0.1)
    high, foot = u(0.12, 0.22), u(0.06, 0.085)
    electric = rng.random() < 0.5
    lift = u(0.015, 0.025) if electric else 0.0
    outer = _side_curve(rng, foot, belly, rim, high)
    body = shifted([lathe(2, (0, 0, 0), _walled(outer, 0.002, 0.01), skin, 32)], (0, 0, lift))
    if electric:
        plate = [(belly * 0.95, 0.0), (belly, 0.4 * lift), (0.85 * belly, lift - 0.001)]
        body.append(lathe(2, (0, 0, 0), plate, dark, 32))
    top = high + lift
    body += _spout(rng, outer, lift, skin)
    over = not electric and rng.random() < 0.5
    body += _bail(rng, belly, top, dark) if over else _back_handle(rng, outer, lift, high, dark)
    z = top + PLAY
    lid = [
        lathe(
            2,
            (0, 0, z),
            [
                (rim, 0.0),
                (0.97 * rim, 0.004),
                (0.5 * rim, u(0.006, 0.02)),
                (0.2 * rim, u(0.02, 0.022)),
            ],
            skin,
            32,
        )
    ]
    lid += _round_knob(rng, z + 0.018, u(0.008, 0.013), dark)
    limbs: list[Limb] = []
    # A bail leaves less room.
    reach = u(0.02, 0.035) if over else u(0.03, 0.12)
    if rng.random() < 0.4 and not over:
        # Its pin lies beside the handle, behind the rim.
        pin = rim + 0.006
        lid.append(box((-0.008, 0.008), (0.8 * rim, pin + 0.003), (z + 0.0002, z + 0.003), skin))
        limbs.append(hinge("lid", lid, (-1, 0, 0), (0, pin, z + 0.004), degrees(rng, 50, 85)))
    elif rng.random() < 0.3:
        limbs.append(wheel("lid", lid, (0, 0, 1), (0, 0, z), slide=reach))
    else:
        limbs.append(slider("lid", lid, (0, 0, 1), (0, 0, z), reach))
    if electric and rng.random() < 0.8:
        y, low = belly + 0.012, lift + 0.03
        arm = box((-0.01, 0.01), (y + 0.003, y + 0.023), (low, low + 0.006), pick(rng, RED, BLACK))
        body.append(
            box((-0.013, 0.013), (outer[0][0] - 0.01, y - PLAY), (low - 0.012, low + 0.012), dark)
        )
        limbs.append(hinge("switch", [arm], (1, 0, 0), (0, y, low + 0.003), degrees(rng, 15, 30)))
    return tree(body, limbs)


def _radius_at(outer: Profile, height: float) -> float:
    radius, level = np.array(outer).T
    return float(np.interp(height, level, radius))


def _spout(rng: np.random.Generator, outer: Profile, lift: float, skin: Material) -> list[Mesh]:
    """A tapered tube towards -Y, straight or in an S."""
    u = rng.uniform
    high = outer[-1][1]
    low = u(0.35, 0.75) * high
    start, out, rise = (
        _radius_at(outer, low) * 0.9,
        u(0.05, 0.1),
        (1.0 - low / high) * high * u(0.7, 1.1),
    )
    swing = 0.25 * out if rng.random() < 0.5 else 0.0
    points = [
        (start, low),
        (start + 0.4 * out + swing, low + 0.25 * rise),
        (start + 0.7 * out, low + 0.65 * rise),
        (start + out + swing, low + rise),
    ]
    path = [(0.0, -r, h + lift) for r, h in points]
    wide = u(0.014, 0.022)
    return [pipe(path, [wide, 0.8 * wide, 0.6 * wide, 0.5 * wide], skin, 12, up=(1.0, 0.0, 0.0))]


def _bail(rng: np.random.Generator, belly: float, top: float, material: Material) -> list[Mesh]:
    """A handle over the lid."""
    half = max(0.85 * belly, 0.085)
    line = arc((0.0, top - 0.045), 1.0, 0.1, np.pi - 0.1, 11) - [0.0, top - 0.045]
    path = np.stack(
        [np.zeros(11), line[:, 0] * half, top - 0.04 + line[:, 1] * rng.uniform(0.14, 0.18)], axis=1
    )
    return [pipe(path, rng.uniform(0.005, 0.008), material, 8, up=(1.0, 0.0, 0.0))]


def _back_handle(
    rng: np.random.Generator, outer: Profile, lift: float, high: float, material: Material
) -> list[Mesh]:
    u = rng.uniform
    low, up, out = 0.2 * high + 0.03, u(0.8, 0.93) * high, u(0.035, 0.05)
    a, b = _radius_at(outer, low) * 0.97, _radius_at(outer, up) * 0.97
    far = max(r for r, _ in outer) + out
    path = [
        (0.0, b, up),
        (0.0, far - 0.01, up + 0.004),
        (0.0, far, 0.9 * up),
        (0.0, far - 0.005, low + 0.02),
        (0.0, a, low + 0.03),
    ]
    return [
        pipe(
            [(x, y, z + lift) for x, y, z in path],
            u(0.007, 0.011),
            material,
            8,
            up=(1.0, 0.0, 0.0),
            flat=u(0.7, 1.3),
        )
    ]


def bottle(rng: np.random.Generator) -> Articulation:
    """A bottle or a jar with a screw cap that turns and comes off; at times a cap on a hinge."""
    u = rng.uniform
    skin, cap_skin = pick(rng, GREEN, BLUE, WHITE, STEEL, RED), pick(rng, RED, WHITE, BLACK, BLUE)
    wide, high = u(0.025, 0.06), u(0.07, 0.3)
    jar = rng.random() < 0.4
    neck = wide * (u(0.7, 0.9) if jar else u(0.28, 0.5))
    neck_h, shoulder = u(0.015, 0.03), (0.05 if jar else u(0.1, 0.35)) * high
    t = np.linspace(0.0, 1.0, 5)
    curve = [
        (
            float(neck + (wide - neck) * np.cos(np.pi / 2 * v) ** u(0.6, 1.4)),
            float(high - neck_h - shoulder * (1 - v)),
        )
        for v in t
    ]
    curve[-1] = (neck, high - neck_h)
    sides = int(rng.choice([4, 6, 24, 32])) if rng.random() < 0.3 else 28
    stretch = (1.0, u(0.5, 1.0)) if rng.random() < 0.3 else (1.0, 1.0)
    low: Profile = [(0.85 * wide, 0.0), (wide, 0.06 * high)]
    if rng.random() < 0.4:
        low += [(wide * 1.001, 0.3 * high), (u(0.8, 0.95) * wide, 0.4 * high), (wide, 0.5 * high)]
    low = [p for p in low if p[1] < curve[0][1] - 0.003]
    whole = [lathe(2, (0, 0, 0), [*low, *curve], skin, sides, stretch)]
    core = 0.86 * neck * min(stretch)
    whole.append(lathe(2, (0, 0, 0), [(core, high - neck_h - 0.004), (core, high)], skin, 24))
    ridges = int(rng.choice([12, 24, 32]))
    # Its flats, not its corners, keep clear of the neck.
    inner, base, top = (
        core / np.cos(np.pi / ridges) + PLAY,
        high - neck_h + PLAY,
        high + PLAY + u(0.002, 0.02),
    )
    grip = max(neck * u(0.95, 1.15), inner + 0.0015)
    shape = [
        (inner, high + PLAY),
        (inner, base),
        (grip, base),
        (grip, top - 0.001),
        (0.9 * grip, top),
    ]
    cap = [lathe(2, (0, 0, 0), shape, cap_skin, ridges)]
    if rng.random() < 0.2:
        # A flip top: a disc on the neck, its pin behind.
        seat = high + PLAY
        pin = (0.0, grip + 0.002, seat)
        lid = [
            lathe(
                2,
                (0, 0, seat),
                [(grip, 0.0), (grip, top - high), (0.9 * grip, top - high + 0.001)],
                cap_skin,
                ridges,
            )
        ]
        lid.append(
            box(
                (-0.004, 0.004), (0.9 * grip, grip + 0.003), (seat + 0.0001, seat + 0.002), cap_skin
            )
        )
        lid.append(
            box(
                (-0.006, 0.006),
                (-grip - 0.003, -0.9 * grip),
                (seat + 0.0001, seat + 0.002),
                cap_skin,
            )
        )
        return tree(whole, [hinge("cap", lid, (-1, 0, 0), pin, degrees(rng, 90, 150))])
    origin, reach = (0.0, 0.0, base), u(1.2, 3.0) * neck_h
    if rng.random() < 0.8:
        return tree(whole, [wheel("cap", cap, (0, 0, 1), origin, slide=reach)])
    return tree(whole, [slider("cap", cap, (0, 0, 1), origin, reach)])


def dispenser(rng: np.random.Generator) -> Articulation:
    """A soap or lotion bottle with a pump that goes down and turns."""
    u = rng.uniform
    skin, pump_skin = pick(rng, WHITE, BLUE, GREEN, STEEL), pick(rng, BLACK, WHITE, STEEL)
    wide, high = u(0.025, 0.045), u(0.09, 0.18)
    outer = _side_curve(rng, 0.9 * wide, wide * u(1.0, 1.2), 0.45 * wide, high)
    body = [lathe(2, (0, 0, 0), outer, skin, int(rng.choice([4, 24, 32])))]
    collar, stroke, tube = u(0.011, 0.016), u(0.012, 0.025), 0.004
    well = [
        (collar, high + 0.0005),
        (collar, high + 0.014),
        (tube + 2 * PLAY, high + 0.014),
        (tube + 2 * PLAY, high + 0.002),
    ]
    body.append(lathe(2, (0, 0, 0), well, pump_skin, 20))
    low = high + 0.014 + stroke + PLAY
    down = min(stroke, 0.0115)
    pump = [cylinder(2, (0.0, 0.0), tube, (high + 0.0025 + down, low + 0.001), pump_skin, 12)]
    pump.append(lathe(2, (0, 0, low), [(0.009, 0.0), (0.01, 0.006), (0.008, 0.012)], pump_skin, 16))
    reach = u(0.03, 0.05)
    path = [(0.0, 0.0, low + 0.007), (0.0, -0.7 * reach, low + 0.008), (0.0, -reach, low + 0.002)]
    pump.append(pipe(path, [0.006, 0.005, 0.003], pump_skin, 8))
    if rng.random() < 0.5:
        return tree(body, [slider("pump", pump, (0, 0, -1), (0, 0, low), down)])
    return tree(body, [wheel("pump", pump, (0, 0, -1), (0, 0, low), slide=down)])


def pepper_mill(rng: np.random.Generator) -> Articulation:
    """A turned body under a head, or a crank, that turns without end."""
    u = rng.uniform
    skin, metal = pick(rng, OAK, WALNUT, BLACK, STEEL, WHITE), pick(rng, STEEL, BRASS)
    wide, high = u(0.022, 0.032), u(0.07, 0.18)
    waist = u(0.55, 0.95) * wide
    t = np.linspace(0.0, 1.0, 7)
    body = [
        lathe(
            2,
            (0, 0, 0),
            [(float(wide - (wide - waist) * np.sin(np.pi * v) ** 1.5), float(v * high)) for v in t],
            skin,
            28,
        )
    ]
    z = high + PLAY
    if rng.random() < 0.6:
        top = u(0.9, 1.15) * wide
        angle = np.linspace(-0.9, 1.3, 7)
        head = [
            lathe(
                2,
                (0, 0, z),
                [(float(top * np.cos(a)), float(top * (np.sin(a) + np.sin(0.9)))) for a in angle],
                skin,
                28,
            )
        ]
        head.append(ball((0, 0, z + 1.85 * top), 0.25 * top, metal, 10))
    else:
        head = [lathe(2, (0, 0, z), [(0.9 * wide, 0.0), (0.5 * wide, 0.5 * wide)], metal, 24)]
        reach, level = u(0.04, 0.07), z + 0.5 * wide + 0.003
        head.append(
            pipe([(0.0, -0.004, level), (0.0, -reach, level + 0.008)], 0.004, metal, 4, flat=0.6)
        )
        head.append(
            lathe(
                2,
                (0, -reach + 0.006, level + 0.007),
                [(0.005, 0.0), (0.008, 0.012), (0.006, 0.02)],
                skin,
                12,
            )
        )
    return tree(body, [wheel("head", head, (0, 0, 1), (0, 0, z))])


MAKERS = {
    "pot": pot,
    "kettle": kettle,
    "bottle": bottle,
    "dispenser": dispenser,
    "pepper_mill": pepper_mill,
}
