"""Notebook computers and monitors; and what stands beside them: mice and printers."""

from __future__ import annotations

import numpy as np

from ....mesh import FloatArray, Material
from ..kit.assembly import FRONT, LEFT, RIGHT, Assembly, PartDraft, facing_front
from ..kit.boards import corners, tray
from ..kit.controls import button, cells
from ..kit.looks import BLACK, BLUE, GLASS, RED, STEEL, WHITE
from ..kit.shapes import (
    Form,
    Span,
    X,
    Y,
    about,
    block,
    box,
    cylinder,
    lathe,
    loft,
    pipe,
    prism,
    shares,
    size,
    span,
    within,
)  # fmt: skip

#: Between barrels that turn on one pin [m].
PLAY = 0.0008


def laptop(a: Assembly) -> None:
    """A notebook of the demo, closed, with gaps that leave no doubt what is its lid."""
    width, depth, thick = a.draws((0.3, 0.38), (0.21, 0.26), (0.013, 0.018))
    body, radius, top = a.body(a.pick(STEEL, BLACK, BLUE)), 0.005, 0.002 + thick
    x, y = about(width / 2), (-depth / 2, depth / 2 - 0.012)
    body.add(box(x, y, (0.002, top)))
    feet = corners(within(x, 0.03), within(y, 0.025))
    body.add(*(box(about(0.01, u), about(0.005, v), (0.0, 0.002)) for u, v in feet), look=BLACK)
    keys_y, columns = (y[1] - 0.114, y[1] - 0.034), int((width - 0.04) / 0.02)
    for _, key_x, key_y in cells(about(columns * 0.01), keys_y, 4, columns):
        body.add(box(key_x, key_y, span(top, 0.0008)), look=BLACK)
    body.add(box(about(0.05), (y[0] + 0.015, keys_y[0] - 0.016), span(top, 0.0004)), look=GLASS)
    # The barrel's axis lies behind the base, level with the gap between base and lid.
    pin, low = (y[1] + radius + 0.002, top + 0.0015), top + 0.004
    under = (y[1], pin[0]), (pin[1] - 0.9 * radius, pin[1] - 0.002)
    for at in (-0.35, 0.35):
        ear = about(0.07 * width, at * width)
        body.add(cylinder(X, pin, radius, ear), box(within(ear, 0.001), *under), look=BLACK)
    lid, knuckle = a.hinge("lid", LEFT, (0.0, *pin), a.degrees(110, 135)), about(0.25 * width)
    lid.add(box(x, y, span(low, 0.007)))
    lid.add(box(within(x, 0.012), within(y, 0.012, 0.02), span(low, -0.001)), look=GLASS)
    arm = box(within(knuckle, 0.001), under[0], (pin[1] + 0.001, low + 0.006))
    lid.add(cylinder(X, pin, radius, knuckle), arm, look=BLACK)


def notebook(a: Assembly) -> None:
    """A flat or wedge-shaped base, a lid on one or two barrels; about half stand open at rest."""
    half, deep, thick = a.draws((0.12, 0.2), (0.17, 0.27), (0.006, 0.028))
    lid_thick, radius, corner, frame = a.draws(
        (0.003, 0.009), (0.003, 0.006), (0.001, 0.02), (0.003, 0.018)
    )
    top, rubber, body = (
        max(thick, 2 * radius),
        0.0015 if a.happens(0.6) else 0.0,
        a.body(a.pick(STEEL, BLACK, BLUE, WHITE, RED)),
    )
    x, y, base = about(half), (-deep, 0.0), (rubber + top - thick, rubber + top)
    nose = a.draw(0.25, 1.0) * thick if a.happens(0.5) else thick
    if nose < thick - 0.002:
        wedge = [
            (y[0], base[1] - nose),
            (0.6 * y[0], base[0]),
            (0.0, base[0]),
            (0.0, base[1]),
            (y[0], base[1]),
        ]
        body.add(prism(wedge, x, X))
    else:
        body.add(block(x, y, base, corner, min(0.001, 0.2 * thick)))
    if rubber:
        pads = corners(about(0.8 * half), (0.5 * y[0], -0.03))
        feet = (box(about(0.012, px), about(0.004, py), (0.0, base[0] + 0.0005)) for px, py in pads)
        body.add(*feet, look=BLACK)
    _deck(a, half, deep, base[1])
    pin, low, rest = (
        (0.0, radius + PLAY, base[1] + PLAY / 2),
        base[1] + 0.002,
        np.radians(a.draw(85, 115)),
    )
    lid = a.hinge("lid", LEFT, pin, a.degrees(115, 175), rest=rest if a.happens(0.5) else 0.0)
    lid.add(block(x, y, span(low, lid_thick), corner, min(0.001, 0.2 * lid_thick)))
    lid.add(
        box(within(x, frame), within(y, frame, 1.5 * frame + 0.004), span(low, -0.0006)), look=GLASS
    )
    _barrels(a, lid, half, radius, pin, low + 0.6 * lid_thick)


def _barrels(
    a: Assembly,
    lid: PartDraft,
    half: float,
    radius: float,
    pin: tuple[float, float, float],
    lid_z: float,
) -> None:
    """Knuckles that turn with the lid and knuckles that stay."""
    look, (_, y, z) = a.pick(lid.look, BLACK), pin
    spans = [about(0.7 * half)]
    if a.happens(0.6):
        at, long = a.draw(0.45, 0.75) * half, a.draw(0.1, 0.2) * half
        spans = [about(long, -at), about(long, at)]
    stub = min(0.02, 0.2 * half)
    for knuckle in spans:
        tab = box(within(knuckle, 0.001), (-0.004, y), (z + 0.0012 + PLAY, lid_z))
        lid.add(cylinder(X, (y, z), radius, knuckle, 14), tab, look=look)
        for end, way in zip(within(knuckle, -PLAY), (-stub, stub), strict=True):
            ear = within(span(end, way), 0.0005), (-0.003, y), (z - 0.9 * radius, z - 0.0015)
            a.root.add(cylinder(X, (y, z), 0.9 * radius, span(end, way), 12), box(*ear), look=look)


def _deck(a: Assembly, half: float, deep: float, top: float) -> None:
    """Keys one by one, in rows, as one plate, or none; often a touch pad."""
    style, body, x = a.pick("keys", "rows", "plate", "none"), a.root, about(0.88 * half)
    y, z = (-a.draw(0.5, 0.62) * deep, -a.draw(0.02, 0.04)), span(top, a.draw(0.0003, 0.001))
    if style == "plate":
        body.add(block(x, y, z, 0.004), look=BLACK)
    elif style != "none":
        columns = a.count(8, 14) if style == "keys" else 1
        for i, row in enumerate(shares(y, a.count(4, 6))):
            parts = [3, 1, 1, 5, 1, 2] if i == 0 and columns > 10 else [1] * columns
            ends = x[0] + size(x) * np.cumsum([0, *parts]) / sum(parts)
            keys = zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)
            body.add(
                *(box(within(key, 0.0, 0.002), within(row, 0.0, 0.002), z) for key in keys),
                look=BLACK,
            )
    if a.happens(0.8):
        pad, edge = about(a.draw(0.2, 0.45) * half), a.draw(0.006, 0.02)
        body.add(box(pad, (edge - deep, y[0] - edge), span(top, 0.0003)), look=GLASS)


def monitor(a: Assembly) -> None:
    """A screen that tilts at the top of a stem on a foot."""
    half, high, thick, rise = a.draws((0.1, 0.32), (0.08, 0.19), (0.007, 0.03), (0.06, 0.2))
    body, top, frame = (
        a.body(a.pick(BLACK, STEEL, WHITE)),
        0.012 + rise + high,
        a.draw(0.003, 0.015),
    )
    foot = about(a.draw(0.4, 0.7) * half), about(a.draw(0.06, 0.11)), (0.0, 0.012)
    body.add(block(*foot, a.draw(0.005, 0.05), 0.002))
    body.add(box(about(a.draw(0.012, 0.03)), (0.02, 0.035), (0.0115, top - 0.013)))
    ears = (0.02, 0.034), (top - 0.0135, top + 0.008)
    body.add(*(box(about(0.003, x), *ears) for x in (-0.016, 0.016)))
    screen = a.hinge("screen", LEFT, (0, 0.027, top), a.degrees(10, 25), -a.degrees(3, 10))
    x, y, z = about(half), span(-0.012, -thick), about(high, top)
    screen.add(block(x, y, z, a.draw(0.002, 0.02), 0.002, Y))
    screen.add(box(within(x, frame), span(y[0], -0.0005), within(z, frame)), look=GLASS)
    screen.add(box(about(0.03), (-0.0121, 0.002), about(0.03, top)))
    screen.add(cylinder(X, (0.027, top), 0.01, about(0.012), 14))
    screen.add(box(about(0.008), (0.0, 0.027), about(0.006, top)))


def mouse(a: Assembly) -> None:
    """A computer mouse: a wheel that turns without end, two buttons that tip, at times a wire."""
    half, long, high = a.draws((0.024, 0.034), (0.045, 0.062), (0.024, 0.04))
    skin, other = a.picks((BLACK, WHITE, STEEL, RED), (BLACK, STEEL))
    y, body = np.linspace(-long, long, 9), a.body(skin)
    wide = half * (1.0 - a.draw(0.1, 0.35) * np.abs(y / long) ** 3)
    crown = high * np.cos(0.9 * (y / long - a.draw(0.0, 0.3))) ** 0.8
    rear = y > -0.25 * long
    body.add(_hump(y[rear], wide[rear], crown[rear]))
    seam = float(y[rear][0]) - 0.0005
    front = np.linspace(-long, seam, 5)
    edge, roof = np.interp(front, y, wide), np.interp(front, y, crown)
    low, slot = 0.45 * roof, a.draw(0.0035, 0.006)
    body.add(_bar(front, ((-edge, 0 * low), (edge, 0 * low), (edge, low), (-edge, low))))
    lift = low + 0.002
    top = np.maximum(roof, lift + 0.002)
    for name, side in (("left", -1.0), ("right", 1.0)):
        section = (
            (0.0, lift),
            (1.0, lift),
            (0.95, 0.6 * top + 0.4 * lift),
            (0.55, top),
            (0.0, top),
        )
        pivot, tip = (0.0, seam, float(top[-1])), 0.6 * 0.002 / (2 * long)
        key = a.hinge(f"{name}_button", RIGHT, pivot, tip)
        key.add(_bar(front, tuple((side * (slot + f * (edge - slot)), z) for f, z in section)))
    at = -0.55 * long
    floor = float(np.interp(at, front, low))
    radius = (float(np.interp(at, front, top)) - floor) / 2 + 0.001
    center = (0.0, at, floor + radius + 0.0015)
    spinning = a.spin("wheel", RIGHT, center, look=other)
    rim = ((0.8, 0.001 - slot), (1.0, -0.3 * slot), (1.0, 0.3 * slot), (0.8, slot - 0.001))
    spinning.add(lathe([(r * radius, x) for r, x in rim], center, X, 20))
    if a.happens(0.5):
        wire = [
            (0, 0.002 - long, 0.3 * low[0]),
            (0, -long - 0.01, 0.004),
            (0.01, -long - 0.05, 0.002),
        ]
        body.add(pipe(wire, 0.0016, 8, up=(0, 0, 1)), look=other)


def _hump(y: FloatArray, wide: FloatArray, crown: FloatArray) -> Form:
    """Arches one behind the other."""
    angle = np.linspace(0.0, np.pi, 9)
    across = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** 0.6
    rings = np.empty((len(y), 9, 3))
    rings[..., 0], rings[..., 1] = wide[:, None] * across, y[:, None]
    rings[..., 2] = crown[:, None] * np.sin(angle) ** 0.7
    return loft(rings)


def _bar(y: FloatArray, section: tuple[tuple[FloatArray, FloatArray], ...]) -> Form:
    """A bar along y whose corners, each an x and a z per place, change along it."""
    return loft(np.stack([np.stack([x, y, z], axis=1) for x, z in section], axis=1))


def printer(a: Assembly) -> None:
    """A box with a scanner lid, a paper drawer, an output flap in front, a feed flap behind, and buttons."""
    skin, dark = a.picks((WHITE, BLACK, STEEL), (BLACK, STEEL))
    half, deep, high, r = a.draws((0.19, 0.26), (0.15, 0.22), (0.13, 0.3), (0.004, 0.03))
    x, y, body, shelf, wall = about(half), about(deep), a.body(skin), a.draw(0.3, 0.5) * high, 0.006
    body.add(block(x, y, (shelf, high), r))
    front, place = y[0] - 0.001, facing_front(-deep)
    if a.happens(0.8):
        _paper_drawer(a, x, y, shelf, r, a.pick(skin, dark), dark)
    else:
        body.add(block(x, y, (0.0, shelf), r))
    if a.happens(0.8):
        low = high + 0.001
        lid = a.hinge(
            "lid", LEFT, (0, y[1] - 0.003, low), a.degrees(60, 90), look=a.pick(skin, dark)
        )
        lid.add(
            block(x, within(y, a.draw(0.0, 0.04), 0.004), span(low, a.draw(0.012, 0.04)), r, 0.003)
        )
        body.add(box(about(0.8 * half), about(0.7 * deep), span(high, 0.0006)), look=GLASS)
    if a.happens(0.7):
        z = (shelf + 0.005, shelf + a.draw(0.5, 0.7) * (high - shelf))
        at = (0.0, front - 0.006, z[0])
        flap = a.hinge("front_flap", RIGHT, at, a.degrees(70, 100), look=a.pick(skin, dark))
        flap.add(block(about(0.7 * half), span(front, -0.006), z, 0.004, axis=Y))
    each = a.draw(0.005, 0.009)
    level = about(each, high - 0.012 - each / 2)
    for i in range(a.count(0, 4)):
        key = about(each, -0.75 * half + i * 3 * each)
        button(a, f"button_{i}", key, level, dark, place, style=a.draw(0.2, 0.95))
    if a.happens(0.4) or not a.parts:
        behind = span(y[1] + 0.001, 0.005)
        feed = a.hinge("rear_feed", LEFT, (0, behind[1], 0.5 * high), a.degrees(20, 60), look=dark)
        feed.add(box(about(0.6 * half), behind, (0.5 * high, high - 0.002)))


def _paper_drawer(
    a: Assembly, x: Span, y: Span, shelf: float, r: float, look: Material, dark: Material
) -> None:
    wall, deep = 0.006, within(y, r)
    sides = (
        box(span(end, way), deep, (0.0, shelf)) for end, way in zip(x, (wall, -wall), strict=True)
    )
    a.root.add(*sides, box(within(x, wall), deep, (0.0, wall)))
    inner, low = within(x, wall + 0.001), wall + 0.001
    drawer = a.slider("drawer", FRONT, (0, y[0], wall), a.draw(0.8, 1.3) * y[1], look=dark)
    drawer.add(*tray(inner, (y[0] + 0.008, 0.7 * y[1]), (low, 0.6 * shelf), 0.003, False))
    drawer.add(block(inner, span(y[0], 0.008), (low, shelf - 0.002), 0.003, axis=Y), look=look)


MAKERS = {
    "laptop": laptop,
    "notebook": notebook,
    "monitor": monitor,
    "mouse": mouse,
    "printer": printer,
}
