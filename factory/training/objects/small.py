"""Laptops and trash cans."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation, JointKind
from ...mesh import Material, Mesh
from .looks import BLACK, BLUE, GLASS, GREEN, RED, STEEL, WHITE, pick
from .parts import GAP, REVEAL, Moving, assemble, degrees, millimetres, tub
from .solids import Span, box, cylinder


def laptop(rng: np.random.Generator) -> Articulation:
    """A base with keys and a closed lid with a screen, on the three knuckles of a barrel hinge."""
    width, depth = millimetres(rng, 0.3, 0.38), millimetres(rng, 0.21, 0.26)
    thick, lid_thick, radius = millimetres(rng, 0.013, 0.018), 0.007, 0.005
    skin = pick(rng, STEEL, BLACK, BLUE)
    x = (-width / 2, width / 2)
    y = (-depth / 2, depth / 2 - 2 * radius - 0.002)
    rubber = 0.002
    top = rubber + thick
    above = top + GAP + 0.001
    # The barrel's axis lies behind the base, level with the gap between base and lid.
    axis_y, axis_z = y[1] + radius + 0.002, top + 0.0015
    base = [box(x, y, (rubber, top), skin)]
    base += [box((fx, fx + 0.02), (fy, fy + 0.01), (0.0, rubber), BLACK) for fx in (x[0] + 0.02, x[1] - 0.04)
             for fy in (y[0] + 0.02, y[1] - 0.03)]  # fmt: skip
    base += _keys(x, y, top)
    under, lid_z = (axis_z - radius * 0.9, axis_z - 0.002), (above, above + lid_thick)
    for low, high in ((-0.42, -0.28), (0.28, 0.42)):
        span = (round(low * width, 3), round(high * width, 3))
        base.append(cylinder(0, (axis_y, axis_z), radius, span, BLACK, sides=16))
        base.append(box((span[0] + REVEAL, span[1] - REVEAL), (y[1], axis_y), under, BLACK))
    span = (round(-0.25 * width, 3), round(0.25 * width, 3))
    screen = (above - 0.001, above)
    lid = [
        box(x, y, lid_z, skin),
        box((x[0] + 0.012, x[1] - 0.012), (y[0] + 0.012, y[1] - 0.02), screen, GLASS),
        cylinder(0, (axis_y, axis_z), radius, span, BLACK, sides=16),
        box(
            (span[0] + REVEAL, span[1] - REVEAL),
            (y[1], axis_y),
            (axis_z + 0.001, lid_z[1] - REVEAL),
            BLACK,
        ),
    ]
    upper = degrees(rng, 110, 135)
    hinge = Moving(
        "lid", tuple(lid), JointKind.REVOLUTE, (-1.0, 0.0, 0.0), (0.0, axis_y, axis_z), upper
    )
    return assemble(base, [hinge])


def _keys(x: Span, y: Span, top: float) -> list[Mesh]:
    pitch, proud = 0.02, 0.0008
    columns = int((x[1] - x[0] - 0.04) / pitch)
    left = -columns * pitch / 2
    keys = [
        box((left + pitch * i, left + pitch * i + 0.016), (v, v + 0.016), (top, top + proud), BLACK)
        for v in (y[1] - 0.05 - pitch * np.arange(4))
        for i in range(columns)
    ]
    pad = (y[0] + 0.015, y[1] - 0.05 - 4 * pitch)
    return [*keys, box((-0.05, 0.05), pad, (top, top + 0.0004), GLASS)]


def trash_can(rng: np.random.Generator) -> Articulation:
    """A bin with a lid hinged at its back; most have a pedal at the front."""
    wall, base = 0.005, 0.05
    width, depth, height = (
        millimetres(rng, 0.25, 0.38),
        millimetres(rng, 0.26, 0.36),
        millimetres(rng, 0.4, 0.62),
    )
    skin, dark = pick(rng, STEEL, WHITE, GREEN, RED), BLACK
    x, y, z = (-width / 2, width / 2), (-depth / 2, depth / 2), (base, base + height)
    solids = tub(x, (y[0] + wall, y[1]), z, wall, skin)
    solids.append(box(x, (y[0], y[0] + wall), (z[0] + REVEAL, z[1] - REVEAL), skin))
    for low in (x[0] + 0.003, x[1] - 0.043):
        solids.append(box((low, low + 0.04), (y[0] + 0.003, y[1] - 0.003), (0.0, base), dark))
    moving = [_bin_lid(x, y, z[1], degrees(rng, 75, 95), pick(rng, skin, dark))]
    if rng.random() < 0.7:
        moving.append(_pedal(y, dark))
    return assemble(solids, moving)


def _bin_lid(x: Span, y: Span, top: float, upper: float, material: Material) -> Moving:
    bottom, skirt, thick = top + GAP, 0.03, 0.006
    lid_x, lid_y = (x[0] - GAP - thick, x[1] + GAP + thick), (y[0] - GAP - thick, y[1])
    drop, side_y = (top - skirt, bottom), (lid_y[0] + thick, lid_y[1] - 0.002)
    solids = (
        box(lid_x, lid_y, (bottom, bottom + 0.012), material),
        box(
            (lid_x[0] + REVEAL, lid_x[1] - REVEAL),
            (lid_y[0] + REVEAL, lid_y[0] + thick),
            drop,
            material,
        ),
        box((lid_x[0] + 2 * REVEAL, x[0] - GAP), side_y, (drop[0] + REVEAL, drop[1]), material),
        box((x[1] + GAP, lid_x[1] - 2 * REVEAL), side_y, (drop[0] + REVEAL, drop[1]), material),
        box((-0.03, 0.03), (lid_y[0] - 0.02, lid_y[0]), (bottom + 0.002, bottom + 0.01), material),
    )
    return Moving("lid", solids, JointKind.REVOLUTE, (-1.0, 0.0, 0.0), (0.0, y[1], bottom), upper)


def _pedal(y: Span, material: Material) -> Moving:
    """A lever under the bin; its front end goes down."""
    pivot = y[0] + 0.1
    level = (0.028, 0.036)
    solids = (
        box((-0.012, 0.012), (y[0] - 0.02, pivot), level, material),
        box(
            (-0.045, 0.045),
            (y[0] - 0.055, y[0] - 0.02),
            (level[0] - REVEAL, level[1] + REVEAL),
            material,
        ),
    )
    origin = (0.0, pivot, level[0])
    return Moving(
        "pedal", solids, JointKind.REVOLUTE, (1.0, 0.0, 0.0), origin, float(np.radians(8.0))
    )


MAKERS = {"laptop": laptop, "trash_can": trash_can}
