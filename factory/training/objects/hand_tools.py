"""Scissors, pliers, staplers, knives."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .looks import BLACK, BLUE, GREEN, RED, STEEL, pick
from .parts import degrees
from .rounds import block, pipe, ribbon
from .solids import Span, box, cylinder
from .trees import hinge, slider, tree

#: Between blades that slide past each other [m].
PLAY = 0.0006


def _mirrored(solids: list[Mesh]) -> list[Mesh]:
    return [s.transformed(np.diag([-1.0, 1.0, 1.0, 1.0])) for s in solids]


def _leaf(points: list[tuple[float, float, float]], z: Span, material: Material) -> Mesh:
    """A plate given by rows of y, left x, right x [m]."""
    y, left, right = np.array(points).T
    return ribbon(2, np.stack([left, y], axis=1), np.stack([right, y], axis=1), z, material)


def scissors(rng: np.random.Generator) -> Articulation:
    """Two blades on a pin, closed, lying flat; each ends in a loop for the fingers."""
    u = rng.uniform
    thick, blade, grip, half = u(0.0015, 0.003), u(0.07, 0.13), u(0.06, 0.1), u(0.006, 0.011)
    skin = pick(rng, RED, BLACK, BLUE, STEEL, GREEN)
    tip, loop_x = u(0.001, 0.4 * half), u(0.014, 0.024)
    loops = [(loop_x, u(0.018, 0.035)), (loop_x * u(0.8, 1.2), u(0.018, 0.04))]
    layers = ((0.0, thick), (thick + PLAY, 2 * thick + PLAY))
    full = (min(0.0, thick - 0.004), 2 * thick + PLAY + 0.002)
    edge = u(0.0, 0.3) * half
    halves = []
    for z, (wide, long) in zip(layers, loops, strict=True):
        steel = _leaf(
            [(blade, -tip, tip), (0.6 * blade, -0.8 * half, 0.9 * half), (half, -half, half), (0.0, -half, half),
             (-half, -0.6 * half, half), (-0.45 * grip, 0.1 * half + edge, half + 0.002),
             (-0.6 * grip, 0.0012, half + 0.004)],
            z, STEEL,
        )  # fmt: skip
        center = (0.0012 + wide + 0.004, -0.55 * grip - long)
        angle = 2 * np.pi * np.arange(20) / 20
        ring = np.stack(
            [
                center[0] + wide * np.cos(angle),
                center[1] + long * np.sin(angle),
                0 * angle + sum(full) / 2,
            ],
            axis=1,
        )
        loop = pipe(
            ring,
            0.0045,
            skin,
            int(rng.choice([4, 8])),
            looped=True,
            flat=(full[1] - full[0]) / 0.009,
        )
        halves.append([steel, loop])
    pin = cylinder(2, (0.0, 0.0), 0.4 * half, (-0.001, -PLAY / 2), STEEL, 12)
    body, other = [*halves[0], pin], _mirrored(halves[1])
    other.append(
        cylinder(2, (0.0, 0.0), 0.45 * half, (layers[1][1], layers[1][1] + 0.0015), STEEL, 12)
    )
    return tree(body, [hinge("blade", other, (0, 0, -1), (0, 0, 0), degrees(rng, 35, 70))])


def pliers(rng: np.random.Generator) -> Articulation:
    """Two levers crossing at a rivet: jaws on one side, handles on the other."""
    u = rng.uniform
    thick, boss, jaw, grip = u(0.008, 0.014), u(0.009, 0.014), u(0.025, 0.07), u(0.09, 0.15)
    skin = pick(rng, RED, BLUE, BLACK, STEEL)
    gap, tip, bow = 0.0004, u(0.002, 0.008), u(0.012, 0.03)
    middle = thick / 2
    style = str(rng.choice(["flat", "needle", "cutter", "slip"]))
    jaw_tip = {"flat": 0.8 * boss, "needle": tip, "cutter": 0.9 * boss, "slip": 0.6 * boss}[style]
    start = boss + 0.0012
    halves = []
    for z in ((0.0, middle - PLAY / 2), (middle + PLAY / 2, thick)):
        solids = [cylinder(2, (0.0, 0.0), boss, z, STEEL, 20)]
        solids.append(
            _leaf([(start + 0.002, gap, 0.9 * boss), (0.0, gap - 0.3 * boss, boss)], z, STEEL)
        )
        solids.append(
            _leaf(
                [(start + jaw, gap, jaw_tip), (start + 0.4 * jaw, gap, boss), (start, gap, boss)],
                (0.0, thick),
                STEEL,
            )
        )
        solids.append(_leaf([(0.0, -boss, 0.3 * boss), (-start - 0.002, -boss, -gap)], z, STEEL))
        path = np.array(
            [
                [-0.5 * boss, -start - 0.0055],
                [-bow, -0.3 * grip],
                [-bow * u(0.9, 1.2), -0.7 * grip],
                [-bow * u(0.7, 1.1), -grip],
            ]
        )
        line = np.column_stack([path, np.full(len(path), middle)])
        radius = [0.45 * boss, 0.0055, 0.0065, 0.006]
        handle = pipe(line, radius, skin, int(rng.choice([4, 8, 10])), flat=thick / 0.013)
        halves.append([*solids, handle])
    body, other = halves[0], _mirrored(halves[1])
    other.append(cylinder(2, (0.0, 0.0), 0.5 * boss, (thick, thick + 0.0015), STEEL, 12))
    return tree(body, [hinge("lever", other, (0, 0, 1), (0, 0, 0), degrees(rng, 15, 45))])


def stapler(rng: np.random.Generator) -> Articulation:
    """A base with its anvil, a magazine and a cover that turn about a pin at the back.

    Cover and magazine both hang on the base, each on its own: what opens the magazine lifts the
        cover too.
    """
    u = rng.uniform
    long, half, foot = u(0.09, 0.2), u(0.014, 0.022), u(0.005, 0.011)
    skin, dark = pick(rng, BLACK, RED, BLUE, STEEL), pick(rng, BLACK, STEEL)
    y = (-long, 0.0)
    wide = u(1.0, 1.3)
    body = [
        block(
            2,
            (-wide * half, wide * half),
            (y[0] - 0.004, 0.016),
            (0.0, foot),
            skin,
            u(0.002, 0.016),
            bevel=0.001,
        )
    ]
    body.append(
        box(
            (-0.4 * half, 0.4 * half),
            (y[0] + 0.004, y[0] + 0.02),
            (foot + 0.0001, foot + 0.0015),
            STEEL,
        )
    )
    rise, mag = u(0.014, 0.024), u(0.009, 0.013)
    pin = (0.0, foot + rise)
    for side in (-1.0, 1.0):
        ear = sorted((side * (half + 0.0008), side * (half + 0.003)))
        body.append(
            box((ear[0], ear[1]), (-0.012, 0.012), (foot - 0.001, foot + rise + 0.008), dark)
        )
    low = foot + rise - 0.35 * mag
    inner = 0.75 * half
    magazine = [
        box((-inner, inner), (y[0], 0.002), (low, low + 0.002), STEEL),
        box((-inner, -inner + 0.0015), (y[0] + 0.0005, 0.0015), (low + 0.002, low + mag), STEEL),
        box((inner - 0.0015, inner), (y[0] + 0.0005, 0.0015), (low + 0.002, low + mag), STEEL),
        box(
            (-inner + 0.0016, inner - 0.0016),
            (y[0] - 0.001, y[0] + 0.004),
            (low + 0.001, low + mag),
            dark,
        ),
    ]
    start = low + mag + u(0.001, 0.006)
    hump, front = u(0.012, 0.03), u(0.3, 0.9)
    rows = np.array([[y[0] - 0.002, start, start + front * hump], [0.7 * y[0], start, start + 0.95 * hump],
                     [0.3 * y[0], start, start + hump], [0.0, start, start + 0.6 * hump]])  # fmt: skip
    cover = [ribbon(0, rows[:, [0, 1]], rows[:, [0, 2]], (-half, half), skin)]
    lip = [
        box(
            (s * half - max(s, 0.0) * 0.002, s * half + max(-s, 0.0) * 0.002),
            (0.9 * y[0], -0.004),
            (low + 0.4 * mag, start),
            skin,
        )
        for s in (-1.0, 1.0)
    ]
    limbs = [
        hinge("magazine", magazine, (-1, 0, 0), (0, *pin), degrees(rng, 20, 45)),
        hinge("cover", [*cover, *lip], (-1, 0, 0), (0, *pin), degrees(rng, 60, 130)),
    ]
    return tree(body, limbs)


def pocket_knife(rng: np.random.Generator) -> Articulation:
    """A handle of two scales with one to three blades folded in between."""
    u = rng.uniform
    long, high, scale = u(0.07, 0.11), u(0.014, 0.022), u(0.003, 0.006)
    skin = pick(rng, RED, BLACK, STEEL, GREEN)
    count = int(rng.integers(1, 4))
    slot = 0.0025 + 2 * PLAY
    width = count * slot
    outline = [(-0.003, 0.15 * high, 0.85 * high), (0.006, 0.0, high),
               (0.5 * long, u(-0.1, 0.1) * high, u(0.95, 1.1) * high),
               (long - 0.006, 0.0, high), (long, 0.2 * high, 0.8 * high)]  # fmt: skip
    x, low, up = np.array(outline).T
    body = []
    for span in ((-scale, 0.0), (width, width + scale)):
        body.append(ribbon(1, np.stack([low, x], axis=1), np.stack([up, x], axis=1), span, skin))
    body.append(box((0.012, long - 0.012), (0.0, width), (0.0, 0.12 * high), STEEL))
    limbs = []
    for i in range(count):
        right = i % 2 == 1
        z, base = 0.72 * high, 0.45 * high
        reach = u(0.7, 0.9) * (long - 0.012)
        end = base + u(0.0, 0.24) * high
        blade = np.array([(0.004, z - 0.15 * high, z + 0.15 * high), (0.015, base, z + u(0.3, 0.55) * high),
                          (0.7 * reach, base, z + 0.5 * high), (reach, end, end + 0.001)])  # fmt: skip
        pivot = 0.006
        if right:
            blade[:, 0] = long - blade[:, 0]
            pivot = long - pivot
        span = (i * slot + PLAY, (i + 1) * slot - PLAY)
        solid = ribbon(1, blade[:, [1, 0]], blade[:, [2, 0]], span, STEEL)
        disc = cylinder(1, (z, pivot), 0.2 * high, span, STEEL, 14)
        axis = (0.0, 1.0, 0.0) if right else (0.0, -1.0, 0.0)
        limbs.append(
            hinge(f"blade_{i}", [solid, disc], axis, (pivot, 0, z), degrees(rng, 160, 180))
        )
    return tree(body, limbs)


def cutter(rng: np.random.Generator) -> Articulation:
    """A utility knife: a hollow grip with a blade that a thumb slide pushes out."""
    u = rng.uniform
    long, half, thick, wall = u(0.11, 0.17), u(0.008, 0.013), u(0.01, 0.016), 0.002
    skin = pick(rng, RED, BLACK, BLUE, GREEN)
    slit = 0.0035
    body = [block(2, (-half, half), (0.0, long), (0.0, wall), skin, 0.003)]
    for side in (-1.0, 1.0):
        rim = sorted((side * half, side * (half - wall)))
        body.append(box((rim[0], rim[1]), (0.003, long - 0.003), (wall, thick), skin))
        edge = sorted((side * (half - wall), side * slit))
        body.append(
            box((edge[0], edge[1]), (0.004, long - 0.004), (thick - wall, thick - 0.0002), skin)
        )
    body.append(
        box((-half + wall, half - wall), (long - 0.006, long - 0.004), (wall, thick - wall), skin)
    )
    reach = u(0.3, 0.45) * long
    level = wall + 0.3 * (thick - 2 * wall)
    tip = 0.6 * (half - wall)
    inner = half - wall - PLAY
    blade: FloatArray = np.array(
        [
            (0.004, -inner, -inner + 0.001),
            (0.004 + tip, -inner, inner),
            (0.55 * long, -inner, inner),
        ]
    )
    plate = _leaf(
        [(float(a), float(b), float(c)) for a, b, c in blade], (level, level + 0.001), STEEL
    )
    at = u(0.5, 0.55) * long
    thumb = [
        box((-slit + PLAY, slit - PLAY), (at - 0.02, at), (level + 0.001, thick + 0.001), BLACK),
        block(
            2,
            (-0.7 * half, 0.7 * half),
            (at - 0.022, at + 0.002),
            (thick + 0.001, thick + 0.005),
            BLACK,
            0.003,
            bevel=0.001,
        ),
    ]
    return tree(body, [slider("blade", [plate, *thumb], (0, -1, 0), (0, at, level), reach)])


MAKERS = {
    "scissors": scissors,
    "pliers": pliers,
    "stapler": stapler,
    "pocket_knife": pocket_knife,
    "cutter": cutter,
}
