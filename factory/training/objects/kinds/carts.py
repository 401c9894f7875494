"""Trolleys, and whatever else stands on wheels."""

from __future__ import annotations

import numpy as np

from ....mesh import Material
from ..kit.assembly import LEFT, RIGHT, Assembly
from ..kit.boards import corners
from ..kit.looks import BLACK, BLUE, GREEN, OAK, RED, STEEL, WHITE
from ..kit.shapes import (
    Form,
    Span,
    X,
    Z,
    about,
    between,
    block,
    box,
    cylinder,
    lathe,
    loft,
    pipe,
    span,
    stack,
    within,
)  # fmt: skip
from ..kit.wheels import PLAY, bracket, castor, tyre, wheel

SIDES = (("left", -1.0), ("right", 1.0))


def cart(a: Assembly) -> None:
    """A platform, shelves or a basket on four wheels: on fixed axles, on castors, or castors in front."""
    skin, metal = a.picks((STEEL, BLUE, RED, OAK, WHITE, GREEN), (STEEL, BLACK))
    half_x, half_y, radius, wide, rise = a.draws(
        (0.18, 0.32), (0.28, 0.5), (0.03, 0.075), (0.015, 0.035), (0.015, 0.04)
    )
    deck, body = 2 * radius + rise, a.body(skin)
    kind = a.pick(_platform, _shelves, _basket)
    kind(a, about(half_x), about(half_y), deck, metal)
    both = a.pick("castor", "axle")
    front, rear = ("castor", "axle") if a.happens(0.5) else (both, both)
    heading = a.draw(0.0, 2 * np.pi) if a.happens(0.3) else 0.0
    along, across = half_y - 1.1 * radius, half_x - 0.6 * radius - wide
    for row, style, y in (("front", front, -along), ("rear", rear, along)):
        for name, side in SIDES:
            x = side * across
            if style == "castor":
                castor(a, f"{row}_{name}", (x, y, deck), radius, wide, heading, metal)
                continue
            wheel(a, f"{row}_{name}_wheel", (x, y, radius), radius, wide, metal)
            body.add(*bracket(x, y, radius, wide, deck + 0.001), look=metal)


def _push_bar(a: Assembly, half: float, y: float, low: float, high: float) -> Form:
    """An inverted U at the back, to push at."""
    h, lean = half - 0.02, a.draw(0.0, 0.12)
    right = [(h, y, low), (h, y + 0.8 * lean, high - 0.06), (h - 0.05, y + lean, high)]
    left = [(-px, py, pz) for px, py, pz in right]
    return pipe([*left, *right[::-1]], a.draw(0.01, 0.016), up=(0.0, 1.0, 0.0))


def _platform(a: Assembly, x: Span, y: Span, deck: float, metal: Material) -> None:
    top = span(deck, a.draw(0.015, 0.04))
    a.root.add(block(x, y, top, a.draw(0.003, 0.06), 0.003))
    bar = _push_bar(a, x[1], y[1] - 0.03, top[1] - 0.005, deck + a.draw(0.7, 0.95))
    a.root.add(bar, look=metal)


def _shelves(a: Assembly, x: Span, y: Span, deck: float, metal: Material) -> None:
    rise, lip, body = a.draw(0.22, 0.34), a.draw(0.0, 0.05), a.root
    levels = [deck + i * rise for i in range(a.count(2, 4))]
    for level in levels:
        body.add(block(x, y, span(level, 0.012), 0.02))
        if lip > 0.02:
            _rim(a, x, y, (level + 0.011, level + lip), 0.003)
    poles, post = (deck + 0.002, levels[-1] + 0.012 + a.draw(0.0, 0.05)), a.draw(0.008, 0.014)
    body.add(*(cylinder(Z, at, post, poles, 12) for at in corners(x, y, 0.02)), look=metal)
    if a.happens(0.6):
        bar = _push_bar(a, x[1], y[1] - 0.03, levels[-1], levels[-1] + a.draw(0.1, 0.2))
        body.add(bar, look=metal)


def _rim(a: Assembly, x: Span, y: Span, z: Span, thick: float) -> None:
    """Four low walls on the edges of a board."""
    a.root.add(*(box(about(thick, end), y, z) for end in within(x, 0.001)))
    a.root.add(*(box(x, about(thick, end), within(z, 0.0002)) for end in y))


def _basket(a: Assembly, x: Span, y: Span, deck: float, metal: Material) -> None:
    """A cage of wires, or a tub, on a frame."""
    z, wire, body = (deck + a.draw(0.15, 0.4), deck + a.draw(0.55, 0.8)), about(0.002, 0.0), a.root
    body.add(block(x, y, span(deck, 0.015), 0.03), look=metal)
    posts = (cylinder(Z, at, 0.01, (deck + 0.014, z[1]), 10) for at in corners(x, y, 0.03))
    body.add(*posts, look=metal)
    if a.happens(0.4):
        _rim(a, x, y, z, 0.005)
        body.add(box(x, y, (z[0] + 0.0005, z[0] + 0.006)))
    else:
        forms = []
        for level, thick in zip(np.linspace(*z, 4), (1, 1, 1, 2), strict=True):
            ring = [
                (x[0], y[0], level),
                (x[1], y[0], level),
                (x[1], y[1], level),
                (x[0], y[1], level),
            ]
            forms.append(pipe(ring, 0.003 * thick, 6, looped=True))
        for v in between(x, 4):
            forms += [box(about(0.002, v), about(0.002, end), z) for end in y]
            forms.append(box(about(0.002, v), y, about(0.002, z[0])))
        forms += [box(about(0.002, end), about(0.002, v), z) for v in between(y, 5) for end in x]
        body.add(*forms, look=metal)
    bar = _push_bar(a, x[1], y[1] - 0.01, z[1] - 0.02, z[1] + a.draw(0.08, 0.2))
    body.add(bar, look=metal)


def wheelbarrow(a: Assembly) -> None:
    """A tray between two shafts, two legs behind, one wheel in front."""
    skin, metal = a.picks((GREEN, BLUE, RED, STEEL), (STEEL, BLACK))
    radius, wide, half, long = a.draws((0.15, 0.2), (0.06, 0.09), (0.2, 0.28), (0.65, 0.8))
    level, gap, body = 2 * radius + 0.03, wide / 2 + 0.004, a.body(skin)
    outline = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * (half, 0.55 * long)
    rows = ((0.55, 0.0), (1.0, 0.25), (0.985, 0.25), (0.54, 0.006))
    body.add(stack([(s * outline + (0.0, 0.5 * long), level + z) for s, z in rows]))
    for side in (-1.0, 1.0):
        shaft = [
            (side * gap, -0.2 * long, radius),
            (side * 0.45 * half, 0.2 * long, level - 0.012),
            (side * 0.6 * half, long, level - 0.01),
            (side * half, 1.7 * long, level + 0.12),
        ]
        leg = [
            (side * 0.62 * half, 0.95 * long, level - 0.015),
            (side * 0.72 * half, 0.85 * long, 0.0),
            (side * 0.72 * half, 0.7 * long, 0.004),
        ]
        body.add(pipe(shaft, 0.012, 8, up=(0, 0, 1)), pipe(leg, 0.011, 8, up=(1, 0, 0)), look=metal)
    at = (0.0, -0.2 * long, radius)
    part = a.spin("wheel", RIGHT, at, look=BLACK)
    outside, hub = tyre(at, 0.98 * radius, 2 * (gap - 0.012 - PLAY) - 0.003)
    part.add(outside)
    part.add(hub, look=metal)


def hand_truck(a: Assembly) -> None:
    """An upright frame on two wheels with a toe plate, fixed or folding."""
    skin, metal = a.picks((RED, BLUE, BLACK, STEEL), (STEEL, BLACK))
    half, high, radius, wide, r = a.draws(
        (0.18, 0.25), (1.0, 1.3), (0.08, 0.13), (0.03, 0.05), (0.012, 0.018)
    )
    right = [(half, 0.0, 0.05), (half, 0.0, high - 0.1), (half - 0.08, 0.0, high)]
    left = [(-x, y, z) for x, y, z in right]
    body, reach = a.body(skin), half + r + 0.002
    body.add(pipe([*left, *right[::-1]], r))
    rungs = np.linspace(0.12, high - 0.25, a.count(2, 4)).tolist()
    body.add(*(box(about(half), about(0.004), about(0.012, z)) for z in rungs))
    body.add(cylinder(X, (0.05, radius), 0.007, about(reach), 10), look=metal)
    for name, side in SIDES:
        body.add(box(about(0.004, side * half), (0.0, 0.055), about(0.01, radius)), look=metal)
        at = (side * (reach + wide / 2 + 0.0008 + PLAY), 0.05, radius)
        wheel(a, f"{name}_wheel", at, radius, wide, metal)
    back, long = -r - PLAY, a.draw(0.18, 0.28)
    toe = body
    if a.happens(0.6):
        toe = a.hinge("toe_plate", LEFT, (0, back, 0.01), a.degrees(85, 90))
    else:
        body.add(box(about(half), (back - 0.004, 0.0), (0.0045, 0.06)), look=metal)
    toe.add(block(about(half - 0.01), span(back, -long), (0.004, 0.01), 0.02), look=metal)


def skateboard(a: Assembly) -> None:
    """A deck with kicked ends on two trucks of two wheels."""
    skin, metal = a.picks((OAK, BLACK, RED), (STEEL, WHITE))
    half, long, radius, wide = a.draws((0.09, 0.12), (0.32, 0.45), (0.024, 0.034), (0.028, 0.04))
    level, y, body = 2 * radius + a.draw(0.012, 0.03), np.linspace(-long, long, 13), a.body(skin)
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


MAKERS = {
    "cart": cart,
    "wheelbarrow": wheelbarrow,
    "hand_truck": hand_truck,
    "skateboard": skateboard,
}
