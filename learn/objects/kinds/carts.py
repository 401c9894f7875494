"""Trolleys, and whatever else stands on wheels."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly
from ..kit.axes import LEFT, RIGHT, X, Z
from ..kit.boards import corners
from ..kit.looks import BLACK, BLUE, GREEN, OAK, RED, STEEL, WHITE
from ..kit.shapes import Form, block, both, box, cylinder, lathe, loft, pipe, stack
from ..kit.spans import PLAY, Span, about, between, span, within
from ..kit.wheels import bracket, castor, wheel

SIDES = (("left", -1.0), ("right", 1.0))


def cart(a: Assembly) -> None:
    """Build a platform, shelves or a basket on four wheels: on fixed axles, castors, or both."""
    half_x, half_y, radius, wide = a.draws((0.18, 0.32), (0.28, 0.5), (0.03, 0.075), (0.015, 0.035))
    skin, metal = a.picks((STEEL, BLUE, RED, OAK, WHITE, GREEN), (STEEL, BLACK))
    deck = 2 * radius + a.draw(0.015, 0.04)
    body = a.body(skin)
    described = a.pick(_platform, _shelves, _basket)
    described(a, about(half_x), about(half_y), deck, metal)
    rear = a.pick("castor", "axle")
    front = rear
    if a.happens(0.5):
        front = "castor"
        rear = "axle"
    heading = a.draw(0.0, 2 * np.pi) if a.happens(0.3) else 0.0
    along = half_y - 1.1 * radius
    across = half_x - 0.6 * radius - wide
    for row, style, y in (("front", front, -along), ("rear", rear, along)):
        for name, side in SIDES:
            x = side * across
            if style == "castor":
                castor(a, f"{row}_{name}", (x, y, deck), radius, wide, heading, metal)
                continue
            wheel(a, f"{row}_{name}_wheel", (x, y, radius), radius, wide, metal)
            body.add(*bracket(x, y, radius, wide, deck + 0.001), look=metal)


def _push_bar(a: Assembly, x: Span, y: float, low: float, high: float, metal: Material) -> None:
    """Build an inverted U at the back, to push at."""
    half = x[1] - 0.02
    lean = a.draw(0.0, 0.12)
    right = [(half, y, low), (half, y + 0.8 * lean, high - 0.06), (half - 0.05, y + lean, high)]
    left = [(-px, py, pz) for px, py, pz in right]
    path = [*left, *right[::-1]]
    a.root.add(pipe(path, a.draw(0.01, 0.016), up=(0.0, 1.0, 0.0)), look=metal)


def _platform(a: Assembly, x: Span, y: Span, deck: float, metal: Material) -> None:
    top = span(deck, a.draw(0.015, 0.04))
    a.root.add(block(x, y, top, a.draw(0.003, 0.06), 0.003))
    _push_bar(a, x, y[1] - 0.03, top[1] - 0.005, deck + a.draw(0.7, 0.95), metal)


def _shelves(a: Assembly, x: Span, y: Span, deck: float, metal: Material) -> None:
    rise, lip, post = a.draws((0.22, 0.34), (0.0, 0.05), (0.008, 0.014))
    levels = [deck + i * rise for i in range(a.count(2, 4))]
    for level in levels:
        a.root.add(block(x, y, span(level, 0.012), 0.02))
        if lip > 0.02:
            a.root.add(*_rim(x, y, (level + 0.011, level + lip), 0.003))
    top = levels[-1]
    poles = (deck + 0.002, top + 0.012 + a.draw(0.0, 0.05))
    a.root.add(*(cylinder(Z, at, post, poles, 12) for at in corners(x, y, 0.02)), look=metal)
    if a.happens(0.6):
        _push_bar(a, x, y[1] - 0.03, top, top + a.draw(0.1, 0.2), metal)


def _rim(x: Span, y: Span, z: Span, thick: float) -> list[Form]:
    """Build four walls on the edges of a board."""
    sides = [box(about(thick, end), y, z) for end in within(x, 0.001)]
    return [*sides, *(box(x, about(thick, end), within(z, 0.0002)) for end in y)]


def _basket(a: Assembly, x: Span, y: Span, deck: float, metal: Material) -> None:
    """Build a cage of wires, or a tub, on a frame."""
    z = (deck + a.draw(0.15, 0.4), deck + a.draw(0.55, 0.8))
    posts = [cylinder(Z, at, 0.01, (deck + 0.014, z[1]), 10) for at in corners(x, y, 0.03)]
    a.root.add(block(x, y, span(deck, 0.015), 0.03), *posts, look=metal)
    if a.happens(0.4):
        a.root.add(*_rim(x, y, z, 0.005), box(x, y, (z[0] + 0.0005, z[0] + 0.006)))
    else:
        forms = []
        for level, thick in zip(np.linspace(*z, 4), (0.003, 0.003, 0.003, 0.006), strict=True):
            left, right = ([(side, end, level) for end in y] for side in x)
            forms.append(pipe([*left, *right[::-1]], thick, 6, looped=True))
        for v in between(x, 4):
            forms += [box(about(0.002, v), about(0.002, end), z) for end in y]
            forms.append(box(about(0.002, v), y, about(0.002, z[0])))
        forms += [box(about(0.002, end), about(0.002, v), z) for v in between(y, 5) for end in x]
        a.root.add(*forms, look=metal)
    _push_bar(a, x, y[1] - 0.01, z[1] - 0.02, z[1] + a.draw(0.08, 0.2), metal)


def wheelbarrow(a: Assembly) -> None:
    """Build a tray between two shafts, two legs behind, one wheel in front."""
    radius, wide, half, long = a.draws((0.15, 0.2), (0.06, 0.09), (0.2, 0.28), (0.65, 0.8))
    skin, metal = a.picks((GREEN, BLUE, RED, STEEL), (STEEL, BLACK))
    level = 2 * radius + 0.03
    gap = wide / 2 + 0.004
    body = a.body(skin)
    outline = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * (half, 0.55 * long)
    rows = ((0.55, 0.0), (1.0, 0.25), (0.985, 0.25), (0.54, 0.006))
    body.add(stack([(s * outline + (0.0, 0.5 * long), level + z) for s, z in rows]))
    shaft = [
        (gap, -0.2 * long, radius),
        (0.45 * half, 0.2 * long, level - 0.012),
        (0.6 * half, long, level - 0.01),
        (half, 1.7 * long, level + 0.12),
    ]
    leg = [
        (0.62 * half, 0.95 * long, level - 0.015),
        (0.72 * half, 0.85 * long, 0.0),
        (0.72 * half, 0.7 * long, 0.004),
    ]
    bars = both(pipe(shaft, 0.012, 8, up=(0, 0, 1)), pipe(leg, 0.011, 8, up=RIGHT))
    body.add(*bars, look=metal)
    at = (0.0, -0.2 * long, radius)
    wheel(a, "wheel", at, 0.98 * radius, 2 * (gap - 0.012 - PLAY) - 0.003, metal)


def hand_truck(a: Assembly) -> None:
    """Build an upright frame on two wheels with a toe plate, fixed or folding."""
    half, high, radius, wide = a.draws((0.18, 0.25), (1.0, 1.3), (0.08, 0.13), (0.03, 0.05))
    r, long = a.draws((0.012, 0.018), (0.18, 0.28))
    skin, metal = a.picks((RED, BLUE, BLACK, STEEL), (STEEL, BLACK))
    body = a.body(skin)
    right = [(half, 0.0, 0.05), (half, 0.0, high - 0.1), (half - 0.08, 0.0, high)]
    left = [(-x, y, z) for x, y, z in right]
    body.add(pipe([*left, *right[::-1]], r))
    rungs = np.linspace(0.12, high - 0.25, a.count(2, 4)).tolist()
    body.add(*(box(about(half), about(0.004), about(0.012, z)) for z in rungs))
    reach = half + r + 0.002
    arm = box(about(0.004, half), (0.0, 0.055), about(0.01, radius))
    body.add(*both(arm), cylinder(X, (0.05, radius), 0.007, about(reach), 10), look=metal)
    for name, side in SIDES:
        at = (side * (reach + wide / 2 + 0.0008 + PLAY), 0.05, radius)
        wheel(a, f"{name}_wheel", at, radius, wide, metal)
    back = -r - PLAY
    toe = body
    if a.happens(0.6):
        toe = a.hinge("toe_plate", LEFT, (0, back, 0.01), a.degrees(85, 90))
    else:
        body.add(box(about(half), (back - 0.004, 0.0), (0.0045, 0.06)), look=metal)
    toe.add(block(about(half - 0.01), span(back, -long), (0.004, 0.01), 0.02), look=metal)


def skateboard(a: Assembly) -> None:
    """Build a deck with kicked ends on two trucks of two wheels."""
    half, long, radius, wide = a.draws((0.09, 0.12), (0.32, 0.45), (0.024, 0.034), (0.028, 0.04))
    skin, metal = a.picks((OAK, BLACK, RED), (STEEL, WHITE))
    level = 2 * radius + a.draw(0.012, 0.03)
    body = a.body(skin)
    y = np.linspace(-long, long, 13)
    past = np.clip(np.abs(y) / long - 0.75, 0, 1)
    taper = half * np.sqrt(np.clip(1.0 - 14 * past**2, 0.05, 1.0))
    kick = level + a.draw(0.0, 0.06) * np.clip(np.abs(y) / long - 0.7, 0, 1) / 0.3
    edges = ((-1, 0.0), (1, 0.0), (1, 0.01), (-1, 0.01))
    body.add(loft(np.stack([np.stack([s * taper, y, kick + t], axis=1) for s, t in edges], axis=1)))
    reach = half - wide - 0.003
    truck = [(0.012, radius - 0.004), (0.03, level + 0.001)]
    for row, at in (("front", -0.62 * long), ("rear", 0.62 * long)):
        body.add(cylinder(X, (at, radius), 0.006, about(reach), 10), look=metal)
        body.add(lathe(truck, (0, at, 0), sides=4), look=metal)
        for name, side in SIDES:
            place = (side * (reach + wide / 2 + 0.0008 + PLAY), at, radius)
            wheel(a, f"{row}_{name}_wheel", place, radius, wide, metal, WHITE)
