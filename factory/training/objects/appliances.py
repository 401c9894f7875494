"""Fridges, ovens, microwaves and dishwashers: a cavity, and what closes it."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Material, Mesh
from .looks import BLACK, GLASS, RED, STEEL, WHITE, pick
from .parts import (
    GAP,
    REVEAL,
    Moving,
    assemble,
    carcass,
    cavity,
    degrees,
    drawer,
    drop_door,
    feet,
    handle,
    knob,
    millimetres,
    side_door,
)
from .solids import Span, box, cylinder


def fridge(rng: np.random.Generator) -> Articulation:
    """Two doors, freezer above or below, hinged on one side; shelves inside and bins in the doors."""
    wall, thick, base = 0.04, 0.055, 0.03
    width, depth, height = (
        millimetres(rng, 0.56, 0.72),
        millimetres(rng, 0.56, 0.64),
        millimetres(rng, 1.35, 1.75),
    )
    skin, metal = pick(rng, WHITE, STEEL, RED), pick(rng, STEEL, BLACK)
    x, z = (-width / 2, width / 2), (base, base + height)
    y = (-depth / 2 + thick + GAP, depth / 2)
    solids = carcass(x, y, z, wall, skin, back=wall) + feet(x, y, base, 0.05, BLACK)
    inner_x, (_, back), inner_z = cavity(x, y, z, wall, back=wall)
    share = millimetres(rng, 0.28, 0.36)
    cut = round(z[0] + height * (share if rng.random() < 0.5 else 1.0 - share), 3)
    solids.append(box(inner_x, (y[0] + 2 * REVEAL, back), (cut - wall / 2, cut + wall / 2), skin))
    hinge, upper = str(rng.choice(["left", "right"])), degrees(rng, 90, 110)
    moving: list[Moving] = []
    for name, low, high in (
        ("lower_door", z[0], cut - GAP / 2),
        ("upper_door", cut + GAP / 2, z[1]),
    ):
        free_z = (
            max(low, inner_z[0]) if low == z[0] else cut + wall / 2,
            inner_z[1] if high == z[1] else cut - wall / 2,
        )
        shelves = max(1, int((free_z[1] - free_z[0]) / 0.28))
        levels = np.linspace(free_z[0], free_z[1], shelves + 2)[1:-1]
        solids += [
            box(inner_x, (y[0] + 0.14, back), (v, v + 0.006), GLASS) for v in np.round(levels, 3)
        ]
        door = _fridge_door(
            x, (y[0] - GAP - thick, y[0] - GAP), (low, high), free_z, hinge, skin, metal
        )
        moving.append(side_door(name, door, x, y[0] - GAP - thick, (low, high), hinge, upper))
    return assemble(solids, moving)


def _fridge_door(
    x: Span, y: Span, z: Span, free_z: Span, hinge: str, skin: Material, metal: Material
) -> list[Mesh]:
    wall, bin_depth = 0.04, 0.08
    solids = [box(x, y, z, skin)]
    # On its way out the bin's far inner corner must pass the wall: it turns about the door's front
    # edge.
    radius = x[1] - x[0] - wall - GAP
    reach = y[1] - y[0] + bin_depth
    far = wall + GAP + radius - float(np.sqrt(radius**2 - reach**2)) + 0.002
    near = wall + 0.012
    bin_x = (x[0] + near, x[1] - far) if hinge == "left" else (x[0] + far, x[1] - near)
    for level in np.round(
        np.linspace(free_z[0] + 0.03, free_z[1] - 0.2, 2 if free_z[1] - free_z[0] < 0.7 else 3), 3
    ):
        bottom = (float(level), float(level) + 0.006)
        solids.append(box(bin_x, (y[1], y[1] + bin_depth), bottom, WHITE))
        lip = (bin_x[0] + REVEAL, bin_x[1] - REVEAL)
        solids.append(
            box(
                lip,
                (y[1] + bin_depth - 0.007, y[1] + bin_depth - REVEAL),
                (bottom[1], bottom[1] + 0.06),
                WHITE,
            )
        )
    length = min(0.4, 0.6 * (z[1] - z[0]))
    grip_x = x[1] - 0.04 if hinge == "left" else x[0] + 0.04
    return solids + handle("rail", grip_x, y[0], (z[0] + z[1]) / 2, True, length, metal)


def oven(rng: np.random.Generator) -> Articulation:
    """A range: drop door with a window, knobs above it, a drawer below it, burners on top."""
    board, thick = 0.018, 0.035
    width, depth, height = (
        millimetres(rng, 0.55, 0.7),
        millimetres(rng, 0.56, 0.64),
        millimetres(rng, 0.84, 0.92),
    )
    skin, metal = pick(rng, WHITE, STEEL, BLACK), pick(rng, STEEL, BLACK)
    x, z = (-width / 2, width / 2), (0.03, height)
    y = (-depth / 2 + thick + GAP, depth / 2)
    solids = carcass(x, y, z, board, skin) + feet(x, y, 0.03, 0.04, BLACK)
    inner_x, (_, back), inner_z = cavity(x, y, z, board)
    panel_z, drawer_z = (height - 0.11, height), (0.034, 0.19)
    front_y, back_y = y[0] - GAP - thick, y[0] - GAP
    # The control panel belongs to the body and touches it.
    solids.append(
        box(
            (x[0] + REVEAL, x[1] - REVEAL),
            (front_y, y[0]),
            (panel_z[0], panel_z[1] - 2 * REVEAL),
            skin,
        )
    )
    for level in (drawer_z[1], panel_z[0] - 0.02):
        solids.append(box(inner_x, (y[0] + 0.002, back), (level - 0.007, level + 0.007), skin))
    shelf = round((drawer_z[1] + panel_z[0]) / 2, 3)
    solids.append(box(inner_x, (y[0] + 0.03, back), (shelf, shelf + 0.006), metal))
    for bx in (-width / 4, width / 4):
        for by in (-depth / 5, depth / 5):
            solids.append(
                cylinder(2, (bx, by + 0.02), 0.08, (height - REVEAL, height + 0.006), BLACK)
            )
    door_z = (drawer_z[1] + GAP, panel_z[0] - GAP)
    moving = [_oven_door(x, (front_y, back_y), door_z, skin, metal, degrees(rng, 85, 90))]
    count = int(rng.integers(2, 6))
    for i, place in enumerate(np.round(np.linspace(-0.36, 0.36, count) * width, 3)):
        moving.append(
            knob(
                f"knob_{i}", float(place), front_y, (panel_z[0] + panel_z[1]) / 2, 0.022, metal, RED
            )
        )
    low = [box(x, (front_y, back_y), drawer_z, skin)]
    low += handle("rail", 0.0, front_y, drawer_z[1] - 0.045, False, 0.3, metal)
    box_x, box_z = (inner_x[0] + GAP, inner_x[1] - GAP), (inner_z[0] + GAP, drawer_z[1] - 0.025)
    moving.append(drawer("drawer", low, box_x, (back_y, back - 0.05), box_z, metal, wall=0.004))
    return assemble(solids, moving)


def _oven_door(x: Span, y: Span, z: Span, skin: Material, metal: Material, upper: float) -> Moving:
    window_x, window_z = (x[0] + 0.09, x[1] - 0.09), (z[0] + 0.1, z[1] - 0.13)
    face = y[0] + 0.003
    solids = [
        box(x, (face, y[1]), z, skin),
        box(window_x, (y[0], face), window_z, GLASS),
    ]
    solids += handle("bar", 0.0, face, z[1] - 0.06, False, 0.8 * (x[1] - x[0]), metal)
    return drop_door("door", solids, x, y[0], z[0], upper)


def microwave(rng: np.random.Generator) -> Articulation:
    """A side door with a window, a control panel with buttons and a knob, a glass plate inside."""
    board, thick, base = 0.016, 0.028, 0.012
    width, depth, height = (
        millimetres(rng, 0.46, 0.56),
        millimetres(rng, 0.34, 0.42),
        millimetres(rng, 0.26, 0.31),
    )
    skin, dark = pick(rng, WHITE, STEEL, BLACK), pick(rng, BLACK, STEEL)
    x, z = (-width / 2, width / 2), (base, base + height)
    y = (-depth / 2 + thick + GAP, depth / 2)
    solids = carcass(x, y, z, board, skin) + feet(x, y, base, 0.03, BLACK)
    _, (_, back), inner_z = cavity(x, y, z, board)
    cut = round(x[0] + 0.74 * width, 3)
    face = y[0] - GAP - thick
    solids.append(box((cut, cut + board), (y[0] + 0.002, back), inner_z, skin))
    panel_x = (cut + GAP / 2, x[1] - REVEAL)
    solids.append(box(panel_x, (face, y[0]), z, dark))
    middle = (panel_x[0] + panel_x[1]) / 2
    for row in range(4):
        for offset in (-0.028, 0.0, 0.028):
            low = z[0] + 0.025 + 0.026 * row
            button = (middle + offset - 0.01, middle + offset + 0.01)
            solids.append(
                box(
                    button,
                    (face - 0.002, face),
                    (low, low + 0.016),
                    WHITE if dark is BLACK else BLACK,
                )
            )
    inside = (x[0] + board + cut) / 2
    solids.append(
        cylinder(2, (inside, (y[0] + back) / 2), 0.11, (inner_z[0], inner_z[0] + 0.008), GLASS)
    )
    door_x = (x[0], cut - GAP / 2)
    door = [
        box(door_x, (face + 0.002, y[0] - GAP), z, skin),
        box(
            (door_x[0] + 0.04, door_x[1] - 0.07),
            (face, face + 0.002),
            (z[0] + 0.04, z[1] - 0.04),
            GLASS,
        ),
    ]
    door += handle(
        "rail", door_x[1] - 0.03, face + 0.002, (z[0] + z[1]) / 2, True, 0.7 * height, dark
    )
    moving = [side_door("door", door, door_x, face, z, "left", degrees(rng, 90, 110))]
    moving.append(
        knob("knob", middle, face, z[1] - 0.05, 0.02, skin if dark is not skin else RED, RED)
    )
    return assemble(solids, moving)


def dishwasher(rng: np.random.Generator) -> Articulation:
    """A drop door over a tub with two racks, on a recessed plinth."""
    board, thick, base = 0.016, 0.03, millimetres(rng, 0.09, 0.11)
    width, depth, height = (
        millimetres(rng, 0.45, 0.6),
        millimetres(rng, 0.54, 0.6),
        millimetres(rng, 0.7, 0.76),
    )
    skin, dark = pick(rng, WHITE, STEEL, BLACK), pick(rng, BLACK, STEEL)
    x, z = (-width / 2, width / 2), (base, base + height)
    y = (-depth / 2 + thick + GAP, depth / 2)
    solids = carcass(x, y, z, board, skin)
    solids.append(box((x[0] + 0.004, x[1] - 0.004), (y[0] + 0.05, y[1] - 0.02), (0.0, base), BLACK))
    inner_x, (_, back), _ = cavity(x, y, z, board)
    for level in (z[0] + 0.12, z[0] + 0.12 + 0.45 * height):
        solids += _rack(inner_x, (y[0] + 0.03, back), round(level, 3))
    face = y[0] - GAP - thick
    strip = (z[1] - 0.1, z[1] - 0.002)
    door = [
        box(x, (face + 0.003, y[0] - GAP), z, skin),
        box((x[0] + REVEAL, x[1] - REVEAL), (face, face + 0.003), strip, dark),
    ]
    door += handle(
        "bar",
        0.0,
        face + 0.003,
        z[1] - 0.14,
        False,
        0.75 * width,
        dark if skin is not dark else RED,
    )
    return assemble(solids, [drop_door("door", door, x, face, z[0], degrees(rng, 85, 90))])


def _rack(x: Span, y: Span, level: float) -> list[Mesh]:
    """Two rails on the walls and rods across them."""
    rod = 0.004
    rails = [
        box((x[0], x[0] + 0.01), y, (level, level + 0.01), STEEL),
        box((x[1] - 0.01, x[1]), y, (level, level + 0.01), STEEL),
    ]
    rods_y = np.round(np.linspace(y[0] + 0.02, y[1] - 0.02, 7), 3)
    low = level + 0.003
    return rails + [
        box((x[0] + 0.01, x[1] - 0.01), (v, v + rod), (low, low + rod), STEEL) for v in rods_y
    ]


MAKERS = {"fridge": fridge, "oven": oven, "microwave": microwave, "dishwasher": dishwasher}
