"""Refrigerators, freezers and wine coolers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation, JointKind
from .casework import Style, casework
from .grips import any_grip
from .layouts import Node, row, stack
from .limbs import Limb, built, sliding, swinging
from .looks import BLACK, GLASS, STEEL, WHITE
from .pieces import Block, Form, Piece
from .solids import Span
from .stands import stood
from .styles import any_color, any_metal, any_style, drawn

#: Wider than this, a door of a fridge is two.
WIDE = 0.75


def extent(pieces: tuple[Piece, ...]) -> tuple[Span, Span, Span]:
    """Spans of the box around pieces [m]."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for piece in pieces:
        if isinstance(piece, Form):
            low, high = (
                np.minimum(low, piece.vertices.min(axis=0)),
                np.maximum(high, piece.vertices.max(axis=0)),
            )
        else:
            ends = np.array([piece.x, piece.y, piece.z])
            low, high = np.minimum(low, ends[:, 0]), np.maximum(high, ends[:, 1])
    x, y, z = ((float(a), float(b)) for a, b in zip(low, high, strict=True))
    return x, y, z


def _front(rng: np.random.Generator, width: float, height: float) -> Node:
    if height < 1.0:
        return "door" if width < WIDE else "double"
    small, chance = float(rng.uniform(0.26, 0.4)), rng.random()
    if width > WIDE:
        low: Node = "drawer" if rng.random() < 0.6 else stack((1.0, "drawer"), (0.8, "drawer"))
        french = stack((small, low), (1.0 - small, "double"))
        beside = row((float(rng.uniform(0.38, 0.5)), "door"), (0.55, "door"))
        return (
            beside
            if chance < 0.35
            else french
            if chance < 0.75
            else stack((0.45, "double"), (0.55, "double"))
        )
    if chance < 0.65:
        below, above = (1.0 - small, small) if chance < 0.35 else (small, 1.0 - small)
        return stack((below, "door"), (above, "door"))
    return stack((0.3, "drawer"), (0.7, "door")) if chance < 0.8 else "door"


def _style(rng: np.random.Generator, glazed: bool) -> Style:
    skin = any_color(rng)
    wall = float(rng.uniform(0.025, 0.06))
    panel = "glazed" if glazed else drawn(rng, {"slab": 0.6, "bevel": 0.25, "bowed": 0.15})
    style = any_style(rng, {panel: 1.0}, 0.0, 1.0 if glazed else 0.7)
    grip = any_grip(rng, any_metal(rng), ("bar", "rail", "bow", "bow", "recess", "none"))
    return replace(
        style,
        board=wall,
        front=float(rng.uniform(0.03, 0.08)),
        gap=float(rng.uniform(0.002, 0.008)),
        reveal=0.0,
        rail=float(rng.uniform(0.05, 0.09)),
        grip=replace(grip, length=float(rng.uniform(0.15, 0.9))),
        grip_at=float(rng.choice([0.3, 0.5, 0.7])),
        body=skin,
        face=skin if rng.random() < 0.7 else any_color(rng),
        inside=WHITE,
        shelves=0,
        bare=False,
    )


def fridge(rng: np.random.Generator, kind: str) -> Articulation:
    """A refrigerator.

    Args:
        rng: where it comes from.
        kind: ``tall``, ``mini`` or ``wine``.
    """
    sizes = {
        "tall": ((0.5, 1.1), (0.55, 0.75), (1.2, 1.95)),
        "mini": ((0.4, 0.65), (0.4, 0.62), (0.45, 0.95)),
        "wine": ((0.3, 0.65), (0.45, 0.65), (0.5, 1.8)),
    }[kind]
    width, depth, height = (float(rng.uniform(*s)) for s in sizes)
    style = _style(rng, kind == "wine")
    base = float(rng.choice([0.0, 0.02, 0.05, 0.1]))
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    node: Node = "door" if kind == "wine" else _front(rng, width, height)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, drawn(rng, {"plinth": 0.5, "feet": 0.5}), x, y, base, BLACK)
    inner = _stocked(rng, style, limbs, y, width) if style.hollow else ([], [])
    if not all(
        abs(limb.origin[0] - end) < 0.01
        for limb in limbs
        if _is_door(limb)
        for end in [_nearer(limb, width)]
    ):
        inner = (inner[0], [])
    limbs = _binned(rng, style, limbs, x) if style.hollow and kind != "wine" else limbs
    if inner[1]:
        limbs = [_wide_open(rng, limb) for limb in limbs]
    extra = _on_doors(rng, style, limbs) if kind == "tall" else []
    return built([*body, *inner[0]], [*limbs, *inner[1], *extra])


def _nearer(limb: Limb, width: float) -> float:
    return 0.0 if limb.axis[2] < 0 else width


def _is_door(limb: Limb) -> bool:
    return limb.kind is JointKind.REVOLUTE


def _wide_open(rng: np.random.Generator, limb: Limb) -> Limb:
    return (
        replace(limb, upper=float(np.radians(rng.integers(155, 172)))) if _is_door(limb) else limb
    )


def _stocked(
    rng: np.random.Generator, style: Style, limbs: list[Limb], y: Span, width: float
) -> tuple[list[Piece], list[Limb]]:
    """Shelves behind the doors; crispers at the bottom of a door's room, or an ice box at its top."""
    body: list[Piece] = []
    inner: list[Limb] = []
    with_inner = rng.random() < 0.45
    deep = (y[0] + 0.13, y[1] - 0.008)
    for limb in limbs:
        if not _is_door(limb):
            continue
        (x, _, z), b = extent(limb.pieces), style.board
        room_x = (
            max(x[0], b) + (0.0 if x[0] < b else b / 2),
            min(x[1], width - b) - (0.0 if x[1] > width - b else b / 2),
        )
        room_z = (z[0] + b, z[1] - b)
        count = int((room_z[1] - room_z[0]) / float(rng.uniform(0.18, 0.35)))
        levels = np.linspace(*room_z, count + 2)[1:-1]
        body += [Block(room_x, deep, (float(v), float(v) + 0.006), GLASS) for v in levels]
        if with_inner and count >= 1 and len(inner) < 3 and room_x[1] - room_x[0] > 0.25:
            top = float(levels[0]) if rng.random() < 0.7 else 0.0
            name = f"inner_{len(inner)}"
            if top > 0.0:
                inner.append(_crisper(name, room_x, deep, (room_z[0] + 0.004, top - 0.004)))
            else:
                span = (float(levels[-1]) + 0.008, room_z[1] - 0.004)
                lid_x = (room_x[0] + 0.004, room_x[1] - 0.004)
                panel = [Block(lid_x, (deep[0] - 0.02, deep[0] - 0.004), span, WHITE)]
                inner.append(
                    swinging(name, panel, lid_x, span, deep[0] - 0.02, "top", float(np.radians(88)))
                )
    return body, inner


def _crisper(name: str, x: Span, y: Span, z: Span) -> Limb:
    low, high, t = (x[0] + 0.006, x[1] - 0.006), min(z[1], z[0] + 0.22), 0.004
    pieces = [
        Block((low[0], low[0] + t), y, (z[0], high), WHITE),
        Block((low[1] - t, low[1]), y, (z[0], high), WHITE),
        Block(low, (y[0], y[0] + t), (z[0], high), GLASS),
        Block(low, (y[1] - t, y[1]), (z[0], high), WHITE),
        Block(low, y, (z[0], z[0] + t), WHITE),
        Block(
            ((low[0] + low[1]) / 2 - 0.05, (low[0] + low[1]) / 2 + 0.05),
            (y[0] - 0.012, y[0]),
            (high - 0.02, high),
            WHITE,
        ),
    ]
    origin = ((x[0] + x[1]) / 2, y[0], (z[0] + high) / 2)
    return sliding(name, pieces, (0.0, -1.0, 0.0), origin, round(0.7 * (y[1] - y[0]), 3))


def _binned(rng: np.random.Generator, style: Style, limbs: list[Limb], outer: Span) -> list[Limb]:
    """Doors with a lining and bins on their inner side, which pass the walls on their way out."""
    depth = float(rng.uniform(0.05, 0.1))
    result = []
    for limb in limbs:
        if not _is_door(limb) or rng.random() < 0.2:
            result.append(limb)
            continue
        x, y, z = extent(limb.pieces)
        left = limb.axis[2] < 0
        wall = {True: style.board, False: style.board / 2}
        reach = y[1] - limb.origin[1] + depth
        inner = (x[0] + wall[x[0] <= outer[0] + 1e-6], x[1] - wall[x[1] >= outer[1] - 1e-6])
        run = (inner[1] - limb.origin[0] if left else limb.origin[0] - inner[0]) - 0.004
        if run <= reach + 0.1:
            result.append(limb)
            continue
        far = float(np.sqrt(run**2 - reach**2)) - 0.002
        span = (
            (inner[0] + 0.015, limb.origin[0] + far)
            if left
            else (limb.origin[0] - far, inner[1] - 0.015)
        )
        bins: list[Piece] = []
        if rng.random() < 0.5:
            lining = (z[0] + style.board + 0.01, z[1] - style.board - 0.01)
            bins.append(Block(span, (y[1], y[1] + 0.35 * depth), lining, WHITE))
        levels = np.arange(
            z[0] + style.board + 0.03, z[1] - style.board - 0.14, float(rng.uniform(0.2, 0.34))
        )
        for v in levels:
            bins += [
                Block(span, (y[1], y[1] + depth), (v, v + 0.005), WHITE),
                Block(span, (y[1] + depth - 0.005, y[1] + depth), (v + 0.005, v + 0.07), WHITE),
            ]
        result.append(replace(limb, pieces=(*limb.pieces, *bins)))
    return result


def _on_doors(rng: np.random.Generator, style: Style, limbs: list[Limb]) -> list[Limb]:
    """A water dispenser's paddle, or a smaller door on a door."""
    doors = [limb for limb in limbs if _is_door(limb) and not limb.name.startswith("inner")]
    if not doors or style.panel == "bowed" or rng.random() < 0.7:
        return []
    door = doors[0]
    (x, _, z), face = extent(door.pieces[:1]), door.pieces[0]
    if not isinstance(face, Block) or x[1] - x[0] < 0.3 or z[1] - z[0] < 0.6:
        return []
    front = face.y[0] - (0.006 if style.panel == "bevel" else 0.0)
    margin = 0.1
    area_x = (x[0] + margin, x[1] - margin)
    middle = (z[0] + z[1]) / 2
    if rng.random() < 0.5:
        at = (area_x[0] + area_x[1]) / 2
        pad = Block(
            (at - 0.03, at + 0.03), (front - 0.014, front - 0.006), (middle, middle + 0.08), BLACK
        )
        return [sliding("paddle", [pad], (0.0, 1.0, 0.0), (at, front, middle), 0.005, door.name)]
    span = (middle - 0.05, z[1] - margin)
    flap = Block(area_x, (front - 0.016, front - 0.002), span, STEEL)
    return [
        swinging(
            "door_in_door",
            [flap],
            area_x,
            span,
            front - 0.016,
            "bottom",
            float(np.radians(80)),
            door.name,
        )
    ]


def _of(kind: str) -> Callable[[np.random.Generator], Articulation]:
    return lambda rng: fridge(rng, kind)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "refrigerator": _of("tall"),
    "mini_fridge": _of("mini"),
    "wine_cooler": _of("wine"),
}
