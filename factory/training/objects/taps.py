"""Faucets."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .looks import BLACK, BRASS, STEEL, WHITE, pick
from .parts import degrees
from .rounds import arc, ball, block, lathe, pipe, shifted, turned
from .solids import box, cylinder
from .trees import Limb, hinge, slider, tree, wheel


def faucet(rng: np.random.Generator) -> Articulation:
    """A spout with one lever or two handles; most spouts swivel."""
    u = rng.uniform
    metal = pick(rng, STEEL, BRASS, BLACK, WHITE)
    if rng.random() < 0.25:
        return _mixer(rng, metal)
    two = rng.random() < 0.55
    radius, tall = u(0.014, 0.028), u(0.03 if two else 0.06, 0.12)
    body = _plinth(rng, radius, tall, metal)
    apart = u(0.07, 0.14)
    swivels = rng.random() < 0.7
    gap = 0.0008
    spout, end = _spout(rng, radius, tall + gap, metal)
    limbs: list[Limb] = []
    if swivels:
        limbs.append(hinge("spout", spout, (0, 0, 1), (0, 0, tall), *_swing(rng)))
    else:
        body += spout
    limbs += _spray(rng, end, "spout" if swivels else "body", radius, metal)
    if two:
        base = u(0.01, 0.05)
        for side in (-1.0, 1.0):
            foot = lathe(
                2,
                (side * apart, 0, 0),
                [(radius * 1.3, 0.0), (radius * 1.2, 0.006), (radius * 0.8, base)],
                metal,
            )
            body.append(foot)
        style = str(rng.choice(["lever", "cross", "knob", "paddle"]))
        limbs += _pair(rng, style, apart, base + gap, radius, metal)
        if rng.random() < 0.6:
            plate = block(
                2,
                (-apart - 0.03, apart + 0.03),
                (-0.03, 0.03),
                (-0.012, -0.0002),
                metal,
                0.028,
                bevel=0.004,
            )
            body.append(plate)
    else:
        limbs.append(_single(rng, radius, tall, metal))
    return tree(body, limbs)


def _mixer(rng: np.random.Generator, metal: Material) -> Articulation:
    """A column, the spout in front of it, one lever on top that turns, lifts, or both; at times a plug rod."""
    u = rng.uniform
    radius, tall, reach = u(0.018, 0.027), u(0.07, 0.2), u(0.09, 0.16)
    body = _plinth(rng, radius, tall, metal)
    low, thin = u(0.45, 0.75) * tall, radius * u(0.45, 0.7)
    path = [
        (0.0, -0.8 * radius, low),
        (0.0, -0.5 * reach, low + u(-0.01, 0.04)),
        (0.0, -reach, low + u(-0.02, 0.03)),
    ]
    body.append(
        pipe(
            path, [thin, 0.9 * thin, 0.8 * thin], metal, int(rng.choice([4, 12])), flat=u(0.5, 1.0)
        )
    )
    tip = [(0.7 * thin, 0.0), (0.7 * thin, -0.018)]
    body.append(lathe(2, (0, 0.8 * thin - reach, path[2][2]), tip, metal, 14))
    base, cap_high = tall + 0.0008, u(0.012, 0.03)
    cap = lathe(
        2,
        (0, 0, base),
        [(radius, 0.0), (radius, 0.6 * cap_high), (0.7 * radius, cap_high)],
        metal,
        24,
    )
    limbs: list[Limb] = []
    style = str(rng.choice(["turn", "lift", "chain"]))
    level, long, rise = base + cap_high + 0.001, u(0.06, 0.11), u(0.0, 0.05)
    foot = lathe(2, (0, 0, level), [(0.6 * radius, 0.0), (0.5 * radius, 0.012)], metal, 16)
    end = level + 0.009 + rise
    lever = pipe([(0, 0, level + 0.007), (0, -0.5 * long, end - 0.5 * rise), (0, -long, end)],
                 [0.006, 0.007, 0.006], metal, 8, flat=u(0.5, 1.0))  # fmt: skip
    half = degrees(rng, 30, 60)
    pivot = (0.0, 0.6 * radius, level)
    if style == "turn":
        limbs.append(hinge("lever", [cap, foot, lever], (0, 0, 1), (0, 0, base), half, -half))
    elif style == "lift":
        body.append(cap)
        limbs.append(hinge("lever", [foot, lever], (-1, 0, 0), pivot, degrees(rng, 15, 40)))
    else:
        limbs.append(hinge("cap", [cap], (0, 0, 1), (0, 0, base), half, -half))
        limbs.append(
            hinge("lever", [foot, lever], (-1, 0, 0), pivot, degrees(rng, 15, 40), parent="cap")
        )
    if rng.random() < 0.35:
        y, top = 1.8 * radius + 0.01, u(0.5, 0.9) * tall
        body.append(lathe(2, (0, y, 0), [(0.008, 0.0), (0.006, 0.005)], metal, 14))
        rod = [
            cylinder(2, (0.0, y), 0.0022, (0.0058, top), metal, 10),
            ball((0, y, top), 0.006, metal, 10),
        ]
        limbs.append(slider("plug_rod", rod, (0, 0, 1), (0, y, top), u(0.01, 0.03)))
    return tree(body, limbs)


def _spray(
    rng: np.random.Generator, path: FloatArray, parent: str, radius: float, metal: Material
) -> list[Limb]:
    """At times, a head that pulls out of the end of the spout."""
    if rng.random() > 0.2:
        return []
    end, ahead = path[-1], path[-1] - path[-2]
    ahead = ahead / np.linalg.norm(ahead)
    start = end + 0.007 * ahead
    long = rng.uniform(0.02, 0.06)
    head = pipe(
        [start, start + 0.5 * long * ahead, start + long * ahead],
        [0.6 * radius, 0.65 * radius, 0.8 * radius],
        metal,
        14,
        up=(1.0, 0.0, 0.0),
    )
    axis = (0.0, float(ahead[1]), float(ahead[2]))
    return [
        slider(
            "spray",
            [head],
            axis,
            (0.0, float(start[1]), float(start[2])),
            rng.uniform(0.05, 0.2),
            parent=parent,
        )
    ]


def _swing(rng: np.random.Generator) -> tuple[float, float]:
    """Upper and lower end of a swivel [rad]."""
    if rng.random() < 0.2:
        return float(np.pi), -float(np.pi)
    half = degrees(rng, 40, 100)
    return half, -half


def _plinth(rng: np.random.Generator, radius: float, tall: float, metal: Material) -> list[Mesh]:
    foot = radius * rng.uniform(1.1, 1.7)
    if rng.random() < 0.2:
        return [
            block(2, (-radius, radius), (-radius, radius), (0.0, tall), metal, 0.003),
            block(2, (-foot, foot), (-foot, foot), (0.0001, 0.006), metal, 0.004),
        ]
    profile = [
        (foot, 0.0),
        (foot, 0.005),
        (1.02 * radius, rng.uniform(0.012, 0.02)),
        (radius, tall),
    ]
    return [lathe(2, (0, 0, 0), profile, metal, int(rng.choice([16, 24, 32])))]


def _spout(
    rng: np.random.Generator, radius: float, low: float, metal: Material
) -> tuple[list[Mesh], FloatArray]:
    """A pipe that rises and comes down towards -Y, with a collar below and a nozzle at its end; and its path [m]."""
    u = rng.uniform
    thin, reach, rise = radius * u(0.45, 0.8), u(0.1, 0.24), u(0.05, 0.3)
    style = str(rng.choice(["goose", "goose", "angle", "straight", "slant"]))
    drop = u(0.01, 0.06)
    if style == "goose":
        r = reach / 2
        bend = arc((r, low + rise), r, np.pi, -u(0.0, 0.3), 13)
        line = np.vstack(
            [
                [[0.0, low]],
                [[0.0, low + 0.6 * rise]],
                bend,
                [[bend[-1][0] - 0.002, bend[-1][1] - drop]],
            ]
        )
    elif style == "angle":
        bow = thin * 2.2
        first = arc((bow, low + rise), bow, np.pi, np.pi / 2, 5)
        second = arc((reach - bow, low + rise), bow, np.pi / 2, 0.0, 5)
        line = np.vstack([[[0.0, low]], first, second, [[reach, low + rise - drop]]])
    elif style == "straight":
        rise = max(0.4 * rise, 2.5 * thin)
        corner = arc((thin * 1.8, low + rise), thin * 1.8, np.pi, np.pi / 2, 6)
        line = np.vstack(
            [[[0.0, low]], corner, [[reach, low + rise + thin * 1.8 + u(-0.02, 0.03)]]]
        )
    else:
        corner = arc((0.03, low + 0.5 * rise), 0.03, np.pi, np.pi * 0.75, 4)
        knee = corner[-1] + 0.6 * reach
        line = np.vstack([[[0.0, low]], corner, knee[None], [[reach, corner[-1, 1] + 0.4 * reach]]])
    path = np.column_stack([np.zeros(len(line)), -line[:, 0], line[:, 1]])
    sides = int(rng.choice([4, 10, 14])) if style in {"angle", "straight"} else 12
    solids = [pipe(path, thin, metal, sides, up=(1.0, 0.0, 0.0), flat=u(0.7, 1.3))]
    if rng.random() < 0.7:
        solids.append(
            lathe(
                2,
                (0, 0, low + 0.0002),
                [(radius, 0.0), (radius, 0.01), (1.05 * thin, u(0.015, 0.03))],
                metal,
                20,
            )
        )
    if rng.random() < 0.6:
        solids.append(_nozzle(path, thin * u(1.08, 1.3), metal))
    return solids, path


def _nozzle(path: FloatArray, radius: float, metal: Material) -> Mesh:
    end, ahead = path[-1], path[-1] - path[-2]
    ahead = ahead / np.linalg.norm(ahead)
    return pipe([end - 0.02 * ahead, end + 0.005 * ahead], radius, metal, 14, up=(1.0, 0.0, 0.0))


def _grip(
    rng: np.random.Generator, style: str, low: float, radius: float, room: float, metal: Material
) -> list[Mesh]:
    """A handle around the z axis, standing on ``low`` and reaching out by ``room`` at most [m]; levers point to -Y."""
    u = rng.uniform
    neck, top, length = radius * u(0.6, 0.9), low + u(0.015, 0.04), min(u(0.04, 0.09), room)
    stem = lathe(
        2, (0, 0, low), [(neck, 0.0), (0.8 * neck, 0.7 * (top - low)), (neck, top - low)], metal, 16
    )
    if style == "knob":
        return [
            stem,
            lathe(
                2,
                (0, 0, top),
                [(radius, 0.0), (1.25 * radius, 0.008), (1.1 * radius, 0.022)],
                metal,
                int(rng.choice([6, 8, 20])),
            ),
        ]
    if style == "cross":
        z, half, thick = top - 0.008, radius * u(1.4, 2.2), u(0.004, 0.007)
        arms = [
            cylinder(0, (0.0, z), thick, (-half, half), metal, 10),
            cylinder(1, (z, 0.0), thick, (-half, half), metal, 10),
        ]
        tips = [
            ball((x, y, z), 1.5 * thick, metal, 8)
            for x, y in ((half, 0.0), (-half, 0.0), (0.0, half), (0.0, -half))
        ]
        return [stem, *arms, *(tips if rng.random() < 0.5 else [])]
    lift = u(-0.2, 0.5)
    end = np.array([0.0, -length, top - 0.006 + lift * length])
    path = [
        np.array([0.0, 0.0, top - 0.006]),
        0.5 * np.array([0.0, 0.0, top - 0.006]) + 0.5 * end,
        end,
    ]
    if style == "paddle":
        return [stem, pipe(path, [0.9 * neck, 0.8 * neck, 0.9 * neck], metal, 8, flat=0.35)]
    return [stem, pipe(path, [0.006, 0.005, u(0.005, 0.008)], metal, 10)]


def _pair(
    rng: np.random.Generator, style: str, apart: float, low: float, radius: float, metal: Material
) -> list[Limb]:
    solids = _grip(rng, style, low, radius, apart - 1.7 * radius - 0.012, metal)
    face = float(rng.choice([0.0, np.pi / 2]))
    upper = (
        degrees(rng, 80, 100) if style != "knob" or rng.random() < 0.5 else degrees(rng, 180, 360)
    )
    limbs = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        placed = turned(solids, (0, 0, 1), side * face, (0, 0, 0))
        placed = shifted(placed, (side * apart, 0, 0))
        limbs.append(
            hinge(f"{name}_handle", placed, (0.0, 0.0, -side), (side * apart, 0, low), upper)
        )
    return limbs


def _single(rng: np.random.Generator, radius: float, tall: float, metal: Material) -> Limb:
    """One lever at the side: it turns about its stem, or tips up."""
    u = rng.uniform
    side = float(rng.choice([-1.0, 1.0]))
    thick = u(0.007, 0.012)
    # Clear of the flare at the foot, and of the spout above.
    z = u(0.024 + thick, tall - thick)
    start, length = radius * 1.02 + 0.0008, u(0.015, 0.035)
    ends = sorted((side * start, side * (start + length)))
    stem = cylinder(0, (0.0, z), thick, (ends[0], ends[1]), metal, 16)
    x = side * (start + 0.6 * length)
    reach = u(0.05, 0.11)
    up = rng.random() < 0.6
    tip = np.array([x + side * u(0.0, 0.03), 0.0, z + reach]) if up else np.array([x, -reach, z])
    foot = np.array([x, 0.0, z])
    path = [foot, 0.5 * (foot + tip), tip]
    arm = pipe(
        path,
        [0.005, 0.005, u(0.005, 0.009)],
        metal,
        10,
        up=(0.0, 1.0, 0.0) if up else (0.0, 0.0, 1.0),
    )
    guard = box(
        (min(x, x + 0.001), max(x, x + 0.001)), (-0.004, 0.004), (z - 0.004, z + 0.004), metal
    )
    return hinge(
        "lever",
        [stem, arm, guard],
        (1.0, 0.0, 0.0) if up else (-1.0, 0.0, 0.0),
        (ends[0], 0, z),
        degrees(rng, 45, 90),
    )


def valve(rng: np.random.Generator) -> Articulation:
    """A valve: a pipe with flanges, a bonnet and a hand wheel that turns without end."""
    u = rng.uniform
    skin, bright = pick(rng, STEEL, BRASS, BLACK), pick(rng, STEEL, BRASS)
    radius, half, wheel_r = u(0.012, 0.03), u(0.06, 0.12), u(0.03, 0.07)
    body = [cylinder(0, (0.0, 0.0), radius, (-half, half), skin)]
    body += [
        cylinder(0, (0.0, 0.0), radius * 1.6, (x, x + 0.012), skin)
        for x in (-half - 0.01, half - 0.002)
    ]
    body.append(ball((0, 0, 0), radius * 1.5, skin, 16))
    high = radius * 1.4 + u(0.03, 0.06)
    body.append(
        lathe(
            2,
            (0, 0, 0),
            [(radius, radius), (0.6 * radius, high - 0.02), (0.8 * radius, high)],
            skin,
            16,
        )
    )
    low = high + 0.001
    rod = cylinder(2, (0.0, 0.0), 0.004, (low, low + 0.02), bright, 10)
    z = low + 0.015
    ring = [(wheel_r, z - 0.004), (wheel_r + 0.005, z), (wheel_r, z + 0.004), (wheel_r - 0.005, z)]
    spokes = int(rng.integers(2, 5))
    bars = [box((-wheel_r, wheel_r), (-0.003, 0.003), (z - 0.003, z + 0.003), bright)]
    hub = [rod, lathe(2, (0, 0, 0), ring, bright, 24, looped=True)]
    for i in range(spokes):
        hub += turned(bars, (0, 0, 1), np.pi * (i + 0.1) / spokes, (0, 0, 0))
    return tree(body, [wheel("wheel", hub, (0, 0, 1), (0, 0, low))])


MAKERS = {"faucet": faucet, "valve": valve}
