"""Coffee machines and toasters: boxes with small parts on every side."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import DOWN, FRONT, LEFT, UP, Assembly, Place, facing_front, facing_side
from ..kit.boards import corners, tray
from ..kit.controls import button, knob
from ..kit.looks import BLACK, RED, STEEL, WHITE
from ..kit.outlines import arc, rounded
from ..kit.shapes import block, both, box, cylinder, lathe, pipe, ribbon
from ..kit.spans import PLAY, Z, about, centred, ends, span, within


def coffee_machine(a: Assembly) -> None:
    """Build a column with a head over a drip tray; lid, controls, a filter holder or a jug."""
    half, deep, high, base = a.draws((0.07, 0.16), (0.22, 0.34), (0.26, 0.4), (0.035, 0.06))
    head, r = a.draws((0.07, 0.12), (0.004, 0.025))
    skin, dark = a.picks((BLACK, STEEL, RED, WHITE), (BLACK, STEEL))
    front = -a.draw(0.4, 0.6) * deep
    under = high - head
    x = about(half)
    back = (0.0, deep + front)
    body = a.body(skin, block(x, back, (0.0, high), r))
    body.add(block(within(x, 0.001), (front, 0.02), (under, high - 0.001), r, 0.003))
    if a.happens(0.75):
        _drip_tray(a, half, front, base, dark)
    else:
        body.add(block(x, (front, 0.02), (0.0, base), r, 0.003))
    if a.happens(0.8):
        y = within(back, 0.004)
        z = span(high + PLAY, a.draw(0.006, 0.015))
        if a.happens(0.75):
            lid = a.hinge("tank_lid", LEFT, (0, y[1], z[0]), a.degrees(60, 100))
        else:
            lid = a.slider("tank_lid", UP, (0, y[1], high), 0.05)
        lid.add(block(about(half * a.draw(0.6, 0.95)), y, z, 0.012, 0.002))
    count = a.count(1, 4)
    radius = min(a.draw(0.009, 0.02), 0.8 * half / count)
    for i in range(count):
        at = ((i - (count - 1) / 2) * 1.7 * half / count, (under + high) / 2)
        _control(a, i, at, radius, dark, facing_front(front), 0.5)
    spout = 0.55 * front
    if a.happens(0.5):
        _filter_holder(a, spout, under - PLAY, dark)
        if a.happens(0.7):
            _wand(a, 0.8 * half, 0.75 * front, under - PLAY)
        return
    nozzle = block(about(0.02), about(0.02, spout), (under - 0.03, under + 0.001), 0.006)
    body.add(nozzle, look=dark)
    if a.happens(0.5):
        _jug(a, spout, base + 0.001, under - 0.032, 0.95 * min(half, -0.45 * front, 0.06), dark)


def _control(
    a: Assembly,
    i: int,
    at: tuple[float, float],
    radius: float,
    look: Material,
    place: Place,
    turned: float,
) -> None:
    """Build a knob in this share of cases, else a button."""
    if a.happens(turned):
        knob(a, f"knob_{i}", at, radius, look, place, upper=a.degrees(90, 300))
        return
    x, z = (about(0.6 * radius, v) for v in at)
    button(a, f"button_{i}", x, z, look, place, stroke=0.0025, style=a.draw(0.2, 1.2))


def _drip_tray(a: Assembly, half: float, front: float, base: float, dark: Material) -> None:
    x = about(half)
    y = (front, 0.0)
    a.root.add(*(box(end, y, (0.0, base)) for end in ends(x, 0.005)))
    a.root.add(box(within(x, 0.005), y, (0.0, 0.005)))
    low = 0.005 + PLAY
    inner = within(x, low)
    slider = a.slider("drip_tray", FRONT, (0, front, 0.005), -a.draw(0.5, 0.9) * front, look=dark)
    slider.add(*tray(inner, (front + 0.006, -PLAY), (low, base - 0.004), 0.003, False))
    slider.add(box(within(inner, 0.0002), span(front, 0.006), (low, base)))
    grid = block(within(inner, 0.004), (front + 0.008, -0.008), (base - 0.006, base - 0.002), 0.01)
    slider.add(grid, look=STEEL)


def _filter_holder(a: Assembly, y: float, z: float, dark: Material) -> None:
    """Build a filter holder that locks under the group by a turn."""
    radius, long, tilt = a.draws((0.026, 0.034), (0.09, 0.14), (0.0, 0.02))
    holder = a.hinge("filter_holder", DOWN, (0, y, z), a.degrees(30, 60), look=dark)
    cup = [(0.6 * radius, -0.045), (radius, -0.03), (radius, 0.0)]
    holder.add(lathe(cup, (0, y, z)), look=STEEL)
    bar = [(0.9 * radius, 0.018), (0.05, 0.02), (long, 0.02 + tilt)]
    holder.add(pipe([(0, y - out, z - low) for out, low in bar], [0.006, 0.01, 0.012]))


def _wand(a: Assembly, x: float, y: float, z: float) -> None:
    wand = a.hinge("wand", UP, (x, y, z), a.degrees(30, 60), -a.degrees(10, 30), look=STEEL)
    steps = ((0.0, 0.003), (0.0, 0.02), (0.012, 0.05), (0.02, a.draw(0.09, 0.12)))
    wand.add(pipe([(x + out, y - out, z - low) for out, low in steps], 0.0035, 8))
    wand.add(cylinder(Z, (x, y), 0.007, (z - 0.008, z), 12))


def _jug(a: Assembly, y: float, z: float, top: float, radius: float, dark: Material) -> None:
    """Build a glass jug on the hot plate that pulls out."""
    high = 0.9 * (top - z)
    neck = 0.7 * radius
    outside = [(0.8 * radius, 0.0), (radius, 0.35 * high), (neck, 0.9 * high)]
    inside = [(r - 0.002, max(h, 0.003)) for r, h in outside[::-1]]
    jug = a.slider("jug", FRONT, (0, y, z), a.draw(0.08, 0.2), look=dark)
    jug.add(lathe([*outside, *inside], (0, y, z)), look=STEEL)
    jug.add(lathe([(neck, 0.9 * high + 0.0005), (0.65 * radius, high - 0.001)], (0, y, z)))
    bend = [(0.72, 0.0, 0.85), (1.0, 0.025, 0.8), (1.0, 0.02, 0.25), (0.95, 0.0, 0.3)]
    handle = [(0.0, y - share * radius - out, z + level * high) for share, out, level in bend]
    jug.add(pipe(handle, 0.006, 8))


def toaster(a: Assembly) -> None:
    """Build a shell with slots on top; levers, knobs and buttons at one end or in front."""
    skin, dark = a.picks((STEEL, RED, BLACK, WHITE), (BLACK, STEEL))
    slots = a.pick(1, 2, 2, 4)
    long, pitch, wide = a.draws((0.12, 0.2), (0.045, 0.06), (0.022, 0.032))
    foot, high, r = a.draws((0.004, 0.015), (0.15, 0.22), (0.01, 0.05))
    half_x = long / 2 + a.draw(0.02, 0.05)
    half_y = slots * pitch / 2 + a.draw(0.015, 0.03)
    r = min(r, half_y - slots * pitch / 2 + 0.012)
    x, y = centred(half_x, half_y)
    body = a.body(skin)
    inner = rounded(within(x, 0.003), within(y, 0.003), r - 0.003)
    body.add(ribbon(rounded(x, y, r), inner, (foot, high - 0.002), looped=True))
    body.add(block(within(x, 0.003), within(y, 0.003), span(foot + 0.001, 0.003), r - 0.003))
    # Strips between the slots, and two ends with the round corners of the shell.
    z = (high - 0.012, high)
    cut = long / 2
    quarter = arc((half_x - 0.0025 - r, half_y - 0.0025 - r), r, 0.0, np.pi / 2, 6)
    line = np.concatenate([(quarter * (1, -1))[::-1], quarter])
    body.add(*both(ribbon(np.column_stack([0 * line[:, 0] + cut, line[:, 1]]), line, z)))
    middles = [(i - (slots - 1) / 2) * pitch for i in range(slots)]
    edges = [y[0] + 0.0025, *(end for at in middles for end in about(wide / 2, at)), y[1] - 0.0025]
    strips = zip(edges[::2], edges[1::2], strict=True)
    body.add(*(box(about(cut), strip, within(z, 0.0, 0.0002)) for strip in strips))
    feet = (cylinder(Z, at, 0.009, (0.0, foot + 0.0005), 12) for at in corners(x, y, 0.02))
    body.add(*feet, look=dark)
    if a.happens(0.75):
        _panel(a, max(1, slots // 2), half_y - r, foot, high, dark, facing_side(half_x))
    else:
        _panel(a, max(1, slots // 2), half_x - r, foot, high, dark, facing_front(-half_y))


def _panel(
    a: Assembly, levers: int, room: float, foot: float, high: float, dark: Material, place: Place
) -> None:
    """Build levers above knobs and buttons."""
    upper = 0.8 * high
    reach = a.draw(0.25, 0.4) * (high - foot)
    for i in range(levers):
        x = (i - (levers - 1) / 2) * 1.1 * room
        wide, out, thick = a.draws((0.012, 0.025), (0.015, 0.035), (0.003, 0.008))
        lever = a.slider(f"lever_{i}", DOWN, (x, 0, upper), reach, look=dark, place=place)
        lever.add(box(about(0.003, x), (-0.4 * out, -PLAY), about(0.002, upper)))
        wide = min(wide, 0.4 * room)
        cap = (-1.2 * out, -0.4 * out)
        lever.add(block(about(wide, x), cap, about(thick, upper), 0.006, 0.001))
    floor = upper - reach - 0.012
    lower = foot + 0.35 * (high - foot)
    count = a.count(1, 3) * levers
    radius = min(a.draw(0.008, 0.016), 0.8 * room / count, (floor - lower) / 2 + 0.02)
    for i in range(count):
        z = max(foot + radius + 0.005, floor - radius - 0.003)
        at = ((i - (count - 1) / 2) * 1.8 * room / count, z)
        _control(a, i, at, radius, dark, place, 0.5 if i else 1.0)
