"""Office chairs, stools, folding chairs."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .castors import castor
from .looks import BLACK, BLUE, GREEN, OAK, RED, STEEL, WALNUT, WHITE, pick
from .parts import degrees
from .rounds import block, lathe, loft, pipe, shifted, turned
from .solids import box, cylinder
from .trees import Limb, hinge, tree, wheel

PLAY = 0.0015


def office_chair(rng: np.random.Generator) -> Articulation:
    """Five feet on castors or glides, a column, and a seat that turns and rises; some backs tilt."""
    u = rng.uniform
    cloth, metal = pick(rng, BLACK, BLUE, RED, GREEN, WHITE), pick(rng, STEEL, BLACK)
    feet, reach = int(rng.choice([4, 5, 5])), u(0.26, 0.34)
    radius, wide = u(0.022, 0.03), u(0.02, 0.03)
    deck = 2 * radius + u(0.008, 0.02)
    column, top = u(0.02, 0.03), u(0.38, 0.5)
    rolling = rng.random() < 0.75
    body, limbs = (
        [
            lathe(
                2,
                (0, 0, 0),
                [
                    (1.6 * column, deck + 0.001),
                    (1.7 * column, deck + 0.06),
                    (1.1 * column, deck + 0.08),
                    (column, 0.7 * top),
                ],
                metal,
                20,
            )
        ],
        [],
    )
    heading, twin = u(0.0, 2 * np.pi), rng.random() < 0.8
    for i in range(feet):
        angle = 2 * np.pi * i / feet - np.pi / 2
        c, s = np.cos(angle), np.sin(angle)
        arm = [
            (0.9 * column * c, 0.9 * column * s, deck + 0.045),
            (reach * c, reach * s, deck + 0.012),
        ]
        body.append(pipe(arm, [0.022, 0.0155], metal, 4, flat=0.75))
        x, y = float(0.95 * reach * c), float(0.95 * reach * s)
        if rolling:
            limbs += castor(
                f"castor_{i}", x, y, deck, radius, wide, heading + 0.7 * i, BLACK, metal, twin=twin
            )
        else:
            body.append(lathe(2, (x, y, 0), [(0.02, 0.0), (0.012, deck + 0.005)], BLACK, 12))
    seat = _swivel(rng, column, 0.7 * top, top, cloth, metal)
    slide = u(0.06, 0.14)
    limbs.append(
        wheel("seat", seat, (0, 0, 1), (0, 0, top), slide=slide if rng.random() < 0.75 else 0.0)
    )
    width = u(0.2, 0.26)
    if rng.random() < 0.8:
        back = _back(rng, width, top, cloth, metal)
        if rng.random() < 0.4:
            limbs.append(
                hinge(
                    "back",
                    back,
                    (-1, 0, 0),
                    (0, 0.266, top + 0.02),
                    degrees(rng, 15, 35),
                    parent="seat",
                )
            )
        else:
            limbs[-1] = Limb(**{**limbs[-1].__dict__, "solids": (*seat, *back)})
    return tree(body, limbs)


def _swivel(
    rng: np.random.Generator,
    column: float,
    low: float,
    top: float,
    cloth: Material,
    metal: Material,
) -> list[Mesh]:
    """The inner tube, the plate on it, the cushion; often arm rests."""
    u = rng.uniform
    half, deep, thick = u(0.21, 0.26), u(0.2, 0.24), u(0.04, 0.09)
    solids = [cylinder(2, (0.0, 0.0), 0.75 * column, (low + PLAY, top + 0.001), metal, 16)]
    solids.append(box((-0.1, 0.1), (-0.1, 0.1), (top, top + 0.012), metal))
    solids.append(box((-0.03, 0.03), (0.09, 0.28), (top + 0.0002, top + 0.008), metal))
    if rng.random() < 0.25:
        solids.append(
            lathe(
                2,
                (0, 0, top + 0.0122),
                [(half - 0.02, 0.0), (half, 0.4 * thick), (half - 0.02, thick)],
                cloth,
                32,
            )
        )
        return solids
    solids.append(
        block(
            2,
            (-half, half),
            (-deep, deep),
            (top + 0.0122, top + 0.0122 + thick),
            cloth,
            0.07,
            bevel=0.3 * thick,
        )
    )
    if rng.random() < 0.55:
        rise, out = u(0.18, 0.26), half + 0.03
        for side in (-1.0, 1.0):
            path = [
                (side * 0.1, 0.02, top + 0.006),
                (side * (out - 0.02), 0.02, top + 0.006),
                (side * out, 0.02, top + 0.03),
                (side * out, 0.02, top + rise),
            ]
            solids.append(pipe(path, 0.012, metal, 6, up=(0.0, 1.0, 0.0)))
            solids.append(
                block(
                    2,
                    (side * out - 0.025, side * out + 0.025),
                    (-0.12, 0.14),
                    (top + rise - 0.005, top + rise + 0.02),
                    BLACK,
                    0.02,
                    bevel=0.005,
                )
            )
    return solids


def _back(
    rng: np.random.Generator, half: float, top: float, cloth: Material, metal: Material
) -> list[Mesh]:
    u = rng.uniform
    low, high, y = top + u(0.18, 0.25), top + u(0.5, 0.8), 0.25 + u(0.0, 0.03)
    x = np.linspace(-half, half, 9)
    bow = y - u(0.0, 0.06) * (x / half) ** 2
    round_off = 1.0 - 0.12 * (x / half) ** 4
    thick = u(0.02, 0.06)
    rings = np.stack(
        [
            np.stack(
                [x, bow + dy, low + (high - low) * (round_off if up else 1 - round_off)], axis=1
            )
            for dy, up in ((0.0, False), (thick, False), (thick, True), (0.0, True))
        ],
        axis=1,
    )
    stem = [
        (0.0, 0.266, top + 0.028),
        (0.0, y + thick + 0.02, top + 0.08),
        (0.0, y + thick + 0.012, low + 0.15),
    ]
    return [loft(rings, cloth), pipe(stem, 0.018, metal, 4, up=(1.0, 0.0, 0.0), flat=2.0)]


def folding_chair(rng: np.random.Generator) -> Articulation:
    """Two crossed frames and a seat, unfolded; positive values fold it up."""
    u = rng.uniform
    metal, cloth = pick(rng, STEEL, BLACK, OAK, WHITE), pick(rng, BLACK, BLUE, OAK, RED, WALNUT)
    half, seat_z, high, r = u(0.2, 0.25), u(0.4, 0.47), u(0.76, 0.95), u(0.009, 0.014)
    foot, lean = -u(0.2, 0.26), u(0.3, 0.42)
    slope = lean / seat_z
    sides = 4 if rng.random() < 0.3 else 10

    def main(z: float) -> float:
        """The long frame leans back as it rises."""
        return foot + slope * z

    body: list[Mesh] = []
    for side in (-1.0, 1.0):
        body.append(
            pipe(
                [(side * half, main(z), z) for z in (0.0, 0.5 * high, high)],
                r,
                metal,
                sides,
                up=(1.0, 0.0, 0.0),
            )
        )
    body.append(cylinder(0, (main(0.12), 0.12), 0.7 * r, (-half, half), metal, 10))
    rest = u(0.12, 0.3)
    pad = block(1, (high - rest, high - 0.01), (-half, half), (-0.006, 0.006), cloth, 0.02)
    tilt = -np.arctan(slope)
    body += turned(
        shifted([pad], (0, main(high), 0)), (1, 0, 0), float(tilt), (0, main(high), high)
    )
    inner = half - 2 * r - PLAY
    cross = 0.5 * seat_z + u(0.0, 0.06)
    pivot = (0.0, main(cross), cross)
    back_foot = main(seat_z) + u(-0.02, 0.06)
    legs: list[Mesh] = []
    run = (pivot[1] - back_foot) / cross
    end = seat_z - 0.035
    for side in (-1.0, 1.0):
        legs.append(
            pipe(
                [(side * inner, back_foot + run * z, z) for z in (0.0, cross, end)],
                r,
                metal,
                sides,
                up=(1.0, 0.0, 0.0),
            )
        )
        reach = sorted((side * (inner - r * 0.5), side * (half - r - PLAY / 2)))
        legs.append(cylinder(0, (pivot[1], pivot[2]), 0.006, (reach[0], reach[1]), metal, 10))
    low_bar = 0.08
    legs.append(
        cylinder(0, (back_foot + run * low_bar, low_bar), 0.7 * r, (-inner, inner), metal, 10)
    )
    folded = float(np.arctan(slope) + np.arctan(-run))
    limbs = [hinge("legs", legs, (-1, 0, 0), pivot, folded * u(0.65, 0.85))]
    width = inner - r - PLAY
    hinge_y = main(seat_z)
    seat = [
        block(
            2,
            (-width, width),
            (hinge_y - u(0.34, 0.4), hinge_y - 0.005),
            (seat_z - 0.008, seat_z + u(0.008, 0.02)),
            cloth,
            0.04,
            bevel=0.003,
        )
    ]
    seat.append(
        cylinder(
            0, (hinge_y, seat_z), 0.006, (-half + r + PLAY / 2, half - r - PLAY / 2), metal, 10
        )
    )
    seat.append(
        box(
            (-width + 0.01, width - 0.01),
            (hinge_y - 0.02, hinge_y),
            (seat_z - 0.003, seat_z + 0.003),
            metal,
        )
    )
    limbs.append(
        hinge(
            "seat",
            seat,
            (-1, 0, 0),
            (0, hinge_y, seat_z),
            float(np.pi / 2 - np.arctan(slope)) * u(0.7, 0.95),
        )
    )
    return tree(body, limbs)


MAKERS = {"office_chair": office_chair, "folding_chair": folding_chair}
