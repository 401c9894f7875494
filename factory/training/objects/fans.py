"""Fans and globes: what turns on a stand."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .looks import BLACK, BLUE, BRASS, OAK, STEEL, WALNUT, WHITE, pick
from .parts import degrees
from .rounds import arc, ball, block, lathe, loft, pipe, shifted, turned
from .solids import cylinder
from .trees import Limb, hinge, slider, tree, wheel

PLAY = 0.0015


def blades(
    rng: np.random.Generator, axis: int, center: tuple[float, float, float], count: int, hub: float, radius: float,
    wide: float, pitch: float, skin: Material,
) -> list[Mesh]:  # fmt: skip
    """Twisted blades around a coordinate axis, from the hub out to ``radius`` [m]."""
    share = np.linspace(0.0, 1.0, 5)
    reach = 0.6 * hub + (radius - 0.6 * hub) * share
    half = 0.5 * wide * (0.45 + 0.55 * np.sin(np.pi * (0.25 + 0.55 * share)) ** 2)
    sweep = rng.uniform(-0.3, 0.3) * wide * share
    twist = pitch * (1.3 - 0.6 * share)
    rings = np.zeros((5, 4, 3))
    for corner, (edge, face) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))):
        rings[:, corner, 0] = reach
        rings[:, corner, 1] = sweep + edge * half * np.cos(twist)
        rings[:, corner, 2] = edge * half * np.sin(twist) + face * 0.001
    order = [(axis + 1) % 3, (axis + 2) % 3, axis]
    placed = np.zeros_like(rings)
    placed[..., order] = rings
    one = loft(placed + np.asarray(center), skin)
    direction = np.eye(3)[axis]
    return [
        s for i in range(count) for s in turned([one], direction, 2 * np.pi * i / count, center)
    ]


def fan(rng: np.random.Generator) -> Articulation:
    """A desk or floor fan: a head that tilts, at times swings, blades in a cage, knobs or buttons on the foot."""
    u = rng.uniform
    skin, metal = pick(rng, WHITE, BLACK, BLUE, STEEL), pick(rng, STEEL, BLACK)
    radius, tall = u(0.1, 0.2), float(rng.choice([u(0.05, 0.12), u(0.6, 0.9)]))
    wide, thick = radius * u(0.7, 1.0), u(0.015, 0.04)
    height = max(thick + tall, 0.0) + radius + 0.03
    body: list[Mesh] = [
        lathe(2, (0, 0, 0), [(wide, 0.0), (wide, 0.5 * thick), (0.6 * wide, thick)], skin, 32)
    ]
    neck = height - 0.045
    pole = u(0.01, 0.018)
    limbs: list[Limb] = []
    swings = rng.random() < 0.4
    body.append(cylinder(2, (0.0, 0.03), pole, (thick - 0.004, neck), metal, 16))
    holder, shift = "body", np.array([0.0, 0.03, 0.0])
    turret = [lathe(2, shift, [(pole * 1.3, neck + PLAY), (pole * 1.1, height - 0.022)], skin, 16)]
    if swings:
        half = degrees(rng, 30, 60)
        limbs.append(hinge("turret", turret, (0, 0, 1), (0, 0.03, neck), half, -half))
        holder = "turret"
    else:
        body += turret
    motor = 0.3 * radius
    motor = max(min(motor, 0.05), 0.025)
    head = [
        lathe(
            1,
            (0, 0, height + 0.02),
            [(0.6 * motor, 0.09), (motor, 0.07), (motor, 0.0), (0.7 * motor, -0.012)],
            skin,
            24,
        )
    ]
    head = shifted(head, (0.0, 0.01, motor - 0.018))
    level = height + motor + 0.002
    depth, hub = u(0.025, 0.04), 0.3 * motor + 0.012
    if rng.random() < 0.85:
        head += _cage(rng, level, radius + 0.012, depth, metal)
    head.append(cylinder(1, (level, 0.0), 0.004, (-0.012, 0.0), metal, 8))
    axis = (0.0, 0.03, height - 0.02)
    limbs.append(
        hinge("head", head, (-1, 0, 0), axis, degrees(rng, 10, 25), -degrees(rng, 3, 9), holder)
    )
    center = (0.0, -0.012 - PLAY - 0.85 * depth, level)
    core = lathe(
        1, center, [(hub, 0.5 * depth), (hub, -0.2 * depth), (0.5 * hub, -0.45 * depth)], skin, 20
    )
    count, pitch = int(rng.integers(3, 6)), u(0.25, 0.5)
    wing = blades(
        rng,
        1,
        center,
        count,
        hub,
        0.86 * radius,
        min(1.4 * depth / np.sin(1.3 * pitch), radius * u(0.5, 0.9)),
        pitch,
        skin,
    )
    limbs.append(wheel("blades", [core, *wing], (0, -1, 0), center, "head"))
    limbs += _buttons(rng, wide, thick, metal)
    return tree(body, limbs)


def _cage(
    rng: np.random.Generator, level: float, radius: float, depth: float, metal: Material
) -> list[Mesh]:
    """Wire: two rims, spokes front and back, bent outwards."""
    solids = []
    back, front = 0.002, -0.012 - 2.1 * depth
    angle = 2 * np.pi * np.arange(24) / 24
    for share, y in ((1.0, 0.5 * (back + front)), (0.6, front), (0.6, back)):
        ring = np.stack(
            [
                share * radius * np.cos(angle),
                np.full(24, y),
                level + share * radius * np.sin(angle),
            ],
            axis=1,
        )
        solids.append(pipe(ring, 0.0018, metal, 5, looped=True, up=(0.0, 1.0, 0.0)))
    count = int(rng.choice([8, 12, 16]))
    middle = 0.5 * (back + front)
    for i in range(count):
        a = 2 * np.pi * (i + 0.5) / count
        c, s = np.cos(a), np.sin(a)
        path = [
            (share * radius * c, y, level + share * radius * s)
            for share, y in ((0.1, front), (0.85, front), (1.0, middle), (0.85, back), (0.25, back))
        ]
        solids.append(pipe(path, 0.0012, metal, 4, up=(-s, 0.0, c)))
    solids.append(cylinder(1, (level, 0.0), 0.16 * radius, (front - 0.003, front), metal, 16))
    return solids


def _buttons(rng: np.random.Generator, wide: float, thick: float, metal: Material) -> list[Limb]:
    if rng.random() < 0.3:
        return []
    y = -0.55 * wide
    if rng.random() < 0.4:
        knob = [lathe(2, (0, y, thick + PLAY), [(0.014, 0.0), (0.012, 0.015)], metal, 16)]
        knob.append(
            block(
                2,
                (-0.002, 0.002),
                (y - 0.01, y + 0.01),
                (thick + PLAY + 0.015, thick + PLAY + 0.019),
                metal,
                0.001,
            )
        )
        return [hinge("knob", knob, (0, 0, -1), (0, y, thick), degrees(rng, 120, 300))]
    limbs = []
    count = int(rng.integers(2, 5))
    for i in range(count):
        x = (i - (count - 1) / 2) * 0.02
        key = block(
            2,
            (x - 0.008, x + 0.008),
            (y - 0.006, y + 0.006),
            (thick + 0.005, thick + 0.011),
            metal,
            0.002,
        )
        limbs.append(slider(f"button_{i}", [key], (0, 0, -1), (x, y, thick), 0.004))
    return limbs


def ceiling_fan(rng: np.random.Generator) -> Articulation:
    """A canopy and a rod; below, a motor with blades, at times with a lamp and a pull cord."""
    u = rng.uniform
    skin, metal = pick(rng, OAK, WALNUT, WHITE, BLACK), pick(rng, BRASS, STEEL, BLACK)
    rod, radius, hub = u(0.1, 0.4), u(0.4, 0.65), u(0.07, 0.11)
    level = 0.4
    body = [
        lathe(2, (0, 0, level + 0.06 + rod), [(0.03, 0.0), (0.07, 0.04), (0.075, 0.05)], metal, 24)
    ]
    body.append(cylinder(2, (0.0, 0.0), 0.011, (level - 0.05, level + 0.065 + rod), metal, 12))
    spin = lathe(
        2,
        (0, 0, level),
        [
            (0.5 * hub, -0.035),
            (hub, -0.02),
            (hub, 0.02),
            (0.6 * hub, 0.05),
            (0.013, 0.05),
            (0.013, -0.035),
        ],
        metal,
        32,
        looped=True,
    )
    wing = blades(
        rng,
        2,
        (0, 0, level),
        int(rng.integers(3, 7)),
        1.2 * hub,
        radius,
        u(0.1, 0.15),
        u(0.12, 0.3),
        skin,
    )
    limbs = [wheel("blades", [spin, *wing], (0, 0, 1), (0, 0, level))]
    if rng.random() < 0.6:
        body.append(
            lathe(
                2,
                (0, 0, level - 0.04),
                [
                    (0.02, 0.0),
                    (0.6 * hub, -0.01),
                    (0.8 * hub, -0.03),
                    (0.7 * hub, -0.07),
                    (0.3 * hub, -0.1),
                ],
                WHITE,
                24,
            )
        )
    else:
        body.append(lathe(2, (0, 0, level - 0.04), [(0.03, 0.0), (0.025, -0.012)], metal, 16))
    if rng.random() < 0.5:
        x, low = 0.9 * hub, level - u(0.2, 0.3)
        cord = [
            cylinder(2, (x, 0.0), 0.001, (low, level - 0.06), metal, 5),
            ball((x, 0, low), 0.006, metal, 8),
        ]
        body.append(pipe([(0.3 * hub, 0, level - 0.048), (x, 0, level - 0.052)], 0.002, metal, 5))
        limbs.append(slider("cord", cord, (0, 0, -1), (x, 0, level), u(0.02, 0.04)))
    return tree(body, limbs)


def globe(rng: np.random.Generator) -> Articulation:
    """A ball on a tilted axis in a half ring on a foot; some half rings swivel."""
    u = rng.uniform
    skin, metal, wood = (
        pick(rng, BLUE, OAK, STEEL),
        pick(rng, BRASS, STEEL),
        pick(rng, OAK, WALNUT, BLACK),
    )
    radius, tilt = u(0.09, 0.18), float(np.radians(u(10, 30)))
    foot = u(0.5, 0.75) * radius
    high = u(0.05, 0.12)
    ring = radius + u(0.008, 0.02)
    swivels = rng.random() < 0.35
    center = (0.0, 0.0, high + ring + (0.045 if swivels else 0.012))
    body = [
        lathe(
            2,
            (0, 0, 0),
            [(foot, 0.0), (foot, 0.012), (0.35 * foot, 0.03), (0.2 * foot, high)],
            wood,
            32,
        )
    ]
    body.append(ball((0, 0, high), 0.2 * foot + 0.002, wood, 12))
    line = arc((0.0, 0.0), ring, -np.pi / 2 - 0.05, np.pi / 2 + 0.05, 21)
    bow = pipe(
        np.stack([line[:, 0], np.zeros(21), line[:, 1]], axis=1) + center,
        0.004,
        metal,
        4,
        up=(0.0, 1.0, 0.0),
        flat=u(0.8, 2.0),
    )
    pins = [
        cylinder(
            2,
            (0.0, 0.0),
            0.003,
            (center[2] + s * (radius + 0.002) - 0.001, center[2] + s * ring)
            if s > 0
            else (center[2] - ring, center[2] - radius - 0.001),
            metal,
            8,
        )
        for s in (-1.0, 1.0)
    ]
    frame = turned([bow, *pins], (0, 1, 0), tilt, center)
    axis = (float(np.sin(tilt)), 0.0, float(np.cos(tilt)))
    count = int(rng.choice([16, 24, 32]))
    sphere = turned([ball(center, radius, skin, count)], (0, 1, 0), tilt, center)
    stem = center[2] - ring
    if swivels:
        body.append(cylinder(2, (0.0, 0.0), 0.004, (high, stem - 0.01 - PLAY), metal, 8))
        frame.append(cylinder(2, (0.0, 0.0), 0.006, (stem - 0.01, stem + 0.002), metal, 12))
        foot_limb = wheel("frame", frame, (0, 0, 1), (0, 0, stem))
        return tree(body, [foot_limb, wheel("ball", sphere, axis, center, "frame")])
    body.append(cylinder(2, (0.0, 0.0), 0.004, (high, stem + 0.002), metal, 8))
    return tree([*body, *frame], [wheel("ball", sphere, axis, center)])


MAKERS = {"fan": fan, "ceiling_fan": ceiling_fan, "globe": globe}
