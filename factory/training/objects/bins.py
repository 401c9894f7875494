"""Bins: with a swing lid, a pedal, a push flap, on wheels."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .castors import disc
from .looks import BLACK, BLUE, GREEN, RED, STEEL, WHITE, pick
from .parts import degrees
from .rounds import arc, block, lathe, loft, pipe, ribbon, rounded, swept, turned
from .solids import box, cylinder
from .trees import Limb, hinge, slider, tree, wheel

PLAY = 0.0015
SKINS = (WHITE, GREEN, STEEL, BLUE, RED, BLACK)


def _outline(rng: np.random.Generator, half_x: float, half_y: float) -> FloatArray:
    """A rounded rectangle or an ellipse around the origin [m]."""
    if rng.random() < 0.35:
        angle = 2 * np.pi * (np.arange(28) + 0.5) / 28
        return np.stack([half_x * np.cos(angle), half_y * np.sin(angle)], axis=1)
    return rounded(
        (-half_x, half_x), (-half_y, half_y), rng.uniform(0.01, 0.9 * min(half_x, half_y)), 6
    )


def _bucket(
    rng: np.random.Generator,
    outline: FloatArray,
    low: float,
    high: float,
    skin: Material,
    wall: float = 0.004,
) -> Mesh:
    """A hollow, tapered body, open at its top."""
    foot = rng.uniform(0.65, 1.0)
    share = 1.0 - wall / np.abs(outline).max()
    rows = [(foot, low), (1.0, high), (share, high), (foot * share, low + wall)]
    return loft(swept(2, np.array([s * outline for s, _ in rows]), [z for _, z in rows]), skin)


def swing_bin(rng: np.random.Generator) -> Articulation:
    """A bin under a lid with a hole; in it a flap, or two halves, that swing both ways."""
    u = rng.uniform
    half_x, half_y, high = u(0.12, 0.22), u(0.1, 0.18), u(0.35, 0.75)
    skin, top = pick(rng, *SKINS), pick(rng, *SKINS)
    outline = _outline(rng, half_x, half_y)
    body = [_bucket(rng, outline, 0.0, high, skin)]
    share, thick = u(0.6, 0.85), u(0.003, 0.02)
    slope = u(0.0, 0.1) if rng.random() < 0.5 else 0.0
    hole = outline * share
    rim = [
        (1.02 * outline, high + 0.003),
        (hole, high + 0.003 + slope),
        (hole, high - 0.002 + slope),
        (0.99 * outline, high - 0.0002),
    ]
    rings = np.array([np.column_stack([o, np.full(len(o), z)]) for o, z in rim])
    body.append(loft(rings, top, looped=True))
    level = high + slope
    room = np.abs(hole).max(axis=0)
    scale = (room - PLAY - 0.5 * thick) / room
    flap = hole * scale
    if rng.random() < 0.75:
        solids = [
            loft(
                swept(
                    2,
                    np.array([0.99 * flap, flap, 0.99 * flap]),
                    [level - thick / 2, level, level + thick / 2],
                ),
                top,
            )
        ]
        limbs = [hinge("flap", solids, (1, 0, 0), (0, 0, level), np.pi / 2, -np.pi / 2)]
        return tree(body, limbs)
    limbs = []
    for name, side in (("front", -1.0), ("rear", 1.0)):
        half = flap.copy()
        half[:, 1] = side * np.maximum(side * half[:, 1], 0.001)
        half[:, 1] += side * 0.002
        keep = np.concatenate([[True], np.linalg.norm(np.diff(half, axis=0), axis=1) > 1e-6])
        half = half[keep] * [1.0, 0.97]
        plate = loft(swept(2, half, [level - 0.003, level]), top)
        y = side * float(np.abs(half[:, 1]).max())
        limbs.append(
            hinge(
                f"{name}_flap", [plate], (-side, 0, 0), (0, y, level - 0.003), degrees(rng, 30, 55)
            )
        )
    body.append(box((-room[0], room[0]), (-0.0015, 0.0015), (level - 0.02, level - 0.006), top))
    return tree(body, limbs)


def step_bin(rng: np.random.Generator) -> Articulation:
    """A bin with a domed lid at the end of a hinge behind it, a pedal, at times a bucket inside and a bail."""
    u = rng.uniform
    half_x, half_y, high = u(0.1, 0.2), u(0.1, 0.18), u(0.25, 0.65)
    skin, dark = pick(rng, *SKINS), pick(rng, BLACK, STEEL)
    outline = _outline(rng, half_x, half_y)
    base = u(0.02, 0.045)
    body = [_bucket(rng, outline, base, high, skin)]
    ring = ribbon(2, 1.01 * outline, 0.6 * outline, (0.0, base - 0.0005), dark, looped=True)
    gap_y = -half_y
    pedal = rng.random() < 0.75
    body.append(
        ring
        if not pedal
        else box(
            (-0.7 * half_x, 0.7 * half_x), (-0.5 * half_y, 0.9 * half_y), (0.0, base - 0.0005), dark
        )
    )
    rise, level = u(0.008, 0.09), high + PLAY
    rows = [(1.01, 0.0), (1.01, 0.3 * rise), (0.85, 0.8 * rise), (0.4, rise)]
    lid = [
        loft(
            swept(2, np.array([s * outline for s, _ in rows]), [level + z for _, z in rows]),
            pick(rng, skin, dark),
        )
    ]
    pin_y = float(outline[:, 1].max()) * 1.01 + 0.006
    lid.append(
        box((-0.03, 0.03), (pin_y - 0.03, pin_y + 0.003), (level + 0.0003, level + 0.006), dark)
    )
    body.append(
        box((-0.028, 0.028), (pin_y - 0.009, pin_y + 0.003), (level - 0.04, level - 0.006), dark)
    )
    limbs: list[Limb] = [
        hinge("lid", lid, (-1, 0, 0), (0, pin_y, level + 0.001), degrees(rng, 60, 90))
    ]
    if pedal:
        z, start = 0.5 * base, -0.5 * half_y - PLAY
        wide = u(0.03, 0.06)
        bar = [box((-0.012, 0.012), (gap_y - 0.02, start), (z - 0.003, z + 0.003), dark)]
        bar.append(
            block(
                2, (-wide, wide), (gap_y - 0.06, gap_y - 0.018), (z - 0.004, z + 0.004), dark, 0.01
            )
        )
        reach = -(gap_y - 0.06) + start
        if rng.random() < 0.25:
            limbs.append(slider("pedal", bar, (0, 0, -1), (0, start, z), z - 0.005))
        else:
            limbs.append(
                hinge("pedal", bar, (1, 0, 0), (0, start, z), float(np.arctan((z - 0.006) / reach)))
            )
    if rng.random() < 0.3:
        side_x = float(outline[:, 0].max())
        turn = np.linspace(0.0, np.pi, 21)
        arch = 1.15 * (half_y + 0.02) * np.sin(turn) ** 0.2
        # It hangs in front, a little below level, and is lifted to just short of the lid.
        path = np.stack(
            [(side_x + 0.012) * np.cos(turn), -0.97 * arch, 0.8 * high - 0.25 * arch], axis=1
        )
        limbs.append(
            hinge(
                "bail", [pipe(path, 0.003, STEEL, 6)], (-1, 0, 0), (0, 0, 0.8 * high), u(0.5, 0.7)
            )
        )
    return tree(body, limbs)


def wheelie_bin(rng: np.random.Generator) -> Articulation:
    """A tall tapered bin on two wheels with a sloping lid and a grip behind."""
    u = rng.uniform
    half_x, half_y, high = u(0.2, 0.32), u(0.22, 0.36), u(0.75, 1.0)
    skin, top = pick(rng, GREEN, BLUE, BLACK, RED), pick(rng, GREEN, BLUE, BLACK, RED)
    foot, wall, radius, wide = u(0.7, 0.9), 0.006, u(0.08, 0.12), u(0.03, 0.05)
    outline = rounded((-half_x, half_x), (-half_y, half_y), 0.03)
    floor = 0.02
    rows = [(foot, floor), (1.0, high), (0.97, high), (0.97 * foot, floor + wall)]
    body = [loft(swept(2, np.array([s * outline for s, _ in rows]), [z for _, z in rows]), skin)]
    collar = ribbon(
        2, outline * [1.06, 1.05], outline * 0.985, (high - 0.04, high - 0.0003), skin, looped=True
    )
    body.append(collar)
    axle_y = foot * half_y + radius * 0.6
    # The body is this wide where the wheels end.
    waist = half_x * (foot + (1.0 - foot) * 2.2 * radius / high)
    reach = max(half_x - 0.5 * wide, waist + 0.003)
    body += [
        box(
            (s * 0.4 * half_x - 0.02, s * 0.4 * half_x + 0.02),
            (foot * half_y - 0.03, axle_y + 0.015),
            (radius - 0.025, radius + 0.025),
            skin,
        )
        for s in (-1, 1)
    ]
    body.append(cylinder(0, (axle_y, radius), 0.01, (-reach, reach), STEEL, 12))
    body += [
        box(
            (s * foot * half_x * 0.8 - 0.02, s * foot * half_x * 0.8 + 0.02),
            (-foot * half_y, -foot * half_y + 0.05),
            (0.0, floor + 0.002),
            skin,
        )
        for s in (-1, 1)
    ]
    limbs: list[Limb] = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        x = side * (reach + wide / 2 + PLAY)
        limbs.append(
            wheel(
                f"{name}_wheel",
                disc((x, axle_y, radius), radius, wide, BLACK, STEEL),
                (1, 0, 0),
                (x, axle_y, radius),
            )
        )
    pin_y = half_y * 1.05 + 0.025
    limbs.append(_wheelie_lid(rng, outline, high + PLAY, pin_y, top))
    bar = [
        (-0.8 * half_x, half_y, high - 0.03),
        (-0.8 * half_x, pin_y + 0.03, high - 0.03),
        (0.8 * half_x, pin_y + 0.03, high - 0.03),
        (0.8 * half_x, half_y, high - 0.03),
    ]
    body.append(pipe(bar, 0.012, skin, 8))
    return tree(body, limbs)


def _wheelie_lid(
    rng: np.random.Generator, outline: FloatArray, level: float, pin: float, skin: Material
) -> Limb:
    half_x, half_y = np.abs(outline).max(axis=0)
    rim, dome, rise = outline * [1.08, 1.06], outline * [0.9, 0.9], rng.uniform(0.01, 0.1)
    lid = [
        loft(
            swept(2, np.array([rim, rim, dome]), [level, level + 0.012, level + 0.012 + rise]), skin
        )
    ]
    for side in (-0.6, 0.6):
        x = side * half_x
        lid.append(
            box((x - 0.03, x + 0.03), (half_y, pin + 0.006), (level + 0.0005, level + 0.011), skin)
        )
    return hinge("lid", lid, (-1, 0, 0), (0, pin, level + 0.004), degrees(rng, 100, 165))


def push_bin(rng: np.random.Generator) -> Articulation:
    """A tall bin under a dome with an upright flap in front that is pushed in; at times a drawer or an inner pail."""
    u = rng.uniform
    radius, high = u(0.12, 0.2), u(0.45, 0.7)
    skin, top = pick(rng, *SKINS), pick(rng, *SKINS)
    square = rng.random() < 0.5
    wall, dome = 0.004, u(0.2, 0.3)
    outline = rounded(
        (-radius, radius), (-radius, radius), u(0.01, 0.05) if square else 0.98 * radius, 5
    )
    body = [_bucket(rng, outline, 0.0, high, skin, wall)]
    level, half = high + 0.0005, 0.6 * radius
    front = -radius
    hood_y = (front, radius)
    # A hood of three walls and a roof; the flap hangs in the open front.
    body.append(box((-radius, -half), hood_y, (level, level + dome), top))
    body.append(box((half, radius), hood_y, (level, level + dome), top))
    body.append(box((-half, half), (radius - wall, radius), (level, level + dome), top))
    body.append(
        block(
            2,
            (-radius, radius),
            hood_y,
            (level + dome + 0.0002, level + dome + u(0.008, 0.04)),
            top,
            0.02,
        )
    )
    flap_z = (level + 0.004, level + dome - 0.012)
    plate = [
        box(
            (-half + PLAY, half - PLAY),
            (front + 0.004, front + 0.01),
            flap_z,
            pick(rng, top, BLACK, STEEL),
        )
    ]
    plate.append(
        cylinder(0, (front + 0.007, flap_z[1]), 0.005, (-half + PLAY, half - PLAY), STEEL, 10)
    )
    # It swings in until it meets the wall behind.
    upper = min(
        degrees(rng, 50, 85),
        float(np.arcsin(min(1.0, (2 * radius - 0.03) / (flap_z[1] - flap_z[0])))),
    )
    limbs = [
        hinge("flap", plate, (1, 0, 0), (0, front + 0.007, flap_z[1]), upper, -degrees(rng, 5, 60))
    ]
    if rng.random() < 0.3:
        button = lathe(
            2, (0, 0.5 * radius, level + dome + 0.05), [(0.02, 0.0), (0.018, 0.006)], STEEL, 16
        )
        post = lathe(
            2, (0, 0.5 * radius, level + dome + 0.001), [(0.03, 0.0), (0.025, 0.044)], top, 20
        )
        body.append(post)
        limbs.append(slider("button", [button], (0, 0, -1), (0, 0.5 * radius, level + dome), 0.004))
    return tree(body, limbs)


def bucket(rng: np.random.Generator) -> Articulation:
    """A pail, a basket or a cooking pot with a bail that swings over it; some have a lid that lifts off."""
    u = rng.uniform
    wide, high, wall = u(0.1, 0.17), u(0.12, 0.32), 0.003
    skin, metal = pick(rng, *SKINS), pick(rng, STEEL, BLACK)
    foot, sides = wide * u(0.6, 1.0), int(rng.choice([4, 8, 24, 32]))
    profile = [(foot, 0.0), (wide, high), (wide - wall, high), (foot - wall, wall + 0.002)]
    if rng.random() < 0.5:
        profile[1:2] = [
            (0.995 * wide, high - 0.012),
            (wide + 0.005, high - 0.011),
            (wide + 0.005, high),
        ]
    body = [lathe(2, (0, 0, 0), profile, skin, sides)]
    flat = wide * np.cos(np.pi / sides) if sides < 24 else wide
    pin, z = flat + 0.012, high - u(0.02, 0.04)
    for side in (-1.0, 1.0):
        ends = sorted((side * (flat - 0.006), side * (pin - 0.004)))
        body.append(cylinder(0, (0.0, z), 0.008, (ends[0], ends[1]), metal, 12))
    lean, rise = float(np.radians(u(-20, 110))), u(1.1, 1.3)
    # The fewer the corners, the squarer the bail that clears them.
    bow = {4: 0.2, 8: 0.35}.get(sides, 0.5)
    line = arc((0.0, 0.0), 1.0, 0.0, np.pi, 21)
    path = np.stack(
        [pin * line[:, 0], np.zeros(21), z + rise * (pin + 0.02) * line[:, 1] ** bow], axis=1
    )
    bail = [pipe(path, 0.0025, metal, 8, up=(0.0, 1.0, 0.0))]
    if rng.random() < 0.5:
        top = float(path[10, 2])
        bail.append(
            cylinder(0, (0.0, top), 0.009, (-0.045, 0.045), pick(rng, BLACK, WHITE, RED), 12)
        )
    lidded = rng.random() < 0.3
    reach = np.radians(75) if lidded else np.radians(100)
    lean = float(np.clip(lean, -reach, reach)) if not lidded else float(reach)
    bail = turned(bail, (1, 0, 0), lean, (0, 0, z))
    limbs: list[Limb] = [
        hinge("bail", bail, (1, 0, 0), (0, 0, z), reach - lean + 0.001, -reach - lean)
    ]
    if lidded:
        limbs[0] = hinge("bail", bail, (-1, 0, 0), (0, 0, z), reach + 0.3)
        lid = [
            lathe(
                2,
                (0, 0, high + PLAY),
                [(wide, 0.0), (wide, 0.006), (0.9 * wide, 0.012)],
                skin,
                sides,
            )
        ]
        limbs.append(slider("lid", lid, (0, 0, 1), (0, 0, high), u(0.03, 0.08)))
    return tree(body, limbs)


MAKERS = {
    "swing_bin": swing_bin,
    "step_bin": step_bin,
    "wheelie_bin": wheelie_bin,
    "push_bin": push_bin,
    "bucket": bucket,
}
