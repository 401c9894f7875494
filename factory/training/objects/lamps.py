"""Desk lamps and standing lamps."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .looks import BLACK, BRASS, RED, STEEL, WHITE, pick
from .parts import degrees
from .rounds import ball, block, lathe, pipe, turned
from .solids import cylinder
from .trees import Limb, hinge, slider, tree

#: Between arms that lie side by side [m].
PLAY = 0.001


def desk_lamp(rng: np.random.Generator) -> Articulation:
    """A foot, one to three arms in a chain of hinges, a shade; a switch or a dimmer on the foot.

    Arms lie in two layers, side by side, so that they can fold past each other.
    """
    u = rng.uniform
    skin, metal = pick(rng, BLACK, WHITE, RED), pick(rng, STEEL, BRASS, BLACK)
    wide, thick, bar = u(0.07, 0.12), u(0.012, 0.035), u(0.004, 0.009)
    body = _foot(rng, wide, thick, skin)
    limbs: list[Limb] = []
    holder, height = "body", thick
    post = u(0.015, 0.05)
    if rng.random() < 0.5:
        height += PLAY
        profile = [(0.022, 0.0), (0.022, 0.4 * post), (0.012, post)]
        turret = [lathe(2, (0, 0, height), profile, metal, 20)]
        limbs.append(hinge("turret", turret, (0, 0, 1), (0, 0, height), np.pi, -np.pi))
        holder = "turret"
    else:
        body.append(cylinder(2, (0.0, 0.0), 0.012, (thick, thick + post), metal, 16))
    height += post
    joint, lean, layer = np.array([0.0, 0.0, height + 2.2 * bar + PLAY]), u(-0.5, 0.2), -1.0
    count = int(rng.choice([1, 2, 2, 3]))
    bend = 0.0
    for i in range(count):
        end = joint + u(0.15, 0.35) * 0.85**i * np.array([0.0, -np.sin(lean), np.cos(lean)])
        low, high = (-1.1 - lean, 1.2 - lean) if i == 0 else (-0.6 * bend, min(0.45, 2.4 - bend))
        arm = _arm(rng, joint, end, bar, layer, metal)
        limbs.append(hinge(f"arm_{i}", arm, (1, 0, 0), _point(joint), high, low, holder))
        holder, joint, layer = f"arm_{i}", end, -layer
        bend = u(0.7, 1.4) if count < 3 else u(0.5, 1.0)
        lean += bend
    shade = _shade(rng, joint, lean, bar, layer, skin)
    limbs.append(
        hinge(
            "shade",
            shade,
            (1, 0, 0),
            _point(joint),
            min(0.8, 1.6 - bend + 0.2),
            -degrees(rng, 20, 50),
            holder,
        )
    )
    if rng.random() < 0.6:
        limbs.append(_switch(rng, wide, thick, metal))
    return tree(body, limbs)


def _point(p: FloatArray) -> tuple[float, float, float]:
    return float(p[0]), float(p[1]), float(p[2])


def _foot(rng: np.random.Generator, wide: float, thick: float, skin: Material) -> list[Mesh]:
    style = rng.random()
    if style < 0.55:
        r = rng.uniform(0.5, 1.0)
        return [
            lathe(2, (0, 0, 0), [(wide, 0.0), (wide, 0.5 * thick), (r * wide, thick)], skin, 32)
        ]
    return [
        block(
            2,
            (-wide, wide),
            (-0.8 * wide, 0.8 * wide),
            (0.0, thick),
            skin,
            rng.uniform(0.002, 0.03),
            bevel=0.002,
        )
    ]


def _arm(
    rng: np.random.Generator,
    start: FloatArray,
    end: FloatArray,
    bar: float,
    layer: float,
    metal: Material,
) -> list[Mesh]:
    """A bar in one layer, with a disc around the hinge at either end; at times two bars, one above the other."""
    side = layer * (bar + PLAY)
    beside = np.array([side, 0.0, 0.0])
    a, b = start + beside, end + beside
    sides = int(rng.choice([4, 10]))
    solids = [pipe([a, (a + b) / 2, b], bar * 0.98, metal, sides, up=(1.0, 0.0, 0.0))]
    if rng.random() < 0.3:
        across = np.cross(b - a, [1.0, 0.0, 0.0])
        across *= 2.6 * bar / np.linalg.norm(across)
        solids.append(
            pipe(
                [0.93 * a + 0.07 * b + across, 0.07 * a + 0.93 * b + across],
                0.7 * bar,
                metal,
                sides,
                up=(1.0, 0.0, 0.0),
            )
        )
    span = (min(side * 2, 0.0) + PLAY / 2, max(side * 2, 0.0) - PLAY / 2)
    for p in (start, end):
        solids.append(cylinder(0, (p[1], p[2]), 2.0 * bar, span, metal, 16))
    return solids


def _shade(
    rng: np.random.Generator,
    joint: FloatArray,
    lean: float,
    bar: float,
    layer: float,
    skin: Material,
) -> list[Mesh]:
    """A shade that looks along -Z before it is turned by ``lean``, with its bulb and the fork that holds it."""
    u = rng.uniform
    neck, long, wide = u(0.015, 0.03), u(0.08, 0.16), u(0.04, 0.09)
    x, y, z = joint
    side = layer * (bar + PLAY)
    fork = pipe(
        [(x + side, y, z), (x + side, y, z + 3 * bar + neck)],
        0.98 * bar,
        skin,
        8,
        up=(1.0, 0.0, 0.0),
    )
    span = (min(side * 2, 0.0) + PLAY / 2, max(side * 2, 0.0) - PLAY / 2)
    disc = cylinder(0, (y, z), 2.0 * bar, span, skin, 16)
    low, thin = 3 * bar + 0.7 * neck, 0.002
    style = str(rng.choice(["cone", "bell", "can", "bar"]))
    if style == "bar":
        tray = block(
            2,
            (-u(0.1, 0.2), u(0.1, 0.2)),
            (-0.025, 0.025),
            (low, low + 0.025),
            skin,
            0.01,
            bevel=0.003,
        )
        tray = tray.transformed([[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]])
        return turned([fork, disc, tray], (1, 0, 0), lean, joint)
    start = 0.7 * wide if style == "can" else u(0.25, 0.4) * wide
    end = start if style == "can" else wide
    middle = (0.85 if style == "bell" else 0.5) * (end - start) + start
    outer = [
        (0.6 * start, low),
        (start, low + 0.012),
        (middle, low + 0.5 * long),
        (end, low + long),
    ]
    inner = [(r - thin, h) for r, h in outer[:0:-1]]
    hood = lathe(2, joint, [*outer, *inner], skin, int(rng.choice([20, 32])))
    solids = [fork, disc, hood]
    if rng.random() < 0.6:
        solids.append(ball((x, y, z + low + 0.5 * long), 0.6 * min(start, middle), WHITE))
    return turned(solids, (1, 0, 0), lean, joint)


def _switch(rng: np.random.Generator, wide: float, top: float, metal: Material) -> Limb:
    x, y = rng.uniform(-0.4, 0.4) * wide, -0.45 * wide
    if rng.random() < 0.5:
        knob = lathe(2, (x, y, top + PLAY), [(0.011, 0.0), (0.01, 0.012)], metal, 16)
        grip = block(
            2,
            (x - 0.002, x + 0.002),
            (y - 0.009, y + 0.009),
            (top + PLAY + 0.012, top + PLAY + 0.016),
            metal,
            0.001,
        )
        return hinge("dimmer", [knob, grip], (0, 0, 1), (x, y, top), degrees(rng, 180, 320))
    height = rng.uniform(0.004, 0.008)
    button = lathe(
        2, (x, y, top + 0.004), [(0.01, 0.0), (0.01, 0.6 * height), (0.008, height)], metal, 16
    )
    return slider("switch", [button], (0, 0, -1), (x, y, top), 0.0035)


def standing_lamp(rng: np.random.Generator) -> Articulation:
    """A foot, a pole, a shade on top; a pull cord or a foot switch, at times a pole that telescopes."""
    u = rng.uniform
    skin, metal = pick(rng, BLACK, WHITE, BRASS), pick(rng, STEEL, BRASS, BLACK)
    scale = float(rng.choice([0.35, 1.0]))
    wide, thick, pole, tall = u(0.1, 0.17), u(0.015, 0.03), u(0.006, 0.014), u(0.9, 1.5) * scale
    wide = max(wide * scale, 0.06)
    body = _foot(rng, wide, thick, skin)
    limbs: list[Limb] = []
    top: list[Mesh] = []
    if rng.random() < 0.4:
        split, thin = 0.5 * tall, 0.6 * pole
        tube = [(pole, thick), (pole, split), (thin + PLAY, split), (thin + PLAY, thick + 0.01)]
        body.append(lathe(2, (0, 0, 0), tube, metal, 16))
        top.append(cylinder(2, (0.0, 0.0), thin, (thick + 0.012, tall), metal, 12))
        holder = "upper_pole"
    else:
        body.append(cylinder(2, (0.0, 0.0), pole, (thick, tall), metal, 16))
        holder = "body"
    shade, low, wide_end = _drum(rng, tall, scale, pole, skin)
    (body if holder == "body" else top).extend(shade)
    if holder != "body":
        slide = 0.8 * (0.5 * tall - thick)
        reach = min(slide, u(0.15, 0.5) * tall)
        both = 0.0 if rng.random() < 0.6 else reach
        if both:
            limbs.append(
                hinge(holder, top, (0, 0, 1), (0, 0, 0.5 * tall), np.pi, -np.pi, slide=both)
            )
        else:
            limbs.append(slider(holder, top, (0, 0, 1), (0, 0, 0.5 * tall), reach))
    style = str(rng.choice(["cord", "cord", "foot", "none"]))
    if style == "cord":
        x, length = 0.5 * wide_end, u(0.08, 0.15)
        cord = [
            cylinder(2, (x, 0.0), 0.0012, (low - length, low + 0.05), metal, 6),
            ball((x, 0, low - length), 0.007, metal, 8),
        ]
        limbs.append(slider("cord", cord, (0, 0, -1), (x, 0, low), u(0.02, 0.05), parent=holder))
    elif style == "foot" or not limbs:
        limbs.append(_switch(rng, wide, thick, metal))
    return tree(body, limbs)


def _drum(
    rng: np.random.Generator, tall: float, scale: float, pole: float, skin: Material
) -> tuple[list[Mesh], float, float]:
    """A shade around the top of the pole: its solids, the height of its lower rim [m] and that rim's radius [m]."""
    u = rng.uniform
    wide, high = u(0.14, 0.24) * max(scale, 0.5), u(0.18, 0.3) * max(scale, 0.5)
    low, taper, thin = tall - 0.75 * high, u(0.5, 1.0), 0.002
    sides = int(rng.choice([4, 6, 20, 32]))
    profile = [
        (wide, low),
        (taper * wide, low + high),
        (taper * wide - thin, low + high),
        (wide - thin, low),
    ]
    solids = [
        lathe(2, (0, 0, 0), profile, skin, sides, looped=True),
        ball((0, 0, tall), 0.2 * wide + pole, WHITE),
    ]
    spoke = 0.97 * np.cos(np.pi / sides) * (wide - 0.75 * (1 - taper) * wide)
    for i in range(3):
        angle = 2 * np.pi * i / 3
        end = (spoke * np.cos(angle), spoke * np.sin(angle), tall)
        solids.append(pipe([(0, 0, tall), end], 0.0015, BLACK, 6))
    return solids, low, wide


MAKERS = {"desk_lamp": desk_lamp, "standing_lamp": standing_lamp}
