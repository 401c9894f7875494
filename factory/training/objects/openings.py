"""Doors and windows in their frames, with handles that turn on them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...articulation import Articulation
from ...mesh import Material
from .grips import any_grip, gripped
from .hinges import swing
from .limbs import Limb, built, sliding, swinging, turning
from .looks import BLACK, GLASS
from .panels import framed, panel, within
from .pieces import Block, Piece, extruded, rod, turned
from .solids import Span
from .styles import any_color, any_metal, drawn

LEAVES: dict[str, float] = {
    "slab": 0.3, "shaker": 0.12, "raised": 0.12, "two_fields": 0.14, "glazed": 0.12, "mullion": 0.08, "louvre": 0.05,
    "planks": 0.07,
}  # fmt: skip


def jamb(x: Span, y: Span, z: Span, width: float, sill: bool, material: Material) -> list[Piece]:
    """A frame around an opening, with or without a board at its foot; see :func:`panels.within`."""
    if sill:
        return framed(x, y, z, width, material)
    return [
        Block((x[0], x[0] + width), y, z, material),
        Block((x[1] - width, x[1]), y, z, material),
        Block((x[0] + width, x[1] - width), y, (z[1] - width, z[1]), material),
    ]


def _lever(
    rng: np.random.Generator,
    name: str,
    x: float,
    z: float,
    y: Span,
    inward: float,
    look: Material,
    parent: str,
) -> Limb:
    """A lever or a round knob on both sides of a leaf, on one spindle."""
    reach, r = float(rng.uniform(0.04, 0.065)), float(rng.uniform(0.007, 0.011))
    pieces: list[Piece] = []
    rest = 0.0015
    lever = rng.random() < 0.75
    length = float(rng.uniform(0.09, 0.14))
    curved = float(rng.choice([0.0, 0.0, 0.02]))
    for face, sign in ((y[0], -1.0), (y[1], 1.0)):
        near, far = face + sign * rest, face + sign * reach
        span = (min(near, far), max(near, far))
        if lever:
            pieces.append(rod(1, (z, x), r, span, look))
            along = sorted((x - inward * r, x + inward * length))
            middle = face + sign * (reach - r)
            profile = [
                (middle - 0.8 * r, z - r),
                (middle + 0.8 * r, z - r),
                (middle + 0.8 * r, z + r),
                (middle - 0.8 * r, z + r),
            ]
            pieces.append(extruded(0, profile, (along[0], along[1]), look))
            if curved:
                tip = x + inward * length
                hook = (min(tip, tip - inward * 0.012), max(tip, tip - inward * 0.012))
                pieces.append(
                    Block(hook, (middle - 0.8 * r, middle + 0.8 * r), (z - r - curved, z - r), look)
                )
        else:
            ball = 0.028
            profile = [
                (0.0, 0.45 * ball),
                (0.3, 0.4 * ball),
                (0.4, 0.9 * ball),
                (0.7, ball),
                (1.0, 0.6 * ball),
            ]
            steps = [(near + sign * a * (reach - rest), b) for a, b in profile]
            pieces.append(turned(1, (z, x), steps if sign > 0 else steps[::-1], look, 16))
    axis = (0.0, 1.0, 0.0) if inward < 0 else (0.0, -1.0, 0.0)
    upper = float(np.radians(rng.integers(30, 61)))
    return turning(
        name, pieces, axis if lever else (0.0, 1.0, 0.0), (x, (y[0] + y[1]) / 2, z), upper, parent
    )


def _leaf(
    rng: np.random.Generator,
    name: str,
    x: Span,
    y: Span,
    z: Span,
    side: str,
    looks: tuple[Material, Material],
    style: str,
) -> list[Limb]:
    """A door leaf and what turns on it."""
    thickness, gap = y[1] - y[0], float(rng.uniform(0.0015, 0.005))
    free = within(x, gap)
    turn = swing(
        rng, thickness, free[1] - free[0], (gap, gap), float(rng.choice([0.0, -0.2, -0.1])), 112.0
    )
    free = (free[0], free[1] - turn.trim) if side == "left" else (free[0] + turn.trim, free[1])
    rail = min(0.13, 0.2 * (free[1] - free[0]))
    pieces = panel(style, free, y, z, (looks[0], GLASS), rail)
    if style in ("shaker", "two_fields") and rng.random() < 0.6:
        # The same relief on the other side.
        pieces.append(
            Block(within(free, rail), (y[1] - 0.002, y[1] - 0.001), within(z, rail), looks[1])
        )
    upper = turn.upper
    left = side == "left"
    at = free[1] - 0.06 if left else free[0] + 0.06
    high = float(np.clip(z[0] + rng.uniform(0.85, 1.1), z[0], z[1] - 0.2))
    limb = swinging(name, pieces, free, z, y[0] + turn.setback, side, upper)
    chance = rng.random()
    if chance < 0.65:
        plate = Block(
            (at - 0.022, at + 0.022),
            (y[0] - 0.0005, y[1] + 0.0005),
            (high - 0.09, high + 0.06),
            looks[1],
        )
        if rng.random() < 0.5:
            limb = swinging(name, [*pieces, plate], free, z, y[0] + turn.setback, side, upper)
        return [
            limb,
            _lever(
                rng,
                f"{name}_handle",
                at,
                high,
                (y[0] - 0.0005, y[1] + 0.0005),
                -1.0 if left else 1.0,
                looks[1],
                name,
            ),
        ]
    if chance < 0.9:
        grip = any_grip(rng, looks[1], ("bar", "rail", "bow", "knob", "ball"))
        pieces = [*pieces, *gripped(grip, at, high, y[0], True, 0.5)]
        limb = swinging(name, pieces, free, z, y[0] + turn.setback, side, upper)
    return [limb]


def door(rng: np.random.Generator) -> Articulation:
    """One or two leaves in a frame, with side lights or a fan light at times."""
    double = bool(rng.random() < 0.25)
    width, height = (
        float(rng.uniform(1.2, 1.9) if double else rng.uniform(0.65, 1.1)),
        float(rng.uniform(1.85, 2.3)),
    )
    bar, wall = float(rng.uniform(0.025, 0.09)), float(rng.uniform(0.06, 0.2))
    thick = float(rng.uniform(0.03, 0.06))
    look, metal = any_color(rng), any_metal(rng)
    z_top = height + bar
    frame_x, y = (-bar, width + bar), (0.0, wall)
    sill = bool(rng.random() < 0.3)
    low = bar if sill else 0.0
    body = jamb(frame_x, y, (0.0, z_top), bar, sill, look)
    if rng.random() < 0.25:
        high = z_top + float(rng.uniform(0.25, 0.5))
        body += [*framed(frame_x, y, (z_top, high), bar, look)]
        body.append(
            Block(
                within(frame_x, bar),
                (0.4 * wall, 0.4 * wall + 0.006),
                (z_top + bar, high - bar),
                GLASS,
            )
        )
    if rng.random() < 0.5:
        trim = float(rng.uniform(0.04, 0.09))
        body += jamb(
            (frame_x[0] - trim, frame_x[1] + trim),
            (wall, wall + 0.012),
            (0.0, z_top + trim),
            trim,
            False,
            look,
        )
    style, looks = drawn(rng, LEAVES), (any_color(rng), metal)
    z = (low + float(rng.uniform(0.002, 0.01)), height - 0.003)
    y_leaf = (0.0, thick)
    # A stop behind the leaf, as real frames have.
    if rng.random() < 0.5 and wall > thick + 0.02:
        body += jamb(
            (0.0, width), (thick + 0.002, thick + 0.014), (low, height), 0.012, False, look
        )
    if double:
        half = width / 2
        limbs = _leaf(rng, "door_0", (0.0, half), y_leaf, z, "left", looks, style)
        limbs += _leaf(rng, "door_1", (half, width), y_leaf, z, "right", looks, style)
    else:
        limbs = _leaf(
            rng,
            "door_0",
            (0.0, width),
            y_leaf,
            z,
            "left" if rng.random() < 0.5 else "right",
            looks,
            style,
        )
    return built(body, limbs)


def sliding_door(rng: np.random.Generator) -> Articulation:
    """A leaf on a rail before a wall, or two on two tracks in a frame."""
    width, height = float(rng.uniform(0.7, 1.1)), float(rng.uniform(1.9, 2.3))
    look, metal, thick = any_color(rng), any_metal(rng), float(rng.uniform(0.025, 0.05))
    style = drawn(rng, LEAVES | {"glazed": 0.5})
    if rng.random() < 0.5:
        body: list[Piece] = [
            *jamb((-0.08, width + 0.08), (0.0, 0.1), (0.0, height), 0.08, False, look)
        ]
        rail_z = height + 0.12
        away = float(rng.choice([-1.0, 1.0]))
        ends = (-0.1, 2.0 * width + 0.1) if away > 0 else (-width - 0.1, width + 0.1)
        body.append(Block(ends, (-0.02, -0.012), (rail_z, rail_z + 0.04), metal))
        body += [
            Block((v - 0.02, v + 0.02), (-0.012, 0.1), (height, rail_z + 0.03), look)
            for v in (-0.06, width + 0.06)
        ]
        span = (-0.03, width + 0.03)
        y = (-0.012 - thick, -0.012)
        pieces = panel(style, span, y, (0.01, height + 0.08), (any_color(rng), GLASS), 0.11)
        for v in (0.1, width - 0.1):
            strap = (-0.018 - thick, -0.012 - thick)
            pieces.append(
                Block((v - 0.015, v + 0.015), strap, (height - 0.1, rail_z + 0.08), metal)
            )
            wheel = (strap[1], -0.008)
            pieces.append(rod(1, (rail_z + 0.063, v), 0.022, wheel, metal, 16))
        grip = any_grip(rng, metal, ("bar", "rail", "recess"))
        pieces += gripped(
            grip, span[1] - 0.06 if away < 0 else span[0] + 0.06, 1.0, y[0], True, 0.6
        )
        origin = (width / 2, y[0], height / 2)
        return built(
            body, [sliding("door", pieces, (away, 0.0, 0.0), origin, round(0.95 * width, 3))]
        )
    bar = float(rng.uniform(0.04, 0.08))
    return built(*_tracks(rng, (0.0, 2 * width), (0.0, height), bar, thick, style, (look, metal)))


def _tracks(
    rng: np.random.Generator,
    x: Span,
    z: Span,
    bar: float,
    thick: float,
    style: str,
    looks: tuple[Material, Material],
) -> tuple[list[Piece], list[Limb]]:
    """Two to three sashes that slide past each other in a frame."""
    count = int(rng.choice([2, 2, 2, 3]))
    deep = count * (thick + 0.004) + 0.01
    body = jamb(x, (0.0, deep), z, bar, True, looks[0])
    inner, level = within(x, bar + 0.002), within(z, bar + 0.002)
    each = (inner[1] - inner[0]) / count
    lap, limbs = 0.5 * bar, []
    for i in range(count):
        span = (
            inner[0] + i * each - (lap if i else 0.0),
            inner[0] + (i + 1) * each + (lap if i < count - 1 else 0.0),
        )
        face = 0.005 + i * (thick + 0.004)
        pieces = panel(style, span, (face, face + thick), level, (looks[0], GLASS), bar)
        if i == 0:
            pieces += gripped(
                any_grip(rng, looks[1], ("recess", "bar")),
                span[0] + bar / 2,
                sum(level) / 2,
                face,
                True,
                0.3,
            )
        if i < count - 1 or count == 2:
            way = 1.0 if i < count - 1 else -1.0
            room = inner[1] - span[1] if way > 0 else span[0] - inner[0]
            origin = (sum(span) / 2, face, sum(level) / 2)
            limbs.append(
                sliding(
                    f"sash_{i}", pieces, (way, 0.0, 0.0), origin, round(0.97 * min(room, each), 3)
                )
            )
        else:
            body += pieces
    return body, limbs


def _latch(
    rng: np.random.Generator,
    name: str,
    at: tuple[float, float],
    way: float,
    look: Material,
    parent: str,
) -> Limb:
    """A window's handle on the plane y = 0, hanging from ``at`` (x, z); it turns to the left for ``way`` = 1."""
    (x, z), face = at, 0.0
    length = float(rng.uniform(0.08, 0.13))
    pieces: list[Piece] = [
        rod(1, (z, x), 0.009, (face - 0.035, face - 0.001), look),
        Block((x - 0.009, x + 0.009), (face - 0.045, face - 0.035), (z - length, z + 0.009), look),
    ]
    return turning(name, pieces, (0.0, way, 0.0), (x, face, z), float(np.radians(90)), parent)


def window(rng: np.random.Generator) -> Articulation:
    """Sashes in a frame: side, top or bottom hung, sliding across or up, or turning about their middle."""
    width, height = float(rng.uniform(0.45, 2.0)), float(rng.uniform(0.45, 1.7))
    bar, look, metal = float(rng.uniform(0.03, 0.07)), any_color(rng), any_metal(rng)
    thick, deep = float(rng.uniform(0.025, 0.05)), float(rng.uniform(0.06, 0.14))
    style = "mullion" if rng.random() < 0.3 else "glazed"
    x, z = (0.0, width), (0.0, height)
    kind = drawn(
        rng,
        {
            "casement": 0.35,
            "awning": 0.15,
            "hopper": 0.1,
            "slide": 0.2,
            "hung": 0.12,
            "pivot": 0.08,
        },
    )
    if kind == "slide":
        return built(*_tracks(rng, x, z, bar, thick, style, (look, metal)))
    if kind == "hung":
        return _hung(rng, x, z, bar, thick, style, (look, metal))
    body = jamb(x, (0.0, deep), z, bar, True, look)
    if rng.random() < 0.3:
        body.append(Block((-0.05, width + 0.05), (-0.06, deep), (-0.03, 0.0), look))
    columns = max(1, min(3, round(width / float(rng.uniform(0.45, 0.9)))))
    inner, level = within(x, bar), within(z, bar)
    cuts, limbs = np.linspace(*inner, columns + 1), []
    body += [
        Block((float(c) - bar / 2, float(c) + bar / 2), (0.0, deep), level, look)
        for c in cuts[1:-1]
    ]
    for i in range(columns):
        span = (
            float(cuts[i]) + (bar / 2 if i else 0.0),
            float(cuts[i + 1]) - (bar / 2 if i < columns - 1 else 0.0),
        )
        if columns == 3 and i == 1 and rng.random() < 0.6:
            body.append(Block(span, (0.5 * deep, 0.5 * deep + 0.006), level, GLASS))
            continue
        limbs += _sash(
            rng, f"sash_{i}", span, level, thick, (kind, i, columns), style, (look, metal)
        )
    return built(body, limbs)


def _sash(
    rng: np.random.Generator,
    name: str,
    x: Span,
    z: Span,
    thick: float,
    place: tuple[str, int, int],
    style: str,
    looks: tuple[Material, Material],
) -> list[Limb]:
    kind, index, columns = place
    gap, rail = float(rng.uniform(0.001, 0.004)), float(rng.uniform(0.03, 0.055))
    x, z = within(x, gap), within(z, gap)
    if kind == "pivot":
        return [_pivoted(rng, name, x, z, thick, rail, style, looks)]
    side = {"awning": "top", "hopper": "bottom"}.get(kind) or (
        "left" if index < columns / 2 and (columns > 1 or rng.random() < 0.5) else "right"
    )
    width = x[1] - x[0] if kind == "casement" else z[1] - z[0]
    turn = swing(rng, thick, width, (gap, gap), 0.0, 100.0 if kind == "casement" else 70.0)
    x = {"left": (x[0], x[1] - turn.trim), "right": (x[0] + turn.trim, x[1])}.get(side, x)
    z = {"bottom": (z[0], z[1] - turn.trim), "top": (z[0] + turn.trim, z[1])}.get(side, z)
    pieces = panel(style, x, (0.0, thick), z, (looks[0], GLASS), rail)
    limb = swinging(name, pieces, x, z, turn.setback, side, turn.upper)
    if rng.random() < 0.4:
        return [limb]
    at_x = {"left": x[1] - rail / 2, "right": x[0] + rail / 2}.get(side, sum(x) / 2)
    at_z = {"top": z[0] + 0.15, "bottom": z[1] - rail / 2}.get(side, sum(z) / 2)
    # It turns over its own sash, where no neighbour's handle is.
    way = -1.0 if side == "right" else 1.0
    look = looks[1] if looks[1] is not looks[0] else BLACK
    return [limb, _latch(rng, f"{name}_handle", (at_x, at_z), way, look, name)]


def _pivoted(
    rng: np.random.Generator,
    name: str,
    x: Span,
    z: Span,
    thick: float,
    rail: float,
    style: str,
    looks: tuple[Material, Material],
) -> Limb:
    """A sash about its horizontal or upright middle line; trimmed so that its corners clear the frame."""
    upright = bool(rng.random() < 0.4)
    half = (x[1] - x[0]) / 2 if upright else (z[1] - z[0]) / 2
    trim = float(np.hypot(half, thick / 2)) - half
    x, z = (within(x, trim), z) if upright else (x, within(z, trim))
    pieces = panel(style, x, (0.0, thick), z, (looks[0], GLASS), rail)
    origin = (sum(x) / 2, thick / 2, sum(z) / 2)
    axis = (0.0, 0.0, 1.0) if upright else (-1.0, 0.0, 0.0)
    return turning(name, pieces, axis, origin, float(np.radians(rng.integers(45, 91))))


def _hung(
    rng: np.random.Generator,
    x: Span,
    z: Span,
    bar: float,
    thick: float,
    style: str,
    looks: tuple[Material, Material],
) -> Articulation:
    """A lower sash that slides up past the upper one, which may come down."""
    deep = 2 * thick + 0.014
    body = jamb(x, (0.0, deep), z, bar, True, looks[0])
    inner, level = within(x, bar + 0.002), within(z, bar + 0.002)
    middle, limbs = sum(level) / 2, []
    for i, span in enumerate(((level[0], middle + bar / 2), (middle - bar / 2, level[1]))):
        face = 0.005 + i * (thick + 0.004)
        pieces = panel(style, inner, (face, face + thick), span, (looks[0], GLASS), bar)
        if i and rng.random() < 0.5:
            body += pieces
            continue
        travel = round(0.95 * (level[1] - level[0] - (span[1] - span[0])), 3)
        origin = (sum(inner) / 2, face, sum(span) / 2)
        limbs.append(sliding(f"sash_{i}", pieces, (0.0, 0.0, -1.0 if i else 1.0), origin, travel))
    return built(body, limbs)


MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "door": door,
    "sliding_door": sliding_door,
    "window": window,
}
