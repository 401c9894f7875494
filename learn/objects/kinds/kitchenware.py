"""Pots, kettles, bottles, dispensers, pepper mills, coffee machines and toasters."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import DOWN, FRONT, LEFT, RIGHT, UP, Place, Z, facing_front, facing_side, facing_up
from ..kit.boards import corners, tray
from ..kit.controls import ControlPanel
from ..kit.looks import BLACK, BLUE, BRASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.outlines import arc, rounded
from ..kit.pulls import Pull, add_pull
from ..kit.shapes import ball, block, both, box, cylinder, lathe, pipe, ribbon
from ..kit.spans import PLAY, Profile, about, centred, ends, span, within


def _walled(outer: Profile, wall: float, floor: float) -> Profile:
    """Return the profile up the outside and down the inside of a vessel [m]."""
    inner = [(max(r - wall, 0.002), h) for r, h in reversed(outer) if h > floor]
    return [*outer, *inner, (max(min(inner[-1][0], outer[0][0] - wall), 0.002), floor)]


def _side_curve(a: Assembly, foot: float, belly: float, rim: float, high: float) -> Profile:
    """Return a smooth profile from foot to rim through a belly [m]."""
    top = a.draw(0.35, 0.7)
    t = np.linspace(0.0, 1.0, a.count(4, 8))
    phase = np.where(t < top, t / top, 1.0 + (t - top) / (1 - top))
    base = np.where(t < top, foot, rim)
    radius = base + (belly - base) * np.sin(np.pi / 2 * phase)
    return list(zip(radius.tolist(), (high * t).tolist(), strict=True))


def _lid_knob(a: Assembly, lid: PartDraft, z: float, size: float, look: Material) -> None:
    """Put a knob or a bow of some ``size`` [m] on the middle of a lid whose top is at ``z``."""
    kind = a.weighted({"knob": 0.4, "ball": 0.3, "bow": 0.3})
    pull = Pull(kind, 3.2 * size, 1.7 * size, 0.6 * size, look)
    add_pull(lid, pull, (0.0, 0.0), facing_up(z), 4.0 * size)


def pot(a: Assembly) -> None:
    """Build a pot or a pan with a lid that lifts, at times turns; two ears or one long handle."""
    wide, wall = a.draws((0.08, 0.16), (0.002, 0.006))
    skin, dark = a.picks((STEEL, RED, BLACK, GREEN, BLUE), (BLACK, STEEL, BRASS))
    sides = a.pick(20, 32, 40)
    high = wide * a.draw(0.45, 1.5)
    outer: Profile = [(0.94 * wide, 0.0), (wide, 0.06 * high), (wide, high)]
    if a.happens(0.4):
        outer = _side_curve(a, a.draw(0.5, 0.8) * wide, wide * a.draw(1.0, 1.15), wide, high)
    if a.happens(0.5):
        outer += [(wide + 0.004, high + 0.0005), (wide + 0.004, high + 0.003)]
    a.body(skin, lathe(_walled(outer, wall, 0.05 * high + 0.002), sides=sides))
    _handles(a, wide, high, dark)
    rim, top = outer[-1]
    low = top + PLAY
    lid = a.screw("lid", UP, (0, 0, top), a.draw(0.3, 1.0) * high, 0.35)
    angle = np.linspace(0.0, 1.5, 5)[1:]
    radius = rim * np.cos(angle) + 0.006 * (1 - np.cos(angle))
    level = low + 0.004 + a.draw(0.0, 0.35) * wide * np.sin(angle)
    dome = zip(radius.tolist(), level.tolist(), strict=True)
    lid.add(lathe([(rim, low), (rim, low + 0.003), *dome], sides=sides))
    neck = wide - wall - 0.003
    lid.add(lathe([(neck, top - 0.006), (neck, top + 0.0008)], sides=sides))
    _lid_knob(a, lid, float(level[-1]), a.draw(0.012, 0.022), dark)


def _handles(a: Assembly, wide: float, high: float, look: Material) -> None:
    style = a.weighted({"bent": 0.45, "block": 0.25, "long": 0.3})
    z = (0.75 if style == "long" else 0.7) * high
    if style == "long":
        long, rise, start, end = a.draws((0.12, 0.22), (0.0, 0.05), (0.005, 0.009), (0.009, 0.013))
        bar = [(0.97 * wide, 0.0), (wide + 0.3 * long, 0.5 * rise), (wide + long, rise)]
        path = [(x, 0.0, z + up) for x, up in bar]
        handle = pipe(path, [start, 0.009, end], a.pick(4, 10), up=UP, flat=a.draw(0.6, 1.0))
        a.root.add(handle, look=look)
        return
    half, out, thick = a.draws((0.2 * wide, 0.4 * wide), (0.02, 0.045), (0.004, 0.008))
    far = wide + out
    if style == "bent":
        line = [(0.96 * wide, -half), (far, -half), (far, half), (0.96 * wide, half)]
        ear = pipe([(x, y, z) for x, y in line], thick, 8)
    else:
        ear = block((0.95 * wide, far), about(half), about(thick, z), 0.4 * out, 0.3 * thick)
    a.root.add(*both(ear), look=look)


def kettle(a: Assembly) -> None:
    """Build a body with a spout and a handle; a lid that lifts off or turns; at times electric."""
    rim, belly, high, foot = a.draws((0.04, 0.065), (0.07, 0.1), (0.12, 0.22), (0.06, 0.085))
    skin, dark = a.picks((STEEL, WHITE, RED, BLACK), (BLACK, WALNUT, STEEL))
    electric, hinged, switched = a.happen(0.5, 0.4, 0.8)
    lift = a.draw(0.015, 0.025) if electric else 0.0
    outer = [(r, h + lift) for r, h in _side_curve(a, foot, belly, rim, high)]
    body = a.body(skin, lathe(_walled(outer, 0.002, lift + 0.01), sides=32))
    if electric:
        plate = [(belly * 0.95, 0.0), (belly, 0.4 * lift), (0.85 * belly, lift - 0.001)]
        body.add(lathe(plate, sides=32), look=dark)
    _spout(a, outer, lift, high)
    top = high + lift
    over = not electric and a.happens(0.5)
    if over:
        y, rise = arc((0.0, 0.0), 1.0, 0.1, np.pi - 0.1, 11).T
        level = top - 0.04 + rise * a.draw(0.14, 0.18)
        path = np.stack([0 * y, y * max(0.85 * belly, 0.085), level], axis=1)
        body.add(pipe(path, a.draw(0.005, 0.008), 8), look=dark)
    else:
        _back_handle(a, outer, lift, high, dark)
    z = top + PLAY
    if hinged and not over:
        # Its pin lies beside the handle, behind the rim.
        pin = rim + 0.006
        lid = a.hinge("lid", LEFT, (0, pin, z + 0.004), a.degrees(50, 85))
        lid.add(box(about(0.008), (0.8 * rim, pin + 0.003), (z + 0.0002, z + 0.003)))
    else:
        # A bail leaves less room.
        reach = a.draw(0.02, 0.035) if over else a.draw(0.03, 0.12)
        lid = a.screw("lid", UP, (0, 0, z), reach, 0.3)
    middle, peak = a.draws((z + 0.006, z + 0.02), (z + 0.02, z + 0.022))
    dome = [(rim, z), (0.97 * rim, z + 0.004), (0.5 * rim, middle), (0.2 * rim, peak)]
    lid.add(lathe(dome, sides=32))
    _lid_knob(a, lid, z + 0.018, a.draw(0.008, 0.013), dark)
    if electric and switched:
        y = belly + 0.012
        low = lift + 0.03
        body.add(box(about(0.013), (outer[0][0] - 0.01, y - PLAY), about(0.012, low)), look=dark)
        look = a.pick(RED, BLACK)
        switch = a.hinge("switch", RIGHT, (0, y, low + 0.003), a.degrees(15, 30), look=look)
        switch.add(box(about(0.01), span(y + 0.003, 0.02), span(low, 0.006)))


def _radius_at(outer: Profile, height: float) -> float:
    radius, level = np.array(outer).T
    return float(np.interp(height, level, radius))


def _spout(a: Assembly, outer: Profile, lift: float, high: float) -> None:
    """Build a tapered tube towards -Y, straight or in an S."""
    share, out, wide, up = a.draws((0.35, 0.75), (0.05, 0.1), (0.014, 0.022), (0.7, 1.1))
    low = lift + share * high
    rise = (1.0 - share) * high * up
    start = 0.9 * _radius_at(outer, low)
    swing = 0.25 * out if a.happens(0.5) else 0.0
    bend = ((0.0, 0.0, 0.0), (0.4, swing, 0.25), (0.7, 0.0, 0.65), (1.0, swing, 1.0))
    path = [(0.0, -start - f * out - shift, low + up * rise) for f, shift, up in bend]
    a.root.add(pipe(path, wide * np.array((1.0, 0.8, 0.6, 0.5)), 12, up=RIGHT))


def _back_handle(a: Assembly, outer: Profile, lift: float, high: float, look: Material) -> None:
    upper, out, thick, flat = a.draws((0.8, 0.93), (0.035, 0.05), (0.007, 0.011), (0.7, 1.3))
    low = lift + 0.2 * high + 0.03
    top = lift + upper * high
    far = max(r for r, _ in outer) + out
    head = [(0.97 * _radius_at(outer, top), top), (far - 0.01, top + 0.004)]
    bend = [(far, lift + 0.9 * upper * high), (far - 0.005, low + 0.02)]
    line = [*head, *bend, (0.97 * _radius_at(outer, low), low + 0.03)]
    path = [(0.0, y, z) for y, z in line]
    a.root.add(pipe(path, thick, 8, up=RIGHT, flat=flat), look=look)


def bottle(a: Assembly) -> None:
    """Build a bottle or a jar with a screw cap that comes off; at times a hinged cap."""
    wide, high, neck_h, power = a.draws((0.025, 0.06), (0.07, 0.3), (0.015, 0.03), (0.6, 1.4))
    skin, cap_skin = a.picks((GREEN, BLUE, WHITE, STEEL, RED), (RED, WHITE, BLACK, BLUE))
    neck = wide * a.draw(0.28, 0.5)
    shoulder = a.draw(0.1, 0.35) * high
    if a.happens(0.4):
        neck = wide * a.draw(0.7, 0.9)
        shoulder = 0.05 * high
    start = high - neck_h
    t = np.linspace(0.0, 0.75, 4)
    slope = neck + (wide - neck) * np.cos(np.pi / 2 * t) ** power
    curve = list(zip(slope.tolist(), (start - shoulder * (1 - t)).tolist(), strict=True))
    low: Profile = [(0.85 * wide, 0.0), (wide, 0.06 * high)]
    if a.happens(0.4):
        waist = (a.draw(0.8, 0.95) * wide, 0.4 * high)
        low += [(1.001 * wide, 0.3 * high), waist, (wide, 0.5 * high)]
    low = [p for p in low if p[1] < curve[0][1] - 0.003]
    sides = a.pick(4, 6, 24, 32) if a.happens(0.3) else 28
    deep = a.draw(0.5, 1.0) if a.happens(0.3) else 1.0
    core = 0.86 * neck * deep
    body = a.body(skin, lathe([*low, *curve, (neck, start)], sides=sides, stretch=(1.0, deep)))
    body.add(lathe([(core, start - 0.004), (core, high)]))
    # Its flats, not its corners, keep clear of the neck.
    ridges = a.pick(12, 24, 32)
    inner = core / np.cos(np.pi / ridges) + PLAY
    grip = max(neck * a.draw(0.95, 1.15), inner + 0.0015)
    base = start + PLAY
    seat = high + PLAY
    top = seat + a.draw(0.002, 0.02)
    if a.happens(0.2):
        # A flip top: a disc on the neck, its pin behind.
        cap = a.hinge("cap", LEFT, (0, grip + 0.002, seat), a.degrees(90, 150), look=cap_skin)
        cap.add(lathe([(grip, seat), (grip, top), (0.9 * grip, top + 0.001)], sides=ridges))
        tab = span(seat + 0.0001, 0.0019)
        cap.add(box(about(0.004), span(0.9 * grip, 0.1 * grip + 0.003), tab))
        cap.add(box(about(0.006), span(-0.9 * grip, -0.1 * grip - 0.003), tab))
        return
    cap = a.screw("cap", UP, (0, 0, base), a.draw(1.2, 3.0) * neck_h, 0.8, look=cap_skin)
    shape = [(inner, seat), (inner, base), (grip, base), (grip, top - 0.001), (0.9 * grip, top)]
    cap.add(lathe(shape, sides=ridges))


def dispenser(a: Assembly) -> None:
    """Build a soap or lotion bottle with a pump that goes down and turns."""
    wide, high = a.draws((0.025, 0.045), (0.09, 0.18))
    collar, stroke = a.draws((0.011, 0.016), (0.012, 0.025))
    skin, pump_skin = a.picks((WHITE, BLUE, GREEN, STEEL), (BLACK, WHITE, STEEL))
    outer = _side_curve(a, 0.9 * wide, wide * a.draw(1.0, 1.2), 0.45 * wide, high)
    body = a.body(skin, lathe(outer, sides=a.pick(4, 24, 32)))
    well = high + 0.014
    hole = 0.004 + 2 * PLAY
    socket = [(collar, high + 0.0005), (collar, well), (hole, well), (hole, high + 0.002)]
    body.add(lathe(socket, sides=20), look=pump_skin)
    low = well + stroke + PLAY
    down = min(stroke, 0.0115)
    pump = a.screw("pump", DOWN, (0, 0, low), down, 0.5, look=pump_skin)
    pump.add(cylinder(Z, (0.0, 0.0), 0.004, (high + 0.0025 + down, low + 0.001), 12))
    pump.add(lathe([(0.009, low), (0.01, low + 0.006), (0.008, low + 0.012)], sides=16))
    reach = a.draw(0.03, 0.05)
    spout = [(0, 0, low + 0.007), (0, -0.7 * reach, low + 0.008), (0, -reach, low + 0.002)]
    pump.add(pipe(spout, [0.006, 0.005, 0.003], 8))


def pepper_mill(a: Assembly) -> None:
    """Build a turned body under a head, or a crank, that turns without end."""
    wide, high, thin = a.draws((0.022, 0.032), (0.07, 0.18), (0.05, 0.45))
    skin, metal = a.picks((OAK, WALNUT, BLACK, STEEL, WHITE), (STEEL, BRASS))
    body = a.body(skin)
    z = high + PLAY
    t = np.linspace(0.0, 1.0, 7)
    waist = wide * (1.0 - thin * np.abs(np.sin(np.pi * t)) ** 1.5)
    body.add(lathe(np.stack([waist, t * high], axis=1), sides=28))
    head = a.spin("head", UP, (0, 0, z), look=skin)
    if a.happens(0.6):
        top = a.draw(0.9, 1.15) * wide
        angle = np.linspace(-0.9, 1.3, 7)
        dome = np.stack([np.cos(angle), np.sin(angle) + np.sin(0.9)], axis=1) * top
        head.add(lathe(dome, (0, 0, z), sides=28))
        head.add(ball((0, 0, z + 1.85 * top), 0.25 * top, 10), look=metal)
        return
    reach = a.draw(0.04, 0.07)
    level = z + 0.5 * wide + 0.003
    head.add(lathe([(0.9 * wide, z), (0.5 * wide, z + 0.5 * wide)]), look=metal)
    head.add(pipe([(0, -0.004, level), (0, -reach, level + 0.008)], 0.004, 4, flat=0.6), look=metal)
    grip = [(0.005, level + 0.007), (0.008, level + 0.019), (0.006, level + 0.027)]
    head.add(lathe(grip, (0, 0.006 - reach, 0), sides=12))


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
    panel = ControlPanel(a, facing_front(front), dark)
    for i in range(count):
        at = ((i - (count - 1) / 2) * 1.7 * half / count, (under + high) / 2)
        panel.control(i, at, radius, 0.5)
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
        ControlPanel(a, place, dark).control(i, at, radius, 0.5 if i else 1.0)
