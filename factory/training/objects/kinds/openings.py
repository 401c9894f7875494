"""Doors and windows in their frames, with handles that turn on them."""

from __future__ import annotations

import numpy as np

from ....mesh import Material
from ..kit.assembly import BACK, DOWN, FRONT, LEFT, RIGHT, UP, Assembly, PartDraft
from ..kit.boards import frame
from ..kit.casework import swung
from ..kit.hinges import swing
from ..kit.looks import BLACK, GLASS
from ..kit.panels import panel
from ..kit.pulls import add_pull, any_pull
from ..kit.shapes import (
    Flat,
    Profile,
    Span,
    Y,
    about,
    box,
    cylinder,
    lathe,
    mid,
    shares,
    size,
    span,
    within,
)  # fmt: skip
from ..kit.styles import any_color, any_metal

LEAVES: dict[str, float] = {
    "slab": 0.3, "shaker": 0.12, "raised": 0.12, "two_fields": 0.14, "glazed": 0.12, "mullion": 0.08, "louvre": 0.05,
    "planks": 0.07,
}  # fmt: skip
#: A round door knob, from its leaf outwards: radius and height as shares.
_KNOB = ((0.45, 0.0), (0.4, 0.3), (0.9, 0.4), (1.0, 0.7), (0.6, 1.0))


def _lever(a: Assembly, leaf: PartDraft, at: Flat, y: Span, inward: float, look: Material) -> None:
    """A lever or a round knob on both sides of a leaf, on one spindle."""
    (x, z), lever = at, a.happens(0.75)
    reach, r, length = a.draws((0.04, 0.065), (0.007, 0.011), (0.09, 0.14))
    axis = FRONT if lever and inward > 0.0 else BACK
    upper, curved = a.degrees(30, 60), a.pick(0.0, 0.0, 0.02)
    handle = a.hinge(f"{leaf.name}_handle", axis, (x, mid(y), z), upper, on=leaf, look=look)
    for face, side in ((y[0], -1.0), (y[1], 1.0)):
        near = face + side * 0.0015
        if not lever:
            knob: Profile = [(0.028 * s, side * t * (reach - 0.0015)) for s, t in _KNOB]
            handle.add(lathe(knob, (x, near, z), Y, 16))
            continue
        handle.add(cylinder(Y, at, r, span(near, side * (reach - 0.0015)), 12))
        thick = about(0.8 * r, face + side * (reach - r))
        handle.add(box(span(x - inward * r, inward * (r + length)), thick, about(r, z)))
        if curved:
            tip = span(x + inward * length, -inward * 0.012)
            handle.add(box(tip, thick, (z - r - curved, z - r)))


def _leaf(
    a: Assembly,
    name: str,
    x: Span,
    y: Span,
    z: Span,
    side: str,
    style: str,
    looks: tuple[Material, ...],
) -> None:
    """A door leaf and what turns on it."""
    gap, (face, metal), left = a.draw(0.0015, 0.005), looks, side == "left"
    turn = swing(a, size(y), size(x) - 2 * gap, (gap, gap), a.pick(0.0, -0.2, -0.1), 112.0)
    x, _ = turn.trimmed(within(x, gap), z, side)
    rail = min(0.13, 0.2 * size(x))
    leaf = swung(a, name, side, x, z, y[0] + turn.setback, turn.upper, look=face)
    panel(leaf, style, x, y, z, rail)
    if style in ("shaker", "two_fields") and a.happens(0.6):
        # The same relief on the other side.
        leaf.add(box(within(x, rail), (y[1] - 0.002, y[1] - 0.001), within(z, rail)), look=metal)
    at = x[1] - 0.06 if left else x[0] + 0.06
    high = min(max(z[0] + a.draw(0.85, 1.1), z[0]), z[1] - 0.2)
    worn = a.weighted({"lever": 0.65, "pull": 0.25, "none": 0.1})
    if worn == "lever":
        both = within(y, -0.0005)
        if a.happens(0.5):
            leaf.add(box(about(0.022, at), both, (high - 0.09, high + 0.06)), look=metal)
        _lever(a, leaf, (at, high), both, -1.0 if left else 1.0, metal)
    elif worn == "pull":
        pull = any_pull(a, metal, ("bar", "rail", "bow", "knob", "ball"))
        add_pull(leaf, pull, at, high, y[0], True, 0.5)


def door(a: Assembly) -> None:
    """One or two leaves in a frame, with side lights or a fan light at times."""
    double, sill = a.happens(0.25), a.happens(0.3)
    width = a.draw(1.2, 1.9) if double else a.draw(0.65, 1.1)
    height, bar, wall, thick = a.draws((1.85, 2.3), (0.025, 0.09), (0.06, 0.2), (0.03, 0.06))
    body, looks, top = a.body(any_color(a)), a.picks((any_color(a),), (any_metal(a),)), height + bar
    outer, opening, low = (-bar, width + bar), (0.0, width), bar if sill else 0.0
    body.add(*frame(outer, (0.0, wall), (0.0, top), bar, sill))
    if a.happens(0.25):
        light = span(top, a.draw(0.25, 0.5))
        body.add(*frame(outer, (0.0, wall), light, bar))
        body.add(box(opening, span(0.4 * wall, 0.006), within(light, bar)), look=GLASS)
    if a.happens(0.5):
        trim = a.draw(0.04, 0.09)
        body.add(*frame(within(outer, -trim), span(wall, 0.012), (0.0, top + trim), trim, False))
    if a.happens(0.5) and wall > thick + 0.02:
        # A stop behind the leaf, as real frames have.
        body.add(*frame(opening, span(thick + 0.002, 0.012), (low, height), 0.012, False))
    style, y, z = a.weighted(LEAVES), (0.0, thick), (low + a.draw(0.002, 0.01), height - 0.003)
    if double:
        for i, (half, side) in enumerate(zip(shares(opening, 2), ("left", "right"), strict=True)):
            _leaf(a, f"door_{i}", half, y, z, side, style, looks)
    else:
        _leaf(a, "door_0", opening, y, z, a.pick("left", "right"), style, looks)


def sliding_door(a: Assembly) -> None:
    """A leaf on a rail before a wall, or two on two tracks in a frame."""
    width, height, thick = a.draws((0.7, 1.1), (1.9, 2.3), (0.025, 0.05))
    metal, body, style = any_metal(a), a.body(any_color(a)), a.weighted(LEAVES | {"glazed": 0.5})
    if a.happens(0.5):
        _tracks(a, (0.0, 2 * width), (0.0, height), a.draw(0.04, 0.08), thick, style, metal)
        return
    body.add(*frame((-0.08, width + 0.08), (0.0, 0.1), (0.0, height), 0.08, False))
    rail, away = height + 0.12, a.sign()
    ends = (-0.1, 2.0 * width + 0.1) if away > 0 else (-width - 0.1, width + 0.1)
    body.add(box(ends, (-0.02, -0.012), span(rail, 0.04)), look=metal)
    body.add(
        *(box(about(0.02, v), (-0.012, 0.1), (height, rail + 0.03)) for v in (-0.06, width + 0.06))
    )
    x, y = (-0.03, width + 0.03), (-0.012 - thick, -0.012)
    at = (width / 2, y[0], height / 2)
    leaf = a.slider("door", (away, 0.0, 0.0), at, round(0.95 * width, 3), look=any_color(a))
    panel(leaf, style, x, y, (0.01, height + 0.08), 0.11)
    for v in (0.1, width - 0.1):
        strap = span(y[0], -0.006)
        leaf.add(box(about(0.015, v), strap, (height - 0.1, rail + 0.08)), look=metal)
        leaf.add(cylinder(Y, (v, rail + 0.063), 0.022, (strap[1], -0.008)), look=metal)
    pull = any_pull(a, metal, ("bar", "rail", "recess"))
    add_pull(leaf, pull, x[1] - 0.06 if away < 0 else x[0] + 0.06, 1.0, y[0], True, 0.6)


def _tracks(
    a: Assembly, x: Span, z: Span, bar: float, thick: float, style: str, metal: Material
) -> None:
    """Two to three sashes that slide past each other in a frame."""
    count, body = a.pick(2, 2, 2, 3), a.root
    body.add(*frame(x, (0.0, count * (thick + 0.004) + 0.01), z, bar))
    inner, level, lap = within(x, bar + 0.002), within(z, bar + 0.002), 0.5 * bar
    for i, own in enumerate(shares(inner, count)):
        sash_x = within(own, -lap if i else 0.0, -lap if i < count - 1 else 0.0)
        y, last = span(0.005 + i * (thick + 0.004), thick), i == count - 1
        sash = body
        if not last or count == 2:
            room = sash_x[0] - inner[0] if last else inner[1] - sash_x[1]
            at, travel = (mid(sash_x), y[0], mid(level)), round(0.97 * min(room, size(own)), 3)
            sash = a.slider(f"sash_{i}", LEFT if last else RIGHT, at, travel)
        panel(sash, style, sash_x, y, level, bar)
        if not i:
            pull = any_pull(a, metal, ("recess", "bar"))
            add_pull(sash, pull, sash_x[0] + bar / 2, mid(level), y[0], True, 0.3)


def window(a: Assembly) -> None:
    """Sashes in a frame: side, top or bottom hung, sliding across or up, or turning about their middle."""
    width, height, bar, thick, deep = a.draws(
        (0.45, 2.0), (0.45, 1.7), (0.03, 0.07), (0.025, 0.05), (0.06, 0.14)
    )
    body, metal, style = (
        a.body(any_color(a)),
        any_metal(a),
        a.weighted({"mullion": 0.3, "glazed": 0.7}),
    )
    x, z = (0.0, width), (0.0, height)
    kind = a.weighted(
        {"casement": 0.35, "awning": 0.15, "hopper": 0.1, "slide": 0.2, "hung": 0.12, "pivot": 0.08}
    )
    if kind == "slide":
        _tracks(a, x, z, bar, thick, style, metal)
        return
    if kind == "hung":
        _hung(a, x, z, bar, thick, style)
        return
    body.add(*frame(x, (0.0, deep), z, bar))
    if a.happens(0.3):
        body.add(box(within(x, -0.05), (-0.06, deep), (-0.03, 0.0)))
    columns = max(1, min(3, round(width / a.draw(0.45, 0.9))))
    level, bays = within(z, bar), shares(within(x, bar), columns)
    body.add(*(box(about(bar / 2, bay[0]), (0.0, deep), level) for bay in bays[1:]))
    for i, bay in enumerate(bays):
        free = within(bay, bar / 2 if i else 0.0, bar / 2 if i < columns - 1 else 0.0)
        if columns == 3 and i == 1 and a.happens(0.6):
            body.add(box(free, span(0.5 * deep, 0.006), level), look=GLASS)
            continue
        side = {"awning": "top", "hopper": "bottom", "pivot": "pivot"}.get(kind)
        left = i < columns / 2 and (columns > 1 or a.happens(0.5))
        _sash(
            a, f"sash_{i}", free, level, thick, side or ("left" if left else "right"), style, metal
        )


def _sash(
    a: Assembly, name: str, x: Span, z: Span, thick: float, side: str, style: str, metal: Material
) -> None:
    gap, rail, y = a.draw(0.001, 0.004), a.draw(0.03, 0.055), (0.0, thick)
    x, z = within(x, gap), within(z, gap)
    if side == "pivot":
        _pivoted(a, name, x, z, thick, rail, style)
        return
    upright = side in ("left", "right")
    width, furthest = (size(x), 100.0) if upright else (size(z), 70.0)
    turn = swing(a, thick, width, (gap, gap), 0.0, furthest)
    x, z = turn.trimmed(x, z, side)
    sash = swung(a, name, side, x, z, turn.setback, turn.upper)
    panel(sash, style, x, y, z, rail)
    if a.happens(0.4):
        return
    at = {"left": x[1] - rail / 2, "right": x[0] + rail / 2}.get(side, mid(x))
    level, long = (
        {"top": z[0] + 0.15, "bottom": z[1] - rail / 2}.get(side, mid(z)),
        a.draw(0.08, 0.13),
    )
    # It hangs, and turns over its own sash, where no neighbour's handle is.
    way, look = FRONT if side == "right" else BACK, BLACK if metal is a.root.look else metal
    latch = a.hinge(f"{name}_handle", way, (at, 0.0, level), np.pi / 2, on=sash, look=look)
    latch.add(cylinder(Y, (at, level), 0.009, (-0.035, -0.001), 12))
    latch.add(box(about(0.009, at), (-0.045, -0.035), (level - long, level + 0.009)))


def _pivoted(
    a: Assembly, name: str, x: Span, z: Span, thick: float, rail: float, style: str
) -> None:
    """A sash about its horizontal or upright middle line; trimmed so that its corners clear the frame."""
    upright = a.happens(0.4)
    half = size(x if upright else z) / 2
    trim = float(np.hypot(half, thick / 2)) - half
    x, z = (within(x, trim), z) if upright else (x, within(z, trim))
    at = (mid(x), thick / 2, mid(z))
    sash = a.hinge(name, UP if upright else LEFT, at, a.degrees(45, 90))
    panel(sash, style, x, (0.0, thick), z, rail)


def _hung(a: Assembly, x: Span, z: Span, bar: float, thick: float, style: str) -> None:
    """A lower sash that slides up past the upper one, which may come down."""
    body = a.root
    body.add(*frame(x, (0.0, 2 * thick + 0.014), z, bar))
    inner, level = within(x, bar + 0.002), within(z, bar + 0.002)
    high = size(level) / 2 + bar / 2
    travel = round(0.95 * (size(level) - high), 3)
    for i, (own, way) in enumerate(((span(level[0], high), UP), (span(level[1], -high), DOWN))):
        y = span(0.005 + i * (thick + 0.004), thick)
        moves = not i or a.happens(0.5)
        sash = a.slider(f"sash_{i}", way, (mid(x), y[0], mid(own)), travel) if moves else body
        panel(sash, style, inner, y, own, bar)


MAKERS = {"door": door, "sliding_door": sliding_door, "window": window}
