"""Washing machines and dryers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..kit.assembly import BACK, FRONT, LEFT, Assembly, PartDraft, facing_front
from ..kit.boards import carcass, ring_of_boards, stand, tray
from ..kit.casework import swung
from ..kit.controls import button, knob
from ..kit.looks import BLACK, GLASS, RED, STEEL, WHITE
from ..kit.pulls import add_pull, any_pull
from ..kit.shapes import Form, box, cylinder, hoop, lathe, ribbon
from ..kit.spans import Flat, Span, Y, Z, about, between, ends, mid, size, span, upto, within
from ..kit.styles import any_metal


def front_loader(a: Assembly) -> None:
    """Build a round or square door before a drum; a soap drawer, knobs and buttons above it."""
    width, depth, height, strip = a.draws((0.45, 0.7), (0.4, 0.7), (0.7, 1.0), (0.1, 0.16))
    body = a.body(a.pick(WHITE, WHITE, STEEL, BLACK))
    x, y = upto(width, depth)
    z = span(a.pick(0.0, 0.015, 0.03), height)
    split = z[1] - strip
    radius = min(a.draw(0.26, 0.36) * width, 0.48 * (split - z[0] - 0.09))
    at = (width / 2, a.draw(z[0] + radius + 0.06, split - radius - 0.03))
    stand(a, "feet", x, y, z[0], BLACK)
    if a.happens(0.72):
        body.add(_holed(x, z, at, 0.9 * radius), *carcass(x, (0.02, depth), z, 0.012, 0.012))
        drum = a.hinge("drum", BACK, (at[0], 0.07, at[1]), 6.2) if a.happens(0.3) else body
        _drum(drum, at, 0.95 * radius, (0.07, depth - 0.05))
    else:
        body.add(box(x, y, z))
    _porthole(a, at, radius)
    _controls(a, x, (split, z[1]))


def _holed(x: Span, z: Span, at: Flat, radius: float) -> Form:
    """Return a plate at y = 0 with a round hole."""
    center = np.array(at)
    limits = np.array((x, z))
    corners = np.array([(u, v) for u in x for v in z]) - center
    turn = np.linspace(-np.pi, np.pi, 33)[:-1] + 0.05
    angle = np.sort(np.concatenate([np.arctan2(corners[:, 1], corners[:, 0]), turn]))
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    out = (np.where(way > 0, limits[:, 1], limits[:, 0]) - center) / way
    edge = center + out.min(axis=1)[:, None] * way
    return ribbon(center + radius * way, edge, (0.0, 0.02), Y, looped=True)


def _drum(drum: PartDraft, at: Flat, radius: float, y: Span) -> None:
    forms = [hoop(Y, at, (radius - 0.004, radius), y, 28)]
    forms.append(cylinder(Y, at, radius - 0.002, span(y[1], -0.004), 28))
    for angle in np.arange(3) * 2.0 * np.pi / 3.0:
        rib = (at[0] + 0.85 * radius * np.cos(angle), at[1] + 0.85 * radius * np.sin(angle))
        forms.append(cylinder(Y, rib, 0.08 * radius, within(y, 0.01), 8))
    drum.add(*forms, look=STEEL)


def _porthole(a: Assembly, at: Flat, radius: float) -> None:
    look = a.pick(WHITE, STEEL, BLACK)
    x, z = (about(radius, v) for v in at)
    side = a.weighted({"left": 0.7, "right": 0.3})
    y = span(-a.draw(0.0005, 0.003), -a.draw(0.02, 0.05))
    setback = a.pick(0.0, 0.5, 1.0) * size(y)
    # Behind its face the axis swings the hinge edge into the front beside it.
    upper = a.degrees(80, 90) if setback else a.degrees(85, 164)
    door = swung(a, "door", side, x, z, y[0] + setback, upper, look=look)
    if a.happens(0.75):
        rim = a.draw(0.7, 0.88) * radius
        bowl = [(0.55 * radius, y[0] + 0.3 * size(y)), (rim + 0.004, y[0] + 0.6 * size(y))]
        door.add(hoop(Y, at, (rim, radius), y, 32))
        door.add(lathe(bowl, (at[0], 0.0, at[1]), Y, 28), look=GLASS)
    else:
        door.add(box(x, y, z))
        door.add(cylinder(Y, at, 0.7 * radius, span(y[0], -0.002), 28), look=GLASS)
    pull = any_pull(a, any_metal(a), ("bar", "bow", "recess", "rail"))
    far = at[0] + (0.92 if side == "left" else -0.92) * radius
    add_pull(door, replace(pull, length=0.35 * radius), far, at[1], y[0], True, radius)


def _controls(a: Assembly, x: Span, z: Span) -> None:
    """Build a soap drawer at one end, a knob and buttons along the rest."""
    level = mid(z)
    place = facing_front(0.0)
    left = a.happens(0.8)
    if a.happens(0.7):
        front = ends(within(x, 0.02), 0.32 * size(x) - 0.02)[0 if left else 1]
        high = about(0.32 * size(z), level)
        drawer = a.slider("drawer", FRONT, (mid(front), 0.0, level), 0.2)
        drawer.add(box(front, (-0.018, -0.001), high), look=a.pick(WHITE, STEEL, BLACK))
        lip = span(high[1] - 0.012, 0.006)
        drawer.add(box(within(front, 0.02), (-0.026, -0.018), lip), look=BLACK)
    places = np.linspace(0.42, 0.92, a.count(3, 8))
    spots = (x[0] + (places if left else 1.0 - places) * size(x)).tolist()
    radius = min(0.3 * size(z), 0.035)
    knob(a, "knob", (spots[0], level), radius, any_metal(a), place, mark=RED)
    if a.happens(0.6):
        half = 0.15 * size(x) / len(spots)
        for i, at in enumerate(spots[2:]):
            button(a, f"button_{i}", about(half, at), about(half, level), WHITE, place)


def top_loader(a: Assembly) -> None:
    """Build a lid that lifts, before a console with knobs."""
    width, depth, height = a.draws((0.45, 0.72), (0.5, 0.7), (0.8, 1.0))
    console, tall = a.draws((0.1, 0.18), (0.08, 0.2))
    x, y = upto(width, depth)
    t = 0.02
    body = a.body(a.pick(WHITE, WHITE, STEEL))
    mouth = (within(x, 0.05), (0.05, depth - console - 0.06))
    body.add(*ring_of_boards((x, y), mouth, span(height, -t)), *tray(x, y, (0.0, height - t), t))
    body.add(box(x, span(depth, -console), span(height, tall)))
    center = (mid(mouth[0]), mid(mouth[1]))
    radius = 0.48 * min(size(mouth[0]), size(mouth[1]))
    deep = (0.3 * height, height - t - 0.01)
    drum = hoop(Z, center, (radius - 0.005, radius), deep, 28)
    body.add(drum, cylinder(Z, center, radius - 0.002, span(deep[0], -0.01), 28), look=STEEL)
    lid_y = within(mouth[1], -0.03, -0.01)
    z = span(height + 0.002, a.draw(0.012, 0.03))
    lid = a.hinge("lid", LEFT, (center[0], lid_y[1], z[1]), a.degrees(70, 88))
    lid.add(box(within(mouth[0], -0.03), lid_y, z), look=a.pick(body.look, GLASS))
    lid.add(box(about(0.06, center[0]), span(lid_y[0], -0.012), span(z[0], 0.01)))
    for i, at in enumerate(between((0.15 * width, 0.85 * width), a.count(1, 4))):
        spot = (at, height + 0.65 * tall)
        knob(a, f"knob_{i}", spot, 0.025, STEEL, facing_front(depth - console), mark=RED)
