"""Bins: with a swing lid, a pedal, a push flap, on wheels; and pails."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import FloatArray

from ..kit.assembly import Assembly
from ..kit.axes import DOWN, LEFT, RIGHT, UP, X
from ..kit.boards import tray
from ..kit.looks import BLACK, BLUE, GREEN, RED, STEEL, WHITE
from ..kit.outlines import arc, oval, raised, rounded
from ..kit.shapes import Form, block, both, box, cylinder, lathe, loft, pipe, prism, ribbon, stack
from ..kit.spans import PLAY, Profile, about, centred, ends, span, within
from ..kit.wheels import wheel

SKINS = (WHITE, GREEN, STEEL, BLUE, RED, BLACK)


def _outline(a: Assembly, half_x: float, half_y: float) -> FloatArray:
    """Return a rounded rectangle or an ellipse around the origin [m]."""
    if a.happens(0.35):
        return oval(half_x, half_y)
    corner = a.draw(0.01, 0.9 * min(half_x, half_y))
    return rounded(about(half_x), about(half_y), corner, 6)


def _bucket(a: Assembly, outline: FloatArray, low: float, high: float) -> Form:
    """Return a hollow, tapered body, open at its top."""
    foot = a.draw(0.65, 1.0)
    inner = 1.0 - 0.004 / np.abs(outline).max()
    rows = [(foot, low), (1.0, high), (inner, high), (foot * inner, low + 0.004)]
    return stack([(share * outline, z) for share, z in rows])


def swing_bin(a: Assembly) -> None:
    """Build a bin under a lid with a hole; in it a flap, or two halves, that swing both ways."""
    half_x, half_y, high = a.draws((0.12, 0.22), (0.1, 0.18), (0.35, 0.75))
    share, thick = a.draws((0.6, 0.85), (0.003, 0.02))
    skin, top = a.picks(SKINS, SKINS)
    outline = _outline(a, half_x, half_y)
    hole = outline * share
    level = high + (a.draw(0.0, 0.1) if a.happens(0.5) else 0.0)
    body = a.body(skin, _bucket(a, outline, 0.0, high))
    lines = (1.02 * outline, hole, hole, 0.99 * outline)
    heights = (high + 0.003, level + 0.003, level - 0.002, high - 0.0002)
    rim = [raised(line, z) for line, z in zip(lines, heights, strict=True)]
    body.add(loft(rim, looped=True), look=top)
    room = np.abs(hole).max(axis=0)
    plate = hole * (1.0 - (PLAY + 0.5 * thick) / room)
    if a.happens(0.75):
        flap = a.hinge("flap", RIGHT, (0, 0, level), np.pi / 2, -np.pi / 2, look=top)
        edges = ((0.99, level - thick / 2), (1.0, level), (0.99, level + thick / 2))
        flap.add(stack([(s * plate, z) for s, z in edges]))
        return
    body.add(box(about(room[0]), about(0.0015), (level - 0.02, level - 0.006)), look=top)
    for name, side in (("front", -1.0), ("rear", 1.0)):
        y = side * (np.maximum(side * plate[:, 1], 0.001) + 0.002)
        half = np.column_stack([plate[:, 0], 0.97 * y])
        half = half[np.append(True, np.linalg.norm(np.diff(half, axis=0), axis=1) > 1e-6)]
        at = (0.0, side * float(np.abs(half[:, 1]).max()), level - 0.003)
        flap = a.hinge(f"{name}_flap", (-side, 0.0, 0.0), at, a.degrees(30, 55), look=top)
        flap.add(prism(half, (level - 0.003, level)))


def step_bin(a: Assembly) -> None:
    """Build a bin with a domed lid at the end of a hinge behind it, a pedal, at times a bail."""
    half_x, half_y, high = a.draws((0.1, 0.2), (0.1, 0.18), (0.25, 0.65))
    base, rise = a.draws((0.02, 0.045), (0.008, 0.09))
    skin, dark = a.picks(SKINS, (BLACK, STEEL))
    outline = _outline(a, half_x, half_y)
    body = a.body(skin, _bucket(a, outline, base, high))
    under = (0.0, base - 0.0005)
    if a.happens(0.75):
        body.add(box(about(0.7 * half_x), (-0.5 * half_y, 0.9 * half_y), under), look=dark)
        _pedal(a, -half_y, -0.5 * half_y - PLAY, 0.5 * base)
    else:
        body.add(ribbon(1.01 * outline, 0.6 * outline, under, looped=True), look=dark)
    reach = outline.max(axis=0)
    level = high + PLAY
    pin = float(reach[1]) * 1.01 + 0.006
    ear = box(about(0.028), (pin - 0.009, pin + 0.003), (level - 0.04, level - 0.006))
    body.add(ear, look=dark)
    turn = a.degrees(60, 90)
    lid = a.hinge("lid", LEFT, (0, pin, level + 0.001), turn, look=a.pick(skin, dark))
    rows = ((1.01, 0.0), (1.01, 0.3 * rise), (0.85, 0.8 * rise), (0.4, rise))
    lid.add(stack([(s * outline, level + z) for s, z in rows]))
    tab = (level + 0.0003, level + 0.006)
    lid.add(box(about(0.03), (pin - 0.03, pin + 0.003), tab), look=dark)
    if a.happens(0.3):
        # It hangs in front, a little below level, and is lifted to just short of the lid.
        angle = np.linspace(0.0, np.pi, 21)
        arch = 1.15 * (half_y + 0.02) * np.sin(angle) ** 0.2
        x = (float(reach[0]) + 0.012) * np.cos(angle)
        path = np.stack([x, -0.97 * arch, 0.8 * high - 0.25 * arch], axis=1)
        bail = a.hinge("bail", LEFT, (0, 0, 0.8 * high), a.draw(0.5, 0.7), look=STEEL)
        bail.add(pipe(path, 0.003, 6, up=UP))


def _pedal(a: Assembly, front: float, start: float, z: float) -> None:
    """Build a lever under a bin, from y = ``start`` to before its ``front``; its end goes down."""
    if a.happens(0.25):
        pedal = a.slider("pedal", DOWN, (0, start, z), z - 0.005, look=BLACK)
    else:
        tip = np.arctan((z - 0.006) / (start - front + 0.06))
        pedal = a.hinge("pedal", RIGHT, (0, start, z), tip, look=BLACK)
    pedal.add(box(about(0.012), (front - 0.02, start), about(0.003, z)))
    plate = (front - 0.06, front - 0.018)
    pedal.add(block(about(a.draw(0.03, 0.06)), plate, about(0.004, z), 0.01))


def wheelie_bin(a: Assembly) -> None:
    """Build a tall tapered bin on two wheels with a sloping lid and a grip behind."""
    half_x, half_y, high = a.draws((0.2, 0.32), (0.22, 0.36), (0.75, 1.0))
    foot, radius, wide, rise = a.draws((0.7, 0.9), (0.08, 0.12), (0.03, 0.05), (0.01, 0.1))
    outline = rounded(about(half_x), about(half_y), 0.03)
    skins = (GREEN, BLUE, BLACK, RED)
    body = a.body(a.pick(*skins))
    floor = 0.02
    rows = ((foot, floor), (1.0, high), (0.97, high), (0.97 * foot, floor + 0.006))
    body.add(stack([(share * outline, z) for share, z in rows]))
    collar = (high - 0.04, high - 0.0003)
    body.add(ribbon(outline * (1.06, 1.05), outline * 0.985, collar, looped=True))
    axle = foot * half_y + radius * 0.6
    # The body is this wide where the wheels end.
    waist = half_x * (foot + (1.0 - foot) * 2.2 * radius / high)
    reach = max(half_x - 0.5 * wide, waist + 0.003)
    body.add(cylinder(X, (axle, radius), 0.01, about(reach), 12), look=STEEL)
    arm = (foot * half_y - 0.03, axle + 0.015)
    body.add(*both(box(about(0.02, 0.4 * half_x), arm, about(0.025, radius))))
    leg = span(-foot * half_y, 0.05)
    body.add(*both(box(about(0.02, foot * half_x * 0.8), leg, (0.0, floor + 0.002))))
    for name, side in (("left", -1.0), ("right", 1.0)):
        at = (side * (reach + wide / 2 + PLAY), axle, radius)
        wheel(a, f"{name}_wheel", at, radius, wide, STEEL)
    pin = half_y * 1.05 + 0.025
    corners = [(1, half_y), (1, pin + 0.03), (-1, pin + 0.03), (-1, half_y)]
    body.add(pipe([(0.8 * half_x * side, y, high - 0.03) for side, y in corners], 0.012, 8))
    level = high + PLAY
    turn = a.degrees(100, 165)
    lid = a.hinge("lid", LEFT, (0, pin, level + 0.004), turn, look=a.pick(*skins))
    rim = outline * (1.08, 1.06)
    lid.add(stack([(rim, level), (rim, level + 0.012), (0.9 * outline, level + 0.012 + rise)]))
    tab = span(level + 0.0005, 0.0105)
    lid.add(*both(box(about(0.03, 0.6 * half_x), (half_y, pin + 0.006), tab)))


def push_bin(a: Assembly) -> None:
    """Build a tall bin under a dome with an upright flap in front that is pushed in."""
    radius, high, dome = a.draws((0.12, 0.2), (0.45, 0.7), (0.2, 0.3))
    skin, top = a.picks(SKINS, SKINS)
    corner = a.draw(0.01, 0.05) if a.happens(0.5) else 0.98 * radius
    y = about(radius)
    body = a.body(skin, _bucket(a, rounded(y, y, corner, 5), 0.0, high))
    half = 0.6 * radius
    walls = span(high + 0.0005, dome)
    roof = (walls[1] + 0.0002, walls[1] + a.draw(0.008, 0.04))
    # A hood of three walls and a roof; the flap hangs in the open front.
    body.add(*both(box((half, radius), y, walls)), look=top)
    body.add(box(about(half), span(radius, -0.004), walls), block(y, y, roof, 0.02), look=top)
    pin = 0.007 - radius
    x = about(half - PLAY)
    z = within(walls, 0.004, 0.012)
    # It swings in until it meets the wall behind.
    upper = min(a.degrees(50, 85), np.arcsin(min(1.0, (2 * radius - 0.03) / (z[1] - z[0]))))
    look = a.pick(top, BLACK, STEEL)
    flap = a.hinge("flap", RIGHT, (0, pin, z[1]), upper, -a.degrees(5, 60), look=look)
    flap.add(box(x, about(0.003, pin), z))
    flap.add(cylinder(X, (pin, z[1]), 0.005, x, 10), look=STEEL)
    if a.happens(0.3):
        at = (0.0, 0.5 * radius, walls[1])
        body.add(lathe([(0.03, 0.001), (0.025, 0.045)], at), look=top)
        button = a.slider("button", DOWN, at, 0.004, look=STEEL)
        button.add(lathe([(0.02, 0.05), (0.018, 0.056)], at, sides=16))


def bucket(a: Assembly) -> None:
    """Build a pail or a basket with a bail that swings over it; some have a lid that lifts off."""
    wide, high = a.draws((0.1, 0.17), (0.12, 0.32))
    skin, metal = a.picks(SKINS, (STEEL, BLACK))
    foot = wide * a.draw(0.6, 1.0)
    sides = a.pick(4, 8, 24, 32)
    profile: Profile = [(foot, 0.0), (wide, high), (wide - 0.003, high), (foot - 0.003, 0.005)]
    if a.happens(0.5):
        rim = wide + 0.005
        profile[1:2] = [(0.995 * wide, high - 0.012), (rim, high - 0.011), (rim, high)]
    body = a.body(skin, lathe(profile, sides=sides))
    flat = wide * np.cos(np.pi / sides) if sides < 24 else wide
    pin = flat + 0.012
    z = high - a.draw(0.02, 0.04)
    body.add(*both(cylinder(X, (0.0, z), 0.008, span(flat - 0.006, 0.014), 12)), look=metal)
    lidded = a.happens(0.3)
    reach = np.radians(75 if lidded else 100)
    if lidded:
        bail = a.hinge("bail", LEFT, (0, 0, z), 0.3, -reach, rest=-reach, look=metal)
    else:
        lean = min(max(np.radians(a.draw(-20, 110)), -reach), reach)
        bail = a.hinge("bail", RIGHT, (0, 0, z), reach + 0.001, -reach, rest=lean, look=metal)
    # The fewer the corners, the squarer the bail that clears them.
    bow = {4: 0.2, 8: 0.35}.get(sides, 0.5)
    x, rise = arc((0.0, 0.0), 1.0, 0.0, np.pi, 21).T
    path = np.stack([pin * x, 0 * x, z + a.draw(1.1, 1.3) * (pin + 0.02) * rise**bow], axis=1)
    bail.add(pipe(path, 0.0025, 8))
    if a.happens(0.5):
        tube = cylinder(X, (0.0, float(path[10, 2])), 0.009, about(0.045), 12)
        bail.add(tube, look=a.pick(BLACK, WHITE, RED))
    if lidded:
        lid = a.slider("lid", UP, (0, 0, high), a.draw(0.03, 0.08))
        shape = [(wide, 0.0), (wide, 0.006), (0.9 * wide, 0.012)]
        lid.add(lathe(shape, (0, 0, high + PLAY), sides=sides))


def trash_can(a: Assembly) -> None:
    """Build the demo's bin: boxy, a lid hinged at its back; most have a pedal in front."""
    width, depth, height = a.draws((0.25, 0.38), (0.26, 0.36), (0.4, 0.62))
    x, y = centred(width / 2, depth / 2)
    z = span(0.05, height)
    body = a.body(a.pick(STEEL, WHITE, GREEN, RED), *tray(x, y, z, 0.005))
    feet = ends(within(x, 0.003), 0.04)
    body.add(*(box(foot, within(y, 0.003), (0.0, z[0])) for foot in feet), look=BLACK)
    low = z[1] + 0.003
    look = a.pick(body.look, BLACK)
    lid = a.hinge("lid", LEFT, (0, y[1], low), a.degrees(75, 95), look=look)
    lid_x = within(x, -0.009)
    lid_y = within(y, -0.009, 0.0)
    skirt = (z[1] - 0.03, low)
    lid.add(box(lid_x, lid_y, span(low, 0.012)), box(lid_x, span(lid_y[0], 0.006), skirt))
    lid.add(*(box(end, within(lid_y, 0.006, 0.002), skirt) for end in ends(lid_x, 0.006)))
    lid.add(box(about(0.03), span(lid_y[0], -0.02), (low + 0.002, low + 0.01)))
    if a.happens(0.7):
        pivot = y[0] + 0.1
        pedal = a.hinge("pedal", RIGHT, (0, pivot, 0.028), np.radians(8.0), look=BLACK)
        pedal.add(box(about(0.012), (y[0] - 0.02, pivot), (0.028, 0.036)))
        pedal.add(box(about(0.045), span(y[0] - 0.02, -0.035), (0.027, 0.037)))
