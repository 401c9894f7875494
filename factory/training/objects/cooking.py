"""Ranges, ovens, hobs, hoods, microwaves and dishwashers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...mesh import Material
from .casework import Style, casework
from .cooling import extent
from .grips import any_grip, button, dial
from .layouts import Node, row, stack
from .limbs import Limb, built, sliding, turning
from .looks import BLACK, GLASS, RED, STEEL, WHITE, pick
from .pieces import Block, Piece, frustum, hoop, rod, turned
from .solids import Span
from .stands import stood
from .styles import any_metal, any_style, drawn

Looks = tuple[Material, Material]


def _style(rng: np.random.Generator, panels: dict[str, float]) -> Style:
    skin = pick(rng, WHITE, STEEL, BLACK, STEEL)
    style = any_style(rng, panels, 0.0, 0.72)
    grip = any_grip(rng, any_metal(rng), ("bar", "bar", "rail", "bow", "recess"))
    return replace(
        style,
        board=float(rng.uniform(0.012, 0.03)),
        front=float(rng.uniform(0.018, 0.045)),
        gap=float(rng.uniform(0.0015, 0.006)),
        reveal=0.0,
        rail=float(rng.uniform(0.06, 0.11)),
        drawer="slab",
        grip=replace(grip, length=float(rng.uniform(0.25, 0.6))),
        grip_at=0.5,
        drawer_grip_at=0.75,
        shelves=0,
        bare=False,
        body=skin,
        face=skin if rng.random() < 0.7 else pick(rng, STEEL, BLACK, WHITE),
    )


def rack(x: Span, y: Span, z: float, rods: int, along_y: bool, material: Material) -> list[Piece]:
    """A wire shelf: a rim and rods across it [m]."""
    t = 0.006
    pieces: list[Piece] = [
        Block(x, (y[0], y[0] + t), (z, z + t), material),
        Block(x, (y[1] - t, y[1]), (z, z + t), material),
        Block((x[0], x[0] + t), (y[0] + t, y[1] - t), (z, z + t), material),
        Block((x[1] - t, x[1]), (y[0] + t, y[1] - t), (z, z + t), material),
    ]
    span = x if along_y else y
    for v in np.linspace(span[0] + t, span[1] - t, rods + 2)[1:-1]:
        wire = (float(v) - 0.0015, float(v) + 0.0015)
        if along_y:
            pieces.append(Block(wire, (y[0] + t, y[1] - t), (z + 0.001, z + 0.004), material))
        else:
            pieces.append(Block((x[0] + t, x[1] - t), wire, (z + 0.001, z + 0.004), material))
    return pieces


def knobs(
    rng: np.random.Generator, x: Span, z: float, face: float, height: float, looks: Looks
) -> list[Limb]:
    """A row of two to eight knobs on a face, even or in two groups."""
    count = int(rng.integers(2, 9))
    radius = min(0.42 * height, float(rng.uniform(0.014, 0.026)), 0.4 * (x[1] - x[0]) / count)
    places = np.linspace(x[0] + 1.5 * radius, x[1] - 1.5 * radius, count)
    if count >= 4 and rng.random() < 0.4:
        middle, half = (x[0] + x[1]) / 2, 0.12 * (x[1] - x[0])
        places = places[np.abs(places - middle) > half]
    return [dial(rng, f"knob_{i}", float(v), z, face, radius, looks) for i, v in enumerate(places)]


def burners(rng: np.random.Generator, x: Span, y: Span, z: float) -> list[Piece]:
    """Burners: plates, glass marks, or gas under grates."""
    style = int(rng.integers(3))
    pieces: list[Piece] = []
    columns = 2 if x[1] - x[0] < 0.75 else 3
    radius = 0.36 * min((x[1] - x[0]) / columns, (y[1] - y[0]) / 2)
    for bx in np.linspace(*x, 2 * columns + 1)[1::2]:
        for by in np.linspace(*y, 5)[1::2]:
            r = radius * float(rng.uniform(0.7, 1.0))
            at = (float(bx), float(by))
            if style == 0:
                pieces.append(
                    turned(2, at, [(z, r), (z + 0.008, r), (z + 0.01, 0.9 * r)], BLACK, 20)
                )
            elif style == 1:
                pieces.append(hoop(2, at, (0.92 * r, r), (z, z + 0.001), STEEL))
            else:
                pieces.append(
                    turned(
                        2, at, [(z, 0.4 * r), (z + 0.015, 0.4 * r), (z + 0.02, 0.3 * r)], BLACK, 16
                    )
                )
                pieces += _grate(at, 1.2 * radius, z)
    return pieces


def _grate(at: tuple[float, float], half: float, z: float) -> list[Piece]:
    t = 0.005
    top = (z + 0.025, z + 0.033)
    bars: list[Piece] = []
    for k in (-1.0, 0.0, 1.0):
        bars.append(
            Block(
                (at[0] - half, at[0] + half),
                (at[1] + k * half * 0.9 - t, at[1] + k * half * 0.9 + t),
                top,
                BLACK,
            )
        )
        bars.append(
            Block(
                (at[0] + k * half * 0.9 - t, at[0] + k * half * 0.9 + t),
                (at[1] - half, at[1] + half),
                top,
                BLACK,
            )
        )
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            px, py = at[0] + sx * half * 0.9, at[1] + sy * half * 0.9
            bars.append(Block((px - t, px + t), (py - t, py + t), (z, top[0]), BLACK))
    return bars


def stove(rng: np.random.Generator) -> Articulation:
    """A range: oven doors that drop, knobs before or behind the hob, often a drawer below."""
    style = _style(rng, {"glazed": 0.6, "slab": 0.3, "bevel": 0.1})
    width, depth, height = (
        float(rng.uniform(0.5, 1.2)),
        float(rng.uniform(0.5, 0.7)),
        float(rng.uniform(0.75, 0.92)),
    )
    base = float(rng.choice([0.0, 0.03, 0.1]))
    console = bool(rng.random() < 0.4)
    oven: Node = "flap"
    if width > 0.85 and rng.random() < 0.7:
        oven = row((float(rng.uniform(0.9, 1.8)), "flap"), (1.0, "flap"))
    elif rng.random() < 0.15:
        oven = stack((1.0, "flap"), (0.7, "flap"))
    share = float(rng.uniform(0.1, 0.17))
    parts: list[tuple[float, Node]] = [(0.78, oven)]
    if rng.random() < 0.6:
        parts.insert(
            0, (float(rng.uniform(0.15, 0.28)), "drawer" if rng.random() < 0.8 else "fixed")
        )
    if not console:
        parts.append((share, "fixed"))
    node: Node = ("v", tuple(parts)) if len(parts) > 1 else oven
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, drawn(rng, {"plinth": 0.5, "feet": 0.5}), x, y, base, BLACK)
    front = y[0] - style.behind - style.front
    looks = (any_metal(rng), pick(rng, RED, WHITE, BLACK))
    hob_y = (y[0], y[1] - (0.07 if console else 0.0))
    body += burners(rng, x, hob_y, z[1])
    if console or rng.random() < 0.3:
        tall = float(rng.uniform(0.08, 0.2))
        body.append(Block(x, (y[1] - 0.06, y[1]), (z[1], z[1] + tall), style.body))
    if console:
        limbs += knobs(rng, x, z[1] + 0.55 * tall, y[1] - 0.06, 0.7 * tall, looks)
    else:
        total = sum(s for s, _ in parts)
        low = z[1] - height * share / total
        limbs += knobs(rng, x, (low + z[1]) / 2, front, z[1] - low, looks)
    body += _racks(rng, style, limbs, y)
    return built(body, limbs)


def _racks(rng: np.random.Generator, style: Style, limbs: list[Limb], y: Span) -> list[Piece]:
    """Wire shelves behind every oven door, as part of the body."""
    pieces: list[Piece] = []
    for limb in limbs:
        if not style.hollow or "flap" not in limb.name:
            continue
        x, _, z = extent(limb.pieces)
        inner = (x[0] + style.board, x[1] - style.board)
        for share in np.linspace(0.0, 1.0, int(rng.integers(1, 4)) + 2)[1:-1]:
            level = z[0] + float(share) * (z[1] - z[0])
            rods = int(rng.integers(5, 14))
            pieces += rack(
                inner, (y[0] + 0.02, y[1] - 0.03), level, rods, bool(rng.random() < 0.5), STEEL
            )
    return pieces


def built_in_oven(rng: np.random.Generator) -> Articulation:
    """An oven without a hob: one or two doors under a panel with knobs and buttons."""
    style = _style(rng, {"glazed": 0.7, "slab": 0.3})
    width, depth = float(rng.uniform(0.35, 0.76)), float(rng.uniform(0.35, 0.6))
    height = float(rng.uniform(0.28, 0.65)) if rng.random() < 0.7 else float(rng.uniform(0.9, 1.3))
    share = float(rng.uniform(0.14, 0.24))
    door: Node = (
        stack((1.0, "flap"), (0.9, "flap"))
        if height > 0.8
        else "flap"
        if rng.random() < 0.8
        else "door"
    )
    beside = height < 0.45 and rng.random() < 0.4
    node = (
        row((0.76, door), (0.24, "fixed"))
        if beside
        else stack((1.0 - share, door), (share, "fixed"))
    )
    x, y, z = (0.0, width), (0.0, depth), (0.015, 0.015 + height)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, "feet", x, y, 0.015, BLACK)
    front = y[0] - style.behind - style.front
    looks = (any_metal(rng), RED)
    if beside:
        area = (x[0] + 0.78 * width, x[1] - 0.02)
        middle = (area[0] + area[1]) / 2
        radius = min(0.4 * (area[1] - area[0]), 0.025)
        for i, level in enumerate(np.linspace(*z, int(rng.integers(2, 5)) + 2)[1:-1]):
            limbs.append(dial(rng, f"knob_{i}", middle, float(level), front, radius, looks))
    else:
        low = z[1] - height * share
        limbs += knobs(rng, x, (low + z[1]) / 2, front, z[1] - low, looks)
    return built(body + _racks(rng, style, limbs, y), limbs)


def microwave_oven(rng: np.random.Generator) -> Articulation:
    """A door beside a panel of keys, some of which give way; a plate that turns."""
    style = _style(rng, {"glazed": 0.6, "slab": 0.4})
    width, depth, height = (
        float(rng.uniform(0.42, 0.8)),
        float(rng.uniform(0.3, 0.5)),
        float(rng.uniform(0.24, 0.45)),
    )
    share = float(rng.uniform(0.16, 0.3))
    right = bool(rng.random() < 0.85)
    kind = "door" if rng.random() < 0.85 else "flap"
    node = (
        row((1.0 - share, kind), (share, "fixed"))
        if right
        else row((share, "fixed"), (1.0 - share, kind))
    )
    style = replace(style, grip=replace(style.grip, length=0.7 * height), shelves=0)
    x, y, z = (0.0, width), (0.0, depth), (0.012, 0.012 + height)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, "feet", x, y, 0.012, BLACK)
    front = y[0] - style.behind - style.front
    area = (
        (x[1] - share * width + 0.012, x[1] - 0.012)
        if right
        else (x[0] + 0.012, x[0] + share * width - 0.012)
    )
    body.append(Block(area, (front - 0.001, front), (z[1] - 0.06, z[1] - 0.025), GLASS))
    keys = keypad(rng, area, (z[0] + 0.03, z[1] - 0.08), front)
    if rng.random() < 0.5:
        limbs += keys
    else:
        body += [piece for key in keys for piece in key.pieces]
    if style.hollow and rng.random() < 0.7:
        room = (x[0], x[1] - share * width) if right else (x[0] + share * width, x[1])
        at = ((room[0] + room[1]) / 2, (y[0] + y[1]) / 2)
        r = 0.4 * min(room[1] - room[0] - 2 * style.board, depth)
        low = z[0] + style.board + 0.004
        plate = turned(2, at, [(low, 0.9 * r), (low + 0.006, r)], GLASS, 24)
        limbs.append(turning("plate", [plate], (0.0, 0.0, 1.0), (*at, low), 6.2))
    return built(body, limbs)


def keypad(rng: np.random.Generator, x: Span, z: Span, face: float) -> list[Limb]:
    """A pad of keys, or one or two knobs over a long key."""
    if rng.random() < 0.35:
        middle, radius = (x[0] + x[1]) / 2, min(0.35 * (x[1] - x[0]), 0.024)
        levels = np.linspace(z[0], z[1], int(rng.integers(1, 3)) + 3)[1:-1]
        radius = min(radius, 0.45 * float(levels[1] - levels[0]))
        dials = [
            dial(rng, f"knob_{i}", middle, float(v), face, radius, (STEEL, RED))
            for i, v in enumerate(levels[1:])
        ]
        return [
            button(
                "button_0",
                (middle - radius, middle + radius),
                (z[0], z[0] + 0.015),
                face,
                0.004,
                WHITE,
                False,
            ),
            *dials,
        ]
    columns, rows = int(rng.integers(2, 4)), int(rng.integers(2, 7))
    cuts_x, cuts_z, proud = (
        np.linspace(*x, columns + 1),
        np.linspace(*z, rows + 1),
        float(rng.uniform(0.002, 0.005)),
    )
    is_round, margin = bool(rng.random() < 0.3), 0.003
    return [
        button(
            f"button_{r * columns + c}",
            (float(cuts_x[c]) + margin, float(cuts_x[c + 1]) - margin),
            (float(cuts_z[r]) + margin, float(cuts_z[r + 1]) - margin),
            face,
            proud,
            WHITE,
            is_round,
        )
        for r in range(rows)
        for c in range(columns)
    ]


def hob(rng: np.random.Generator) -> Articulation:
    """A hob on its own, its knobs before or upon it."""
    width, depth, height = (
        float(rng.uniform(0.3, 1.0)),
        float(rng.uniform(0.35, 0.55)),
        float(rng.uniform(0.04, 0.18)),
    )
    skin = pick(rng, STEEL, BLACK, WHITE)
    x, y, z = (0.0, width), (0.0, depth), (0.0, height)
    body: list[Piece] = [Block(x, y, z, skin)]
    looks = (any_metal(rng), RED)
    if height > 0.09:
        body += burners(rng, x, y, height)
        return built(body, knobs(rng, x, height / 2, y[0], height, looks))
    area = (0.82 * width, width) if rng.random() < 0.5 else None
    body += burners(rng, (0.0, 0.8 * width) if area else x, y if area else (0.14, depth), height)
    count = int(rng.integers(2, 7))
    if area:
        spots = [((area[0] + area[1]) / 2, float(v)) for v in np.linspace(*y, count + 2)[1:-1]]
    else:
        spots = [(float(v), 0.06) for v in np.linspace(*x, count + 2)[1:-1]]
    r = min(0.022, 0.35 * (depth if area else width) / (count + 1))
    limbs = []
    for i, at in enumerate(spots):
        low, tall = height + 0.001, float(rng.uniform(0.015, 0.03))
        pieces: list[Piece] = [turned(2, at, [(low, r), (low + tall, 0.85 * r)], looks[0], 16)]
        pieces.append(
            Block(
                (at[0] - 0.002, at[0] + 0.002),
                (at[1] - r, at[1]),
                (low + tall, low + tall + 0.002),
                RED,
            )
        )
        limbs.append(
            turning(
                f"knob_{i}",
                pieces,
                (0.0, 0.0, -1.0),
                (*at, low),
                float(rng.choice([1.57, 3.14, 4.71])),
            )
        )
    return built(body, limbs)


def hood(rng: np.random.Generator) -> Articulation:
    """An extractor hood: a visor that slides out or a pane that lifts, and buttons."""
    width, depth, low = (
        float(rng.uniform(0.5, 1.0)),
        float(rng.uniform(0.4, 0.55)),
        float(rng.uniform(0.05, 0.1)),
    )
    skin, x, y = pick(rng, STEEL, WHITE, BLACK), (0.0, width), (0.0, depth)
    pipe_x = (width / 2 - 0.13, width / 2 + 0.13)
    high = low + float(rng.uniform(0.12, 0.3))
    top = high + float(rng.uniform(0.3, 0.7))
    body: list[Piece] = [
        Block(x, y, (0.0, low), skin),
        frustum(2, (x, y), (pipe_x, (depth - 0.3, depth)), (low, high), skin),
        Block(pipe_x, (depth - 0.3, depth), (high, top), skin),
    ]
    limbs: list[Limb] = []
    proud = 0.004
    for i, v in enumerate(np.linspace(0.3, 0.7, int(rng.integers(2, 6)))):
        at = float(v) * width
        limbs.append(
            button(
                f"button_{i}",
                (at - 0.01, at + 0.01),
                (0.028, low - 0.006),
                y[0],
                proud,
                WHITE,
                True,
            )
        )
    if rng.random() < 0.6:
        body[0] = Block(x, y, (0.022, low), skin)
        body += [
            Block((x[0], 0.01), y, (0.0, 0.022), skin),
            Block((width - 0.01, x[1]), y, (0.0, 0.022), skin),
        ]
        visor = [Block((0.012, width - 0.012), (-0.02, depth - 0.05), (0.004, 0.02), skin)]
        limbs.append(
            sliding(
                "visor", visor, (0.0, -1.0, 0.0), (width / 2, -0.02, 0.012), round(0.6 * depth, 3)
            )
        )
    return built(body, limbs)


def dish_washer(rng: np.random.Generator) -> Articulation:
    """A door that drops, before racks that come out over it."""
    style = _style(rng, {"slab": 0.7, "bevel": 0.3})
    width, depth, height = (
        float(rng.uniform(0.42, 0.62)),
        float(rng.uniform(0.5, 0.65)),
        float(rng.uniform(0.6, 0.8)),
    )
    base = float(rng.uniform(0.05, 0.13))
    node: Node = "flap" if rng.random() < 0.6 else stack((0.86, "flap"), (0.14, "fixed"))
    x, y, z = (0.0, width), (0.0, depth), (base, base + height)
    body, limbs = casework(rng, style, x, y, z, node)
    body += stood(rng, "plinth", x, y, base, BLACK)
    if rng.random() < 0.4:
        body.append(Block((-0.01, width + 0.01), (y[0] - 0.03, y[1]), (z[1], z[1] + 0.03), WHITE))
    if style.hollow:
        limbs = [replace(limb, upper=max(limb.upper, float(np.radians(90)))) for limb in limbs]
        inner = (x[0] + style.board + 0.012, x[1] - style.board - 0.012)
        ceiling = z[0] + (0.86 if node != "flap" else 1.0) * height - style.board - 0.012
        count = int(rng.integers(1, 4))
        for i, low in enumerate(
            np.linspace(z[0] + style.board + 0.06, z[0] + 0.7 * height, 3)[:count]
        ):
            high = min(float(low) + float(rng.uniform(0.05, 0.13)), ceiling)
            pieces = rack(inner, (y[0] + 0.02, y[1] - 0.03), float(low), 12, True, STEEL)
            pieces += rack(inner, (y[0] + 0.02, y[1] - 0.03), high, 0, True, STEEL)
            for px in inner:
                for py in (y[0] + 0.023, y[1] - 0.033):
                    post = min(max(px, inner[0] + 0.003), inner[1] - 0.003)
                    pieces.append(rod(2, (post, py), 0.003, (float(low), high), STEEL, 6))
            if rng.random() < 0.75:
                origin = (width / 2, y[0], float(low))
                limbs.append(
                    sliding(
                        f"inner_rack_{i}", pieces, (0.0, -1.0, 0.0), origin, round(0.8 * depth, 3)
                    )
                )
            else:
                body += pieces
    return built(body, limbs)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "stove": stove,
    "built_in_oven": built_in_oven,
    "microwave_oven": microwave_oven,
    "hob": hob,
    "hood": hood,
    "dish_washer": dish_washer,
}
