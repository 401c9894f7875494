"""Coffee machines and toasters: boxes with small parts on every side."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .looks import BLACK, RED, STEEL, WHITE, pick
from .parts import degrees, tub
from .rounds import arc, block, lathe, pipe, ribbon, rounded
from .solids import box, cylinder
from .trees import Limb, hinge, slider, tree

PLAY = 0.001


def coffee_machine(rng: np.random.Generator) -> Articulation:
    """A column with a head over a drip tray that pulls out; a tank lid, knobs, buttons, a lever, a steam wand."""
    u = rng.uniform
    skin, dark = pick(rng, BLACK, STEEL, RED, WHITE), pick(rng, BLACK, STEEL)
    half, deep, high = u(0.07, 0.16), u(0.22, 0.34), u(0.26, 0.4)
    base, head, back = u(0.035, 0.06), u(0.07, 0.12), u(0.4, 0.6) * deep
    r = u(0.004, 0.025)
    x, front, under = (-half, half), -back, high - head
    body = [
        block(2, x, (0.0, deep - back), (0.0, high), skin, r),
        block(
            2,
            (x[0] + 0.001, x[1] - 0.001),
            (front, 0.02),
            (under, high - 0.001),
            skin,
            r,
            bevel=0.003,
        ),
    ]
    limbs: list[Limb] = []
    if rng.random() < 0.75:
        wall = 0.005
        body += [box((s, s + wall), (front, 0.0), (0.0, base), skin) for s in (x[0], x[1] - wall)]
        body.append(box((x[0] + wall, x[1] - wall), (front, 0.0), (0.0, wall), skin))
        inner = (x[0] + wall + PLAY, x[1] - wall - PLAY)
        tray = tub(inner, (front + 0.006, -PLAY), (wall + PLAY, base - 0.004), 0.003, dark)
        tray.append(
            box(
                (inner[0] + 0.0002, inner[1] - 0.0002),
                (front, front + 0.006),
                (wall + PLAY, base),
                dark,
            )
        )
        tray.append(
            block(
                2,
                (inner[0] + 0.004, inner[1] - 0.004),
                (front + 0.008, -0.008),
                (base - 0.006, base - 0.002),
                STEEL,
                0.01,
            )
        )
        limbs.append(slider("drip_tray", tray, (0, -1, 0), (0, front, wall), u(0.5, 0.9) * back))
    else:
        body.append(block(2, x, (front, 0.02), (0.0, base), skin, r, bevel=0.003))
    limbs += _tank_lid(rng, half, deep - back, high, skin)
    limbs += _controls(rng, half, front, under, high, dark)
    spout_y = 0.55 * front
    if rng.random() < 0.5:
        limbs.append(_portafilter(rng, spout_y, under, dark))
        if rng.random() < 0.7:
            limbs.append(_wand(rng, 0.8 * half, 0.75 * front, under))
    else:
        body.append(
            block(
                2,
                (-0.02, 0.02),
                (spout_y - 0.02, spout_y + 0.02),
                (under - 0.03, under + 0.001),
                dark,
                0.006,
            )
        )
        if rng.random() < 0.5:
            limbs.append(_jug(rng, spout_y, base, under - 0.032, min(half, 0.45 * back), dark))
    return tree(body, limbs)


def _tank_lid(
    rng: np.random.Generator, half: float, room: float, high: float, skin: Material
) -> list[Limb]:
    style = rng.random()
    if style < 0.2:
        return []
    wide, thick = half * rng.uniform(0.6, 0.95), rng.uniform(0.006, 0.015)
    y = (0.004, room - 0.004)
    plate = [
        block(2, (-wide, wide), y, (high + PLAY, high + PLAY + thick), skin, 0.012, bevel=0.002)
    ]
    if style < 0.8:
        return [hinge("tank_lid", plate, (-1, 0, 0), (0, y[1], high + PLAY), degrees(rng, 60, 100))]
    return [slider("tank_lid", plate, (0, 0, 1), (0, y[1], high), 0.05)]


def _controls(
    rng: np.random.Generator, half: float, front: float, under: float, high: float, dark: Material
) -> list[Limb]:
    """Knobs and buttons on the face of the head, in one row."""
    u, limbs = rng.uniform, []
    z, radius, count = (under + high) / 2, u(0.009, 0.02), int(rng.integers(1, 5))
    radius = min(radius, 0.8 * half / count)
    for i in range(count):
        x = (i - (count - 1) / 2) * 1.7 * half / count
        y = front - PLAY
        if rng.random() < 0.5:
            rim = y - u(0.012, 0.02)
            solids = [lathe(1, (x, 0, z), [(0.9 * radius, rim), (radius, y)], dark, 20)]
            solids.append(
                box(
                    (x - 0.0015, x + 0.0015),
                    (rim - 0.004, rim),
                    (z - 0.8 * radius, z + 0.8 * radius),
                    dark,
                )
            )
            limbs.append(hinge(f"knob_{i}", solids, (0, 1, 0), (x, y, z), degrees(rng, 90, 300)))
        else:
            size, y = 0.6 * radius, y - 0.003
            button = block(
                1,
                (z - size, z + size),
                (x - size, x + size),
                (y - 0.004, y),
                dark,
                size * u(0.2, 0.95),
            )
            limbs.append(slider(f"button_{i}", [button], (0, 1, 0), (x, y, z), 0.0025))
    return limbs


def _portafilter(rng: np.random.Generator, y: float, under: float, dark: Material) -> Limb:
    """A filter holder that locks under the group by a turn."""
    u = rng.uniform
    radius, z = u(0.026, 0.034), under - PLAY
    cup = lathe(2, (0, y, z), [(0.6 * radius, -0.045), (radius, -0.03), (radius, 0.0)], STEEL, 24)
    long, tilt = u(0.09, 0.14), u(0.0, 0.02)
    bar = pipe(
        [
            (0.0, y - 0.9 * radius, z - 0.018),
            (0.0, y - 0.05, z - 0.02),
            (0.0, y - long, z - 0.02 - tilt),
        ],
        [0.006, 0.01, 0.012],
        dark,
        10,
    )
    return hinge("filter_holder", [cup, bar], (0, 0, -1), (0, y, z), degrees(rng, 30, 60))


def _wand(rng: np.random.Generator, x: float, y: float, under: float) -> Limb:
    z = under - PLAY
    path = [
        (x, y, z - 0.003),
        (x, y, z - 0.02),
        (x + 0.012, y - 0.012, z - 0.05),
        (x + 0.02, y - 0.02, z - rng.uniform(0.09, 0.12)),
    ]
    solids = [
        pipe(path, 0.0035, STEEL, 8, up=(0.6, 0.8, 0.0)),
        cylinder(2, (x, y), 0.007, (z - 0.008, z), STEEL, 12),
    ]
    return hinge("wand", solids, (0, 0, 1), (x, y, z), degrees(rng, 30, 60), -degrees(rng, 10, 30))


def _jug(
    rng: np.random.Generator, y: float, low: float, top: float, radius: float, dark: Material
) -> Limb:
    """A glass jug on the hot plate that pulls out."""
    high, radius = 0.9 * (top - low), min(radius, 0.06) * 0.95
    z = low + 0.001
    neck = 0.7 * radius
    profile = [(0.8 * radius, 0.0), (radius, 0.35 * high), (neck, 0.9 * high), (neck - 0.002, 0.9 * high),
               (radius - 0.002, 0.35 * high), (0.8 * radius - 0.002, 0.003)]  # fmt: skip
    solids = [
        lathe(2, (0, y, z), profile, STEEL, 24),
        lathe(
            2,
            (0, y, z + 0.9 * high),
            [(0.7 * radius, 0.0005), (0.65 * radius, 0.1 * high - 0.001)],
            dark,
            24,
        ),
    ]
    path = [
        (0.0, y - 0.72 * radius, z + 0.85 * high),
        (0.0, y - radius - 0.025, z + 0.8 * high),
        (0.0, y - radius - 0.02, z + 0.25 * high),
        (0.0, y - 0.95 * radius, z + 0.3 * high),
    ]
    solids.append(pipe(path, 0.006, dark, 8, up=(1.0, 0.0, 0.0)))
    return slider("jug", solids, (0, -1, 0), (0, y, z), rng.uniform(0.08, 0.2))


def toaster(rng: np.random.Generator) -> Articulation:
    """A shell with slots on top; levers that go down, knobs and buttons at one end or in front."""
    u = rng.uniform
    skin, dark = pick(rng, STEEL, RED, BLACK, WHITE), pick(rng, BLACK, STEEL)
    slots, long_slot = int(rng.choice([1, 2, 2, 4])), u(0.12, 0.2)
    pitch, wide = u(0.045, 0.06), u(0.022, 0.032)
    half_x, half_y = long_slot / 2 + u(0.02, 0.05), slots * pitch / 2 + u(0.015, 0.03)
    foot, high, r = u(0.004, 0.015), u(0.15, 0.22), u(0.01, 0.05)
    r = min(r, half_y - slots * pitch / 2 + 0.012)
    body = _shell(half_x, half_y, foot, high, r, u(0.002, 0.01), skin)
    body += _top(half_x - 0.0025, half_y - 0.0025, high, slots, long_slot, pitch, wide, r, skin)
    body += [
        cylinder(
            2, (sx * (half_x - 0.02), sy * (half_y - 0.02)), 0.009, (0.0, foot + 0.0005), dark, 12
        )
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
    at_end = rng.random() < 0.75
    limbs = _panel(rng, max(1, slots // 2), half_y - r if at_end else half_x - r, foot, high, dark)
    face = half_x if at_end else half_y
    return tree(body, [_placed(limb, face, at_end) for limb in limbs])


def _shell(
    half_x: float, half_y: float, foot: float, high: float, r: float, bevel: float, skin: Material
) -> list[Mesh]:
    """Walls around, leaning in at the top, and a floor."""
    outer, inner = (
        rounded((-half_x, half_x), (-half_y, half_y), r),
        rounded((-half_x + 0.003, half_x - 0.003), (-half_y + 0.003, half_y - 0.003), r - 0.003),
    )
    wall = ribbon(2, outer, inner, (foot, high - 0.002), skin, looped=True)
    floor = block(
        2,
        (-half_x + 0.003, half_x - 0.003),
        (-half_y + 0.003, half_y - 0.003),
        (foot + 0.001, foot + 0.004),
        skin,
        r - 0.003,
    )
    return [wall, floor]


def _top(
    x: float,
    y: float,
    high: float,
    slots: int,
    long_slot: float,
    pitch: float,
    wide: float,
    r: float,
    skin: Material,
) -> list[Mesh]:
    """Strips between the slots, and two ends with the round corners of the shell."""
    z = (high - 0.012, high)
    cut = long_slot / 2
    solids = []
    for side in (-1.0, 1.0):
        corner = [arc((x - r, side * (y - r)), r, 0.0, side * np.pi / 2, 6) for side in (-1.0, 1.0)]
        line = np.concatenate([corner[0][::-1], corner[1]])
        left = np.column_stack([np.full(len(line), cut), line[:, 1]])
        flip = [side, 1.0]
        solids.append(ribbon(2, left * flip, line * flip, z, skin))
    edges = [
        -y,
        *[(i - (slots - 1) / 2) * pitch + s * wide / 2 for i in range(slots) for s in (-1.0, 1.0)],
        y,
    ]
    for low, up in zip(edges[::2], edges[1::2], strict=True):
        solids.append(box((-cut, cut), (low, up), (z[0], z[1] - 0.0002), skin))
    return solids


def _panel(
    rng: np.random.Generator, levers: int, room: float, foot: float, high: float, dark: Material
) -> list[Limb]:
    """Levers above knobs and buttons, on the plane x = 0 that looks towards +X."""
    u, limbs = rng.uniform, []
    upper, lower = 0.8 * high, foot + 0.35 * (high - foot)
    reach = u(0.25, 0.4) * (high - foot)
    for i in range(levers):
        y = 0.0 if levers == 1 else (i - (levers - 1) / 2) * 1.1 * room
        wide, out, thick = min(u(0.012, 0.025), 0.4 * room), u(0.015, 0.035), u(0.003, 0.008)
        solids = [
            box((PLAY, 0.4 * out), (y - 0.003, y + 0.003), (upper - 0.002, upper + 0.002), dark)
        ]
        solids.append(
            block(
                2,
                (0.4 * out, 1.2 * out),
                (y - wide, y + wide),
                (upper - thick, upper + thick),
                dark,
                0.006,
                bevel=0.001,
            )
        )
        limbs.append(slider(f"lever_{i}", solids, (0, 0, -1), (0, y, upper), reach))
    floor = upper - reach - 0.012
    count = int(rng.integers(1, 4)) * levers
    radius = min(u(0.008, 0.016), 0.8 * room / count, (floor - lower) / 2 + 0.02)
    for i in range(count):
        y = (i - (count - 1) / 2) * 1.8 * room / count
        z = max(foot + radius + 0.005, floor - radius - 0.003)
        if rng.random() < 0.5 or i == 0:
            long = u(0.012, 0.02)
            knob = [lathe(0, (PLAY, y, z), [(radius, 0.0), (0.9 * radius, long)], dark, 20)]
            knob.append(
                box(
                    (PLAY + long, PLAY + long + 0.003),
                    (y - 0.0015, y + 0.0015),
                    (z - 0.8 * radius, z + 0.8 * radius),
                    dark,
                )
            )
            limbs.append(hinge(f"knob_{i}", knob, (-1, 0, 0), (0, y, z), degrees(rng, 120, 300)))
        else:
            button = lathe(
                0, (0.004, y, z), [(0.6 * radius, 0.0), (0.55 * radius, 0.005)], dark, 16
            )
            limbs.append(slider(f"button_{i}", [button], (-1, 0, 0), (0, y, z), 0.003))
    return limbs


def _placed(limb: Limb, face: float, at_end: bool) -> Limb:
    """From the plane x = 0 to the end of the body, or turned to its front."""
    turn = np.eye(4)
    if not at_end:
        turn[:2, :2] = [[0.0, 1.0], [-1.0, 0.0]]
    turn[:3, 3] = turn[:3, 0] * face

    def carried(v: tuple[float, float, float], point: float) -> tuple[float, float, float]:
        moved = turn @ [*v, point]
        return float(moved[0]), float(moved[1]), float(moved[2])

    solids = tuple(s.transformed(turn) for s in limb.solids)
    return Limb(
        limb.name, solids, limb.kind, carried(limb.axis, 0.0), carried(limb.origin, 1.0), limb.upper
    )


MAKERS = {"coffee_machine": coffee_machine, "toaster": toaster}
