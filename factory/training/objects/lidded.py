"""Boxes with lids, and safes: chests, freezers, benches, strong doors with dials and wheels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...mesh import Material
from .cooking import keypad
from .grips import dial
from .hinges import swing
from .limbs import Limb, built, sliding, swinging, turning
from .looks import BLACK, GLASS, STEEL, WHITE
from .panels import framed, within
from .pieces import Block, Piece, extruded, hoop, rod
from .solids import Span
from .stands import stood
from .styles import any_color, any_metal, drawn


def _trough(x: Span, y: Span, z: Span, wall: float, look: Material) -> list[Piece]:
    inner = within(x, wall)
    return [
        Block((x[0], inner[0]), y, z, look),
        Block((inner[1], x[1]), y, z, look),
        Block(inner, (y[0], y[0] + wall), z, look),
        Block(inner, (y[1] - wall, y[1]), z, look),
        Block(inner, within(y, wall), (z[0], z[0] + wall), look),
    ]


def _lid(
    rng: np.random.Generator,
    x: Span,
    y: Span,
    z: float,
    thick: float,
    look: Material,
    name: str,
    side: str,
) -> Limb:
    """A lid over z = ``z``, hinged at its back or at one end; its axis lies at its lower or upper edge."""
    gap, arched = (
        float(rng.choice([0.0, 0.001, 0.003])),
        bool(rng.random() < 0.25 and side == "back"),
    )
    over = float(rng.choice([0.0, 0.005, 0.015]))
    low = z + gap
    free_y, free_x = (y[0] - over, y[1]), (x[0] - over, x[1] + over) if side == "back" else x
    pieces: list[Piece]
    if arched:
        t = np.linspace(0.0, np.pi, 11)
        middle, half = sum(free_y) / 2, (free_y[1] - free_y[0]) / 2
        rise = float(rng.uniform(0.15, 0.6)) * half
        # Next axes of x in cyclic order are y and z.
        arc = np.stack([middle + half * np.cos(t), low + thick + rise * np.sin(t)], axis=1)
        pieces = [extruded(0, np.vstack([arc, [(free_y[0], low), (free_y[1], low)]]), free_x, look)]
    else:
        pieces = [Block(free_x, free_y, (low, low + thick), look)]
        if rng.random() < 0.3:
            pieces += [
                Block(
                    within(free_x, 0.03),
                    within(free_y, 0.03),
                    (low + thick, low + thick + 0.006),
                    look,
                )
            ]
    if side == "back" and rng.random() < 0.5:
        at = sum(free_x) / 2
        pieces.append(
            Block(
                (at - 0.05, at + 0.05),
                (free_y[0] - 0.015, free_y[0]),
                (low, low + 0.6 * thick),
                BLACK,
            )
        )
    upper = float(np.radians(rng.integers(60, 106)))
    level = low if rng.random() < 0.6 or upper > 1.6 else low + thick
    axis, origin = {
        "back": ((-1.0, 0.0, 0.0), (sum(free_x) / 2, free_y[1], level)),
        "left": ((0.0, -1.0, 0.0), (free_x[0], sum(free_y) / 2, level)),
        "right": ((0.0, 1.0, 0.0), (free_x[1], sum(free_y) / 2, level)),
    }[side]
    return turning(name, pieces, axis, origin, upper)


def coffer(rng: np.random.Generator) -> Articulation:
    """A chest, a bench or a freezer: one lid hinged at its back, or two beside each other."""
    width, depth, height = (
        float(rng.uniform(0.4, 1.7)),
        float(rng.uniform(0.3, 0.7)),
        float(rng.uniform(0.25, 0.9)),
    )
    base, wall = float(rng.choice([0.0, 0.03, 0.08])), float(rng.uniform(0.012, 0.06))
    look = any_color(rng)
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    hollow = rng.random() < 0.75
    body: list[Piece] = _trough(x, y, z, wall, look) if hollow else [Block(x, y, z, look)]
    body += stood(rng, drawn(rng, {"feet": 1.0, "plinth": 1.0, "round": 0.5}), x, y, base, look)
    thick, lid_look = float(rng.uniform(0.015, 0.08)), any_color(rng)
    if width > 0.9 and rng.random() < 0.4:
        half = width / 2
        limbs = [
            _lid(rng, (a + 0.016, b - 0.016), y, z[1], thick, lid_look, f"lid_{i}", "back")
            for i, (a, b) in enumerate(((0.0, half), (half, width)))
        ]
    else:
        limbs = [_lid(rng, x, y, z[1], thick, lid_look, "lid", "back")]
    if rng.random() < 0.3:
        for edge in (x[0] - 0.02, x[1]):
            body.append(
                Block(
                    (edge, edge + 0.02),
                    (0.4 * depth, 0.6 * depth),
                    (0.7 * height, 0.7 * height + 0.02),
                    BLACK,
                )
            )
    return built(body, limbs)


def glass_freezer(rng: np.random.Generator) -> Articulation:
    """A shop's freezer: two panes that slide over its top."""
    width, depth, height = (
        float(rng.uniform(0.9, 2.0)),
        float(rng.uniform(0.5, 0.8)),
        float(rng.uniform(0.7, 0.95)),
    )
    look, wall = any_color(rng), 0.06
    x, y = (0.0, width), (0.0, depth)
    body = _trough(x, y, (0.03, height), wall, look) + stood(rng, "feet", x, y, 0.03, BLACK)
    inner, lap = within(x, wall), float(rng.uniform(0.02, 0.08))
    limbs = []
    for i, sign in enumerate((1.0, -1.0)):
        span = (inner[0], width / 2 + lap) if sign > 0 else (width / 2 - lap, inner[1])
        low = height + 0.002 + i * 0.014
        pieces: list[Piece] = [Block(span, within(y, wall - 0.01), (low, low + 0.006), GLASS)]
        edge = span[0] if sign > 0 else span[1] - 0.02
        pieces.append(Block((edge, edge + 0.02), within(y, wall - 0.01), (low, low + 0.012), WHITE))
        travel = round(inner[1] - inner[0] - (span[1] - span[0]) - 0.01, 3)
        limbs.append(
            sliding(f"pane_{i}", pieces, (sign, 0.0, 0.0), (sum(span) / 2, depth / 2, low), travel)
        )
    for edge in (0.0, depth - wall + 0.012):
        body.append(Block(x, (edge, edge + wall - 0.012), (height, height + 0.03), look))
    return built(body, limbs)


def safe(rng: np.random.Generator) -> Articulation:
    """A strong box: on its door a dial, a wheel, a lever or keys, which move with it."""
    width, depth, height = (
        float(rng.uniform(0.28, 0.75)),
        float(rng.uniform(0.25, 0.65)),
        float(rng.uniform(0.22, 1.2)),
    )
    wall, base = float(rng.uniform(0.02, 0.07)), float(rng.choice([0.0, 0.02]))
    look, metal = any_color(rng), any_metal(rng)
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    thick, gap = float(rng.uniform(0.02, 0.06)), float(rng.uniform(0.001, 0.004))
    inset = bool(rng.random() < 0.6)
    body: list[Piece] = stood(rng, "feet", x, y, base, BLACK)
    start = thick + 0.003 if inset else 0.0
    if rng.random() < 0.75:
        body += framed(x, y, z, wall, look)
        body.append(Block(within(x, wall), (depth - wall, depth), within(z, wall), look))
        if height > 0.4:
            level = z[0] + 0.5 * height
            body.append(
                Block(within(x, wall), (start + 0.05, depth - wall), (level, level + 0.01), metal)
            )
    else:
        body.append(Block(x, (start, depth), z, look))
        body += framed(x, (0.0, start), z, wall, look) if inset else []
    side = "left" if rng.random() < 0.6 else "right"
    edge = wall + gap if inset else 0.0
    door_x, door_z = within(x, edge), within(z, edge)
    rooms = (gap, gap) if inset else (float("inf"), float("inf"))
    turn = swing(
        rng, thick, door_x[1] - door_x[0], rooms, 0.0 if inset else 0.5, 110.0 if inset else 150.0
    )
    door_x = (
        (door_x[0], door_x[1] - turn.trim) if side == "left" else (door_x[0] + turn.trim, door_x[1])
    )
    face = 0.0 if inset else -thick - 0.001
    pieces: list[Piece] = [Block(door_x, (face, face + thick), door_z, look)]
    if inset and rng.random() < 0.5:
        hinge_x = x[0] + wall / 2 if side == "left" else x[1] - wall / 2
        for share in (0.2, 0.8):
            level = z[0] + share * height
            body.append(
                rod(
                    2,
                    (hinge_x, face - 0.001),
                    min(0.008, 0.3 * wall),
                    (level - 0.03, level + 0.03),
                    metal,
                )
            )
    door = swinging("door", pieces, door_x, door_z, face + turn.setback, side, turn.upper)
    return built(body, [door, *_locks(rng, door_x, door_z, face, side, metal)])


def _locks(
    rng: np.random.Generator, x: Span, z: Span, face: float, side: str, metal: Material
) -> list[Limb]:
    """What turns and gives way on a safe's door."""
    free = 0.3 if side == "right" else 0.7
    at, level = x[0] + free * (x[1] - x[0]), (z[0] + z[1]) / 2
    room = min(x[1] - x[0], z[1] - z[0])
    limbs: list[Limb] = []
    if rng.random() < 0.6:
        looks = (STEEL if metal is not STEEL else BLACK, WHITE)
        limbs.append(dial(rng, "dial", at, level + 0.2 * room, face, 0.09 * room, looks))
    elif room > 0.15:
        area = ((x[0] + x[1]) / 2 - 0.16 * room, (x[0] + x[1]) / 2 + 0.16 * room)
        limbs += keypad(rng, area, (level + 0.08 * room, level + 0.36 * room), face)
    r, low = 0.16 * room, level - 0.2 * room
    chance = rng.random()
    if chance < 0.4:
        hub: list[Piece] = [rod(1, (low, at), 0.25 * r, (face - 0.05, face - 0.001), metal)]
        hub.append(hoop(1, (low, at), (0.85 * r, r), (face - 0.05, face - 0.04), metal, 20))
        hub.append(
            Block(
                (at - 0.9 * r, at + 0.9 * r),
                (face - 0.048, face - 0.042),
                (low - 0.006, low + 0.006),
                metal,
            )
        )
        hub.append(
            Block(
                (at - 0.006, at + 0.006),
                (face - 0.048, face - 0.042),
                (low - 0.9 * r, low + 0.9 * r),
                metal,
            )
        )
        limbs.append(
            turning(
                "wheel", hub, (0.0, 1.0, 0.0), (at, face, low), float(rng.choice([1.57, 3.14, 6.2]))
            )
        )
    elif chance < 0.75:
        lever: list[Piece] = [rod(1, (low, at), 0.012, (face - 0.035, face - 0.001), metal)]
        inward = -1.0 if side == "left" else 1.0
        ends = sorted((at - inward * 0.012, at + inward * 1.6 * r))
        lever.append(
            Block(
                (ends[0], ends[1]), (face - 0.043, face - 0.033), (low - 0.009, low + 0.009), metal
            )
        )
        axis = (0.0, -inward, 0.0)
        limbs.append(
            turning("handle", lever, axis, (at, face, low), float(np.radians(rng.integers(45, 91))))
        )
    return [replace(limb, parent="door") for limb in limbs]


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "coffer": coffer,
    "glass_freezer": glass_freezer,
    "safe": safe,
}
