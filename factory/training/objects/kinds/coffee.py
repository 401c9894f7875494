"""Coffee machines and toasters: boxes with small parts on every side."""

from __future__ import annotations

import numpy as np

from ....mesh import Material
from ..kit.assembly import DOWN, FRONT, LEFT, UP, Assembly, Placement, facing_front, facing_side
from ..kit.boards import corners, tray
from ..kit.controls import button, knob
from ..kit.looks import BLACK, RED, STEEL, WHITE
from ..kit.shapes import (
    Z,
    about,
    arc,
    block,
    box,
    cylinder,
    lathe,
    pipe,
    ribbon,
    rounded,
    span,
    within,
)  # fmt: skip

PLAY = 0.001


def coffee_machine(a: Assembly) -> None:
    """A column with a head over a drip tray; a tank lid, knobs, buttons, a filter holder, a steam wand."""
    skin, dark = a.picks((BLACK, STEEL, RED, WHITE), (BLACK, STEEL))
    half, deep, high, base, head = a.draws(
        (0.07, 0.16), (0.22, 0.34), (0.26, 0.4), (0.035, 0.06), (0.07, 0.12)
    )
    front, r, under, x, body = (
        -a.draw(0.4, 0.6) * deep,
        a.draw(0.004, 0.025),
        high - head,
        about(half),
        a.body(skin),
    )
    back = (0.0, deep + front)
    body.add(block(x, back, (0.0, high), r))
    body.add(block(within(x, 0.001), (front, 0.02), (under, high - 0.001), r, 0.003))
    if a.happens(0.75):
        _drip_tray(a, half, front, base, dark)
    else:
        body.add(block(x, (front, 0.02), (0.0, base), r, 0.003))
    if a.happens(0.8):
        y, z = within(back, 0.004), span(high + PLAY, a.draw(0.006, 0.015))
        if a.happens(0.75):
            lid = a.hinge("tank_lid", LEFT, (0, y[1], z[0]), a.degrees(60, 100))
        else:
            lid = a.slider("tank_lid", UP, (0, y[1], high), 0.05)
        lid.add(block(about(half * a.draw(0.6, 0.95)), y, z, 0.012, 0.002))
    place, level, count = facing_front(front), (under + high) / 2, a.count(1, 4)
    radius = min(a.draw(0.009, 0.02), 0.8 * half / count)
    for i in range(count):
        at = (i - (count - 1) / 2) * 1.7 * half / count
        if a.happens(0.5):
            knob(a, f"knob_{i}", (at, level), radius, dark, place, upper=a.degrees(90, 300))
        else:
            key = about(0.6 * radius, at), about(0.6 * radius, level)
            button(a, f"button_{i}", *key, dark, place, stroke=0.0025, style=a.draw(0.2, 0.95))
    spout = 0.55 * front
    if a.happens(0.5):
        _filter_holder(a, spout, under, dark)
        if a.happens(0.7):
            _wand(a, 0.8 * half, 0.75 * front, under)
        return
    body.add(
        block(about(0.02), about(0.02, spout), (under - 0.03, under + 0.001), 0.006), look=dark
    )
    if a.happens(0.5):
        _jug(a, spout, base, under - 0.032, 0.95 * min(half, -0.45 * front, 0.06), dark)


def _drip_tray(a: Assembly, half: float, front: float, base: float, dark: Material) -> None:
    wall, x = 0.005, about(half)
    y, inner = (front, 0.0), within(x, wall + PLAY)
    a.root.add(*tray(x, y, (0.0, base), wall, False)[:2], box(within(x, wall), y, (0.0, wall)))
    low = wall + PLAY
    slider = a.slider("drip_tray", FRONT, (0, front, wall), -a.draw(0.5, 0.9) * front, look=dark)
    slider.add(*tray(inner, (front + 0.006, -PLAY), (low, base - 0.004), 0.003, False))
    slider.add(box(within(inner, 0.0002), span(front, 0.006), (low, base)))
    grid = block(within(inner, 0.004), (front + 0.008, -0.008), (base - 0.006, base - 0.002), 0.01)
    slider.add(grid, look=STEEL)


def _filter_holder(a: Assembly, y: float, under: float, dark: Material) -> None:
    """A filter holder that locks under the group by a turn."""
    radius, long, tilt = a.draws((0.026, 0.034), (0.09, 0.14), (0.0, 0.02))
    z = under - PLAY
    holder = a.hinge("filter_holder", DOWN, (0, y, z), a.degrees(30, 60), look=dark)
    cup = [(0.6 * radius, -0.045), (radius, -0.03), (radius, 0.0)]
    holder.add(lathe(cup, (0, y, z)), look=STEEL)
    bar = [
        (0, y - 0.9 * radius, z - 0.018),
        (0, y - 0.05, z - 0.02),
        (0, y - long, z - 0.02 - tilt),
    ]
    holder.add(pipe(bar, [0.006, 0.01, 0.012]))


def _wand(a: Assembly, x: float, y: float, under: float) -> None:
    z = under - PLAY
    wand = a.hinge("wand", UP, (x, y, z), a.degrees(30, 60), -a.degrees(10, 30), look=STEEL)
    steps = ((0.0, -0.003), (0.0, -0.02), (0.012, -0.05), (0.02, -a.draw(0.09, 0.12)))
    wand.add(pipe([(x + off, y - off, z + drop) for off, drop in steps], 0.0035, 8))
    wand.add(cylinder(Z, (x, y), 0.007, (z - 0.008, z), 12))


def _jug(a: Assembly, y: float, low: float, top: float, radius: float, dark: Material) -> None:
    """A glass jug on the hot plate that pulls out."""
    high, z = 0.9 * (top - low), low + 0.001
    neck = 0.7 * radius
    outside = [(0.8 * radius, 0.0), (radius, 0.35 * high), (neck, 0.9 * high)]
    inside = [(r - 0.002, max(h, 0.003)) for r, h in outside[::-1]]
    jug = a.slider("jug", FRONT, (0, y, z), a.draw(0.08, 0.2), look=dark)
    jug.add(lathe([*outside, *inside], (0, y, z)), look=STEEL)
    jug.add(lathe([(neck, 0.9 * high + 0.0005), (0.65 * radius, high - 0.001)], (0, y, z)))
    path = [
        (0.72 * radius, 0.85),
        (radius + 0.025, 0.8),
        (radius + 0.02, 0.25),
        (0.95 * radius, 0.3),
    ]
    jug.add(pipe([(0.0, y - out, z + share * high) for out, share in path], 0.006, 8))


def toaster(a: Assembly) -> None:
    """A shell with slots on top; levers that go down, knobs and buttons at one end or in front."""
    skin, dark = a.picks((STEEL, RED, BLACK, WHITE), (BLACK, STEEL))
    slots, body = a.pick(1, 2, 2, 4), a.body(skin)
    long, pitch, wide = a.draws((0.12, 0.2), (0.045, 0.06), (0.022, 0.032))
    half_x, half_y = long / 2 + a.draw(0.02, 0.05), slots * pitch / 2 + a.draw(0.015, 0.03)
    foot, high, r = a.draws((0.004, 0.015), (0.15, 0.22), (0.01, 0.05))
    r = min(r, half_y - slots * pitch / 2 + 0.012)
    x, y = about(half_x), about(half_y)
    inner = within(x, 0.003), within(y, 0.003)
    walls = rounded(x, y, r), rounded(*inner, r - 0.003)
    body.add(ribbon(*walls, (foot, high - 0.002), looped=True))
    body.add(block(*inner, (foot + 0.001, foot + 0.004), r - 0.003))
    _slots(a, half_x - 0.0025, half_y - 0.0025, high, slots, long, pitch, wide, r)
    body.add(
        *(cylinder(Z, at, 0.009, (0.0, foot + 0.0005), 12) for at in corners(x, y, 0.02)), look=dark
    )
    at_end = a.happens(0.75)
    place, room = (
        (facing_side(half_x), half_y - r) if at_end else (facing_front(-half_y), half_x - r)
    )
    _panel(a, max(1, slots // 2), room, foot, high, dark, place)


def _slots(
    a: Assembly,
    x: float,
    y: float,
    high: float,
    slots: int,
    long: float,
    pitch: float,
    wide: float,
    r: float,
) -> None:
    """Strips between the slots, and two ends with the round corners of the shell."""
    z, cut, body = (high - 0.012, high), long / 2, a.root
    quarter = arc((x - r, y - r), r, 0.0, np.pi / 2, 6)
    line = np.concatenate([(quarter * (1, -1))[::-1], quarter])
    inner = np.column_stack([np.full(len(line), cut), line[:, 1]])
    body.add(*(ribbon(inner * (side, 1), line * (side, 1), z) for side in (-1, 1)))
    middles = [(i - (slots - 1) / 2) * pitch for i in range(slots)]
    edges = [-y, *(end for middle in middles for end in about(wide / 2, middle)), y]
    strips = zip(edges[::2], edges[1::2], strict=True)
    body.add(*(box(about(cut), strip, within(z, 0.0, 0.0002)) for strip in strips))


def _panel(
    a: Assembly,
    levers: int,
    room: float,
    foot: float,
    high: float,
    dark: Material,
    place: Placement,
) -> None:
    """Levers above knobs and buttons."""
    upper, reach = 0.8 * high, a.draw(0.25, 0.4) * (high - foot)
    for i in range(levers):
        x = (i - (levers - 1) / 2) * 1.1 * room
        wide, out, thick = a.draws((0.012, 0.025), (0.015, 0.035), (0.003, 0.008))
        lever = a.slider(f"lever_{i}", DOWN, (x, 0, upper), reach, look=dark, place=place)
        lever.add(box(about(0.003, x), (-0.4 * out, -PLAY), about(0.002, upper)))
        cap = about(min(wide, 0.4 * room), x), (-1.2 * out, -0.4 * out), about(thick, upper)
        lever.add(block(*cap, 0.006, 0.001))
    floor, count = upper - reach - 0.012, a.count(1, 3) * levers
    lower = foot + 0.35 * (high - foot)
    radius = min(a.draw(0.008, 0.016), 0.8 * room / count, (floor - lower) / 2 + 0.02)
    z = max(foot + radius + 0.005, floor - radius - 0.003)
    for i in range(count):
        x = (i - (count - 1) / 2) * 1.8 * room / count
        if i == 0 or a.happens(0.5):
            knob(a, f"knob_{i}", (x, z), radius, dark, place, upper=a.degrees(120, 300))
        else:
            spot = about(0.6 * radius, x), about(0.6 * radius, z)
            button(a, f"button_{i}", *spot, dark, place, stroke=0.003, thick=0.005)


MAKERS = {"coffee_machine": coffee_machine, "toaster": toaster}
