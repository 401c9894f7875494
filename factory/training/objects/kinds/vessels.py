"""Pots, kettles, bottles, dispensers, pepper mills: turned on a lathe, with a lid, a cap or a pump."""

from __future__ import annotations

import numpy as np

from ....mesh import Material
from ..kit.assembly import DOWN, LEFT, RIGHT, UP, Assembly, PartDraft
from ..kit.looks import BLACK, BLUE, BRASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.shapes import Profile, Z, about, arc, ball, block, box, cylinder, lathe, pipe, span

#: Between a lid or a cap and what it lies on [m].
PLAY = 0.0006


def _walled(outer: Profile, wall: float, floor: float) -> Profile:
    """Up the outside and down the inside of a vessel, both [m]."""
    inner = [(max(r - wall, 0.002), h) for r, h in reversed(outer) if h > floor]
    return [*outer, *inner, (max(min(inner[-1][0], outer[0][0] - wall), 0.002), floor)]


def _side_curve(a: Assembly, foot: float, belly: float, rim: float, high: float) -> Profile:
    """From foot to rim through a belly, smooth [m]."""
    top, curve = a.draw(0.35, 0.7), []
    for t in np.linspace(0.0, 1.0, a.count(4, 8)).tolist():
        below = t < top
        bulge = np.sin(np.pi / 2 * t / top) if below else np.cos(np.pi / 2 * (t - top) / (1 - top))
        base = foot if below else rim
        curve.append((float(base + (belly - base) * bulge), high * t))
    return curve


def _lid(a: Assembly, z: float, reach: float, turns: float) -> PartDraft:
    """A lid that lifts, and in this share of cases turns as well."""
    if a.happens(turns):
        return a.spin("lid", UP, (0, 0, z), reach)
    return a.slider("lid", UP, (0, 0, z), reach)


def _round_knob(a: Assembly, part: PartDraft, z: float, size: float, look: Material) -> None:
    style = a.weighted({"turned": 0.4, "ball": 0.3, "bow": 0.3})
    if style == "turned":
        shape = ((0.5, 0.0), (0.4, 0.5), (1.0, 1.0), (0.9, 1.6))
        part.add(lathe([(r * size, z + h * size) for r, h in shape], sides=16), look=look)
    elif style == "ball":
        stem = cylinder(Z, (0.0, 0.0), 0.3 * size, span(z, 0.7 * size), 10)
        part.add(stem, ball((0, 0, z + 1.2 * size), 0.8 * size), look=look)
    else:
        x, rise = arc((0.0, 0.0), 1.6 * size, np.pi, 0.0, 9).T
        path = np.stack([x, 0 * x, z - 0.15 * size + 0.8 * rise], axis=1)
        part.add(pipe(path, 0.25 * size, 8), look=look)


def pot(a: Assembly) -> None:
    """A pot or a pan with a lid that lifts, and at times turns as well; two ears or one long handle."""
    skin, dark = a.picks((STEEL, RED, BLACK, GREEN, BLUE), (BLACK, STEEL, BRASS))
    wide, wall, sides = *a.draws((0.08, 0.16), (0.002, 0.006)), a.pick(20, 32, 40)
    high, body = wide * a.draw(0.45, 1.5), a.body(skin)
    outer: Profile = [(0.94 * wide, 0.0), (wide, 0.06 * high), (wide, high)]
    if a.happens(0.4):
        outer = _side_curve(a, a.draw(0.5, 0.8) * wide, wide * a.draw(1.0, 1.15), wide, high)
    if a.happens(0.5):
        outer += [(wide + 0.004, high + 0.0005), (wide + 0.004, high + 0.003)]
    body.add(lathe(_walled(outer, wall, 0.05 * high + 0.002), sides=sides))
    if a.happens(0.7):
        _ears(a, wide, 0.7 * high, dark)
    else:
        long, rise = a.draw(0.12, 0.22), a.draw(0.0, 0.05)
        bar = [(0.97 * wide, 0.0), (wide + 0.3 * long, 0.5 * rise), (wide + long, rise)]
        path, ends = (
            [(x, 0.0, 0.75 * high + z) for x, z in bar],
            a.draws((0.005, 0.009), (0.009, 0.013)),
        )
        handle = pipe(
            path, [ends[0], 0.009, ends[1]], a.pick(4, 10), up=(0, 0, 1), flat=a.draw(0.6, 1.0)
        )
        body.add(handle, look=dark)
    rim, top = outer[-1]
    lid, rise, low = (
        _lid(a, top, a.draw(0.3, 1.0) * high, 0.35),
        a.draw(0.0, 0.35) * wide,
        top + PLAY,
    )
    arch = np.linspace(0.0, 1.5, 5)[1:]
    dome = np.stack(
        [rim * np.cos(arch) + 0.006 * (1 - np.cos(arch)), low + 0.004 + rise * np.sin(arch)], axis=1
    )
    lid.add(lathe([(rim, low), (rim, low + 0.003), *dome.tolist()], sides=sides))
    neck = wide - wall - 0.003
    lid.add(lathe([(neck, top - 0.006), (neck, top + 0.0008)], sides=sides))
    _round_knob(a, lid, float(dome[-1, 1]), a.draw(0.012, 0.022), dark)


def _ears(a: Assembly, wide: float, z: float, look: Material) -> None:
    half, out, thick, bent = (
        wide * a.draw(0.2, 0.4),
        *a.draws((0.02, 0.045), (0.004, 0.008)),
        a.happens(0.65),
    )
    for side in (-1.0, 1.0):
        corners = [
            (0.96 * wide, -half),
            (wide + out, -half),
            (wide + out, half),
            (0.96 * wide, half),
        ]
        if bent:
            ear = pipe([(side * x, y, z) for x, y in corners], thick, 8)
        else:
            reach = span(side * 0.95 * wide, side * (out + 0.05 * wide))
            ear = block(reach, about(half), about(thick, z), 0.4 * out, 0.3 * thick)
        a.root.add(ear, look=look)


def kettle(a: Assembly) -> None:
    """A body with a spout and a handle; its lid lifts off or is hinged; electric ones have a switch and a base."""
    skin, dark = a.picks((STEEL, WHITE, RED, BLACK), (BLACK, WALNUT, STEEL))
    rim, belly, high, foot = a.draws((0.04, 0.065), (0.07, 0.1), (0.12, 0.22), (0.06, 0.085))
    electric, body = a.happens(0.5), a.body(skin)
    lift = a.draw(0.015, 0.025) if electric else 0.0
    outer = [(r, h + lift) for r, h in _side_curve(a, foot, belly, rim, high)]
    body.add(lathe(_walled(outer, 0.002, lift + 0.01), sides=32))
    if electric:
        plate = [(belly * 0.95, 0.0), (belly, 0.4 * lift), (0.85 * belly, lift - 0.001)]
        body.add(lathe(plate, sides=32), look=dark)
    top, over = high + lift, not electric and a.happens(0.5)
    _spout(a, outer, lift, high)
    if over:
        y, rise = arc((0.0, 0.0), 1.0, 0.1, np.pi - 0.1, 11).T
        path = np.stack(
            [0 * y, y * max(0.85 * belly, 0.085), top - 0.04 + rise * a.draw(0.14, 0.18)], axis=1
        )
        body.add(pipe(path, a.draw(0.005, 0.008), 8), look=dark)
    else:
        _back_handle(a, outer, lift, high, dark)
    z, pin = top + PLAY, rim + 0.006
    if a.happens(0.4) and not over:
        # Its pin lies beside the handle, behind the rim.
        lid = a.hinge("lid", LEFT, (0, pin, z + 0.004), a.degrees(50, 85))
        lid.add(box(about(0.008), (0.8 * rim, pin + 0.003), (z + 0.0002, z + 0.003)))
    else:
        # A bail leaves less room.
        lid = _lid(a, z, a.draw(0.02, 0.035) if over else a.draw(0.03, 0.12), 0.3)
    rises = a.draws((0.006, 0.02), (0.02, 0.022))
    dome = [(rim, z), (0.97 * rim, z + 0.004), (0.5 * rim, z + rises[0]), (0.2 * rim, z + rises[1])]
    lid.add(lathe(dome, sides=32))
    _round_knob(a, lid, z + 0.018, a.draw(0.008, 0.013), dark)
    if electric and a.happens(0.8):
        y, low = belly + 0.012, lift + 0.03
        body.add(box(about(0.013), (outer[0][0] - 0.01, y - PLAY), about(0.012, low)), look=dark)
        switch = a.hinge(
            "switch", RIGHT, (0, y, low + 0.003), a.degrees(15, 30), look=a.pick(RED, BLACK)
        )
        switch.add(box(about(0.01), span(y + 0.003, 0.02), span(low, 0.006)))


def _radius_at(outer: Profile, height: float) -> float:
    radius, level = np.array(outer).T
    return float(np.interp(height, level, radius))


def _spout(a: Assembly, outer: Profile, lift: float, high: float) -> None:
    """A tapered tube towards -Y, straight or in an S."""
    share, out, wide = a.draws((0.35, 0.75), (0.05, 0.1), (0.014, 0.022))
    low, rise = lift + share * high, (1.0 - share) * high * a.draw(0.7, 1.1)
    start, swing = 0.9 * _radius_at(outer, low), 0.25 * out if a.happens(0.5) else 0.0
    bend = ((0.0, 0.0, 0.0), (0.4, swing, 0.25), (0.7, 0.0, 0.65), (1.0, swing, 1.0))
    path = [(0.0, -start - f * out - shift, low + up * rise) for f, shift, up in bend]
    a.root.add(pipe(path, wide * np.array((1.0, 0.8, 0.6, 0.5)), 12, up=RIGHT))


def _back_handle(a: Assembly, outer: Profile, lift: float, high: float, look: Material) -> None:
    low, up = lift + 0.2 * high + 0.03, lift + a.draw(0.8, 0.93) * high
    far = max(r for r, _ in outer) + a.draw(0.035, 0.05)
    foot, head = (0.97 * _radius_at(outer, z) for z in (low, up))
    line = [(head, up), (far - 0.01, up + 0.004), (far, lift + 0.9 * (up - lift)), (far - 0.005, low + 0.02),
            (foot, low + 0.03)]  # fmt: skip
    path = [(0.0, y, z) for y, z in line]
    a.root.add(pipe(path, a.draw(0.007, 0.011), 8, up=RIGHT, flat=a.draw(0.7, 1.3)), look=look)


def bottle(a: Assembly) -> None:
    """A bottle or a jar with a screw cap that turns and comes off; at times a cap on a hinge."""
    skin, cap_skin = a.picks((GREEN, BLUE, WHITE, STEEL, RED), (RED, WHITE, BLACK, BLUE))
    wide, high, neck_h = a.draws((0.025, 0.06), (0.07, 0.3), (0.015, 0.03))
    jar, body, sides = a.happens(0.4), a.body(skin), a.pick(4, 6, 24, 32) if a.happens(0.3) else 28
    neck, shoulder = wide * a.draw(0.28, 0.5), a.draw(0.1, 0.35) * high
    if jar:
        neck, shoulder = wide * a.draw(0.7, 0.9), 0.05 * high
    start, power = high - neck_h, a.draw(0.6, 1.4)
    curve: Profile = [
        (float(neck + (wide - neck) * np.cos(np.pi / 2 * t) ** power), start - shoulder * (1 - t))
        for t in (0.0, 0.25, 0.5, 0.75)
    ]
    low: Profile = [(0.85 * wide, 0.0), (wide, 0.06 * high)]
    if a.happens(0.4):
        low += [
            (1.001 * wide, 0.3 * high),
            (a.draw(0.8, 0.95) * wide, 0.4 * high),
            (wide, 0.5 * high),
        ]
    low = [p for p in low if p[1] < curve[0][1] - 0.003]
    stretch = (1.0, a.draw(0.5, 1.0) if a.happens(0.3) else 1.0)
    body.add(lathe([*low, *curve, (neck, start)], sides=sides, stretch=stretch))
    core, ridges = 0.86 * neck * stretch[1], a.pick(12, 24, 32)
    body.add(lathe([(core, start - 0.004), (core, high)]))
    # Its flats, not its corners, keep clear of the neck.
    inner, base, seat = core / np.cos(np.pi / ridges) + PLAY, start + PLAY, high + PLAY
    grip, top = max(neck * a.draw(0.95, 1.15), inner + 0.0015), seat + a.draw(0.002, 0.02)
    if a.happens(0.2):
        # A flip top: a disc on the neck, its pin behind.
        cap = a.hinge("cap", LEFT, (0, grip + 0.002, seat), a.degrees(90, 150), look=cap_skin)
        cap.add(lathe([(grip, seat), (grip, top), (0.9 * grip, top + 0.001)], sides=ridges))
        tab = span(seat + 0.0001, 0.0019)
        cap.add(box(about(0.004), span(0.9 * grip, 0.1 * grip + 0.003), tab))
        cap.add(box(about(0.006), span(-0.9 * grip, -0.1 * grip - 0.003), tab))
        return
    at, reach = (0.0, 0.0, base), a.draw(1.2, 3.0) * neck_h
    if a.happens(0.8):
        cap = a.spin("cap", UP, at, reach, look=cap_skin)
    else:
        cap = a.slider("cap", UP, at, reach, look=cap_skin)
    shape = [(inner, seat), (inner, base), (grip, base), (grip, top - 0.001), (0.9 * grip, top)]
    cap.add(lathe(shape, sides=ridges))


def dispenser(a: Assembly) -> None:
    """A soap or lotion bottle with a pump that goes down and turns."""
    skin, pump_skin = a.picks((WHITE, BLUE, GREEN, STEEL), (BLACK, WHITE, STEEL))
    wide, high, collar, stroke = a.draws(
        (0.025, 0.045), (0.09, 0.18), (0.011, 0.016), (0.012, 0.025)
    )
    outer = _side_curve(a, 0.9 * wide, wide * a.draw(1.0, 1.2), 0.45 * wide, high)
    body, tube, well = a.body(skin), 0.004, high + 0.014
    body.add(lathe(outer, sides=a.pick(4, 24, 32)))
    hole = tube + 2 * PLAY
    socket = [(collar, high + 0.0005), (collar, well), (hole, well), (hole, high + 0.002)]
    body.add(lathe(socket, sides=20), look=pump_skin)
    low, down, reach = well + stroke + PLAY, min(stroke, 0.0115), a.draw(0.03, 0.05)
    if a.happens(0.5):
        pump = a.slider("pump", DOWN, (0, 0, low), down, look=pump_skin)
    else:
        pump = a.spin("pump", DOWN, (0, 0, low), down, look=pump_skin)
    pump.add(cylinder(Z, (0.0, 0.0), tube, (high + 0.0025 + down, low + 0.001), 12))
    pump.add(lathe([(0.009, low), (0.01, low + 0.006), (0.008, low + 0.012)], sides=16))
    spout = [(0, 0, low + 0.007), (0, -0.7 * reach, low + 0.008), (0, -reach, low + 0.002)]
    pump.add(pipe(spout, [0.006, 0.005, 0.003], 8))


def pepper_mill(a: Assembly) -> None:
    """A turned body under a head, or a crank, that turns without end."""
    skin, metal = a.picks((OAK, WALNUT, BLACK, STEEL, WHITE), (STEEL, BRASS))
    wide, high, body = *a.draws((0.022, 0.032), (0.07, 0.18)), a.body(skin)
    thin, z = a.draw(0.05, 0.45) * wide, high + PLAY
    t = np.linspace(0.0, 1.0, 7)
    body.add(
        lathe(
            np.stack([wide - thin * np.abs(np.sin(np.pi * t)) ** 1.5, t * high], axis=1).tolist(),
            sides=28,
        )
    )
    head = a.spin("head", UP, (0, 0, z), look=skin)
    if a.happens(0.6):
        top, angle = a.draw(0.9, 1.15) * wide, np.linspace(-0.9, 1.3, 7)
        dome = np.stack([top * np.cos(angle), z + top * (np.sin(angle) + np.sin(0.9))], axis=1)
        head.add(lathe(dome.tolist(), sides=28))
        head.add(ball((0, 0, z + 1.85 * top), 0.25 * top, 10), look=metal)
        return
    reach, level = a.draw(0.04, 0.07), z + 0.5 * wide + 0.003
    head.add(lathe([(0.9 * wide, z), (0.5 * wide, z + 0.5 * wide)]), look=metal)
    head.add(pipe([(0, -0.004, level), (0, -reach, level + 0.008)], 0.004, 4, flat=0.6), look=metal)
    grip = [(0.005, level + 0.007), (0.008, level + 0.019), (0.006, level + 0.027)]
    head.add(lathe(grip, (0, 0.006 - reach, 0), sides=12))


MAKERS = {
    "pot": pot,
    "kettle": kettle,
    "bottle": bottle,
    "dispenser": dispenser,
    "pepper_mill": pepper_mill,
}
