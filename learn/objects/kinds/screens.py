"""Notebook computers and monitors; and their company: mice and printers."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from asset_factory.factory.mesh import FloatArray, Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import FRONT, LEFT, RIGHT, UP, Point, X, Y, facing_front
from ..kit.boards import corners, tray
from ..kit.controls import ControlPanel, cells
from ..kit.looks import BLACK, BLUE, GLASS, RED, STEEL, WHITE
from ..kit.shapes import Form, block, both, box, cylinder, lathe, loft, pipe, prism
from ..kit.spans import PLAY, Span, about, centred, ends, shares, size, span, within


def laptop(a: Assembly) -> None:
    """Build a notebook of the demo, closed, with gaps that leave no doubt about its lid."""
    width, depth, thick = a.draws((0.3, 0.38), (0.21, 0.26), (0.013, 0.018))
    body = a.body(a.pick(STEEL, BLACK, BLUE))
    radius = 0.005
    top = 0.002 + thick
    x = about(width / 2)
    y = (-depth / 2, depth / 2 - 0.012)
    body.add(box(x, y, (0.002, top)))
    feet = corners(within(x, 0.03), within(y, 0.025))
    body.add(*(box(about(0.01, u), about(0.005, v), (0.0, 0.002)) for u, v in feet), look=BLACK)
    rows = (y[1] - 0.114, y[1] - 0.034)
    columns = int((width - 0.04) / 0.02)
    for _, key_x, key_y in cells(about(columns * 0.01), rows, 4, columns):
        body.add(box(key_x, key_y, span(top, 0.0008)), look=BLACK)
    body.add(box(about(0.05), (y[0] + 0.015, rows[0] - 0.016), span(top, 0.0004)), look=GLASS)
    # The barrel's axis lies behind the base, level with the gap between base and lid.
    pin = (y[1] + radius + 0.002, top + 0.0015)
    arm = (y[1], pin[0])
    ear = about(0.07 * width, 0.35 * width)
    under = box(within(ear, 0.001), arm, (pin[1] - 0.9 * radius, pin[1] - 0.002))
    body.add(*both(cylinder(X, pin, radius, ear), under), look=BLACK)
    low = top + 0.004
    lid = a.hinge("lid", LEFT, (0.0, *pin), a.degrees(110, 135))
    lid.add(box(x, y, span(low, 0.007)))
    lid.add(box(within(x, 0.012), within(y, 0.012, 0.02), span(low, -0.001)), look=GLASS)
    knuckle = about(0.25 * width)
    over = box(within(knuckle, 0.001), arm, (pin[1] + 0.001, low + 0.006))
    lid.add(cylinder(X, pin, radius, knuckle), over, look=BLACK)


def notebook(a: Assembly) -> None:
    """Build a flat or wedge-shaped base, a lid on barrels; about half stand open at rest."""
    half, deep, thick, nose = a.draws((0.12, 0.2), (0.17, 0.27), (0.006, 0.028), (0.25, 1.0))
    lid_thick, radius = a.draws((0.003, 0.009), (0.003, 0.006))
    corner, rim = a.draws((0.001, 0.02), (0.003, 0.018))
    rubber = a.pick(0.0, 0.0015)
    body = a.body(a.pick(STEEL, BLACK, BLUE, WHITE, RED))
    x = about(half)
    y = (-deep, 0.0)
    top = rubber + max(thick, 2 * radius)
    low = top - thick
    nose = nose * thick if a.happens(0.5) else thick
    if nose < thick - 0.002:
        wedge = [(y[0], top - nose), (0.6 * y[0], low), (0.0, low), (0.0, top), (y[0], top)]
        body.add(prism(wedge, x, X))
    else:
        body.add(block(x, y, (low, top), corner, min(0.001, 0.2 * thick)))
    if rubber:
        pads = corners(about(0.8 * half), (0.5 * y[0], -0.03))
        feet = (box(about(0.012, u), about(0.004, v), (0.0, low + 0.0005)) for u, v in pads)
        body.add(*feet, look=BLACK)
    _deck(a, half, deep, top)
    pin = (0.0, radius + PLAY, top + PLAY / 2)
    rest = np.radians(a.draw(85, 115)) if a.happens(0.5) else 0.0
    lid = a.hinge("lid", LEFT, pin, a.degrees(115, 175), rest=rest)
    z = span(top + 0.002, lid_thick)
    lid.add(block(x, y, z, corner, min(0.001, 0.2 * lid_thick)))
    glass = box(within(x, rim), within(y, rim, 1.5 * rim + 0.004), span(z[0], -0.0006))
    lid.add(glass, look=GLASS)
    _barrels(a, lid, half, radius, pin, z[0] + 0.6 * lid_thick)


def _barrels(
    a: Assembly, lid: PartDraft, half: float, radius: float, pin: Point, lid_z: float
) -> None:
    """Build knuckles that turn with the lid and knuckles that stay."""
    look = a.pick(lid.look, BLACK)
    _, y, z = pin
    knuckles = [about(0.7 * half)]
    if a.happens(0.6):
        at, long = a.draws((0.45 * half, 0.75 * half), (0.1 * half, 0.2 * half))
        knuckles = [about(long, -at), about(long, at)]
    stub = min(0.02, 0.2 * half)
    for knuckle in knuckles:
        tab = box(within(knuckle, 0.001), (-0.004, y), (z + 0.0012 + PLAY, lid_z))
        lid.add(cylinder(X, (y, z), radius, knuckle, 14), tab, look=look)
        for ear in ends(within(knuckle, -PLAY - stub), stub):
            foot = box(within(ear, 0.0005), (-0.003, y), (z - 0.9 * radius, z - 0.0015))
            a.root.add(cylinder(X, (y, z), 0.9 * radius, ear, 12), foot, look=look)


def _deck(a: Assembly, half: float, deep: float, top: float) -> None:
    """Build keys one by one, in rows, as one plate, or none; often a touch pad."""
    style = a.pick("keys", "rows", "plate", "none")
    x = about(0.88 * half)
    y = (-a.draw(0.5, 0.62) * deep, -a.draw(0.02, 0.04))
    z = span(top, a.draw(0.0003, 0.001))
    forms = [block(x, y, z, 0.004)] if style == "plate" else []
    columns = a.count(8, 14) if style == "keys" else 1
    for i, line in enumerate(shares(y, a.count(4, 6)) if style in ("keys", "rows") else ()):
        parts = [3, 1, 1, 5, 1, 2] if i == 0 and columns > 10 else [1] * columns
        edges = (x[0] + size(x) * np.cumsum([0, *parts]) / sum(parts)).tolist()
        forms += [box((u, v - 0.002), within(line, 0.0, 0.002), z) for u, v in pairwise(edges)]
    a.root.add(*forms, look=BLACK)
    if a.happens(0.8):
        pad = about(a.draw(0.2, 0.45) * half)
        edge = a.draw(0.006, 0.02)
        a.root.add(box(pad, (edge - deep, y[0] - edge), span(top, 0.0003)), look=GLASS)


def monitor(a: Assembly) -> None:
    """Build a screen that tilts at the top of a stem on a foot."""
    half, high, thick, rise = a.draws((0.1, 0.32), (0.08, 0.19), (0.007, 0.03), (0.06, 0.2))
    wide, deep, corner, rim = a.draws((0.4, 0.7), (0.06, 0.11), (0.005, 0.05), (0.003, 0.015))
    body = a.body(a.pick(BLACK, STEEL, WHITE))
    top = 0.012 + rise + high
    body.add(block(about(wide * half), about(deep), (0.0, 0.012), corner, 0.002))
    body.add(box(about(a.draw(0.012, 0.03)), (0.02, 0.035), (0.0115, top - 0.013)))
    body.add(*both(box(about(0.003, 0.016), (0.02, 0.034), (top - 0.0135, top + 0.008))))
    screen = a.hinge("screen", LEFT, (0, 0.027, top), a.degrees(10, 25), -a.degrees(3, 10))
    x = about(half)
    y = span(-0.012, -thick)
    z = about(high, top)
    screen.add(block(x, y, z, a.draw(0.002, 0.02), 0.002, Y))
    screen.add(box(within(x, rim), span(y[0], -0.0005), within(z, rim)), look=GLASS)
    screen.add(box(about(0.03), (-0.0121, 0.002), about(0.03, top)))
    knuckle = cylinder(X, (0.027, top), 0.01, about(0.012), 14)
    screen.add(knuckle, box(about(0.008), (0.0, 0.027), about(0.006, top)))


def mouse(a: Assembly) -> None:
    """Build a computer mouse: an endless wheel, two buttons that tip, at times a wire."""
    half, long, high = a.draws((0.024, 0.034), (0.045, 0.062), (0.024, 0.04))
    taper, lean, slot = a.draws((0.1, 0.35), (0.0, 0.3), (0.0035, 0.006))
    skin, other = a.picks((BLACK, WHITE, STEEL, RED), (BLACK, STEEL))
    body = a.body(skin)
    y = np.linspace(-long, long, 9)
    wide = half * (1.0 - taper * np.abs(y / long) ** 3)
    crown = high * np.cos(0.9 * (y / long - lean)) ** 0.8
    rear = y > -0.25 * long
    angle = np.linspace(0.0, np.pi, 9)
    across = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** 0.6
    arches = np.empty((int(rear.sum()), 9, 3))
    arches[..., 0] = wide[rear, None] * across
    arches[..., 1] = y[rear, None]
    arches[..., 2] = crown[rear, None] * np.sin(angle) ** 0.7
    body.add(loft(arches))
    seam = float(y[rear][0]) - 0.0005
    front = np.linspace(-long, seam, 5)
    edge = np.interp(front, y, wide)
    roof = np.interp(front, y, crown)
    low = 0.45 * roof
    body.add(_bar(front, (-edge, 0 * low), (edge, 0 * low), (edge, low), (-edge, low)))
    lift = low + 0.002
    top = np.maximum(roof, lift + 0.002)
    section = ((0.0, lift), (1.0, lift), (0.95, 0.6 * top + 0.4 * lift), (0.55, top), (0.0, top))
    for name, side in (("left", -1.0), ("right", 1.0)):
        pivot = (0.0, seam, float(top[-1]))
        key = a.hinge(f"{name}_button", RIGHT, pivot, 0.6 * 0.002 / (2 * long))
        key.add(_bar(front, *((side * (slot + f * (edge - slot)), z) for f, z in section)))
    at = -0.55 * long
    floor = float(np.interp(at, front, low))
    radius = (float(np.interp(at, front, top)) - floor) / 2 + 0.001
    center = (0.0, at, floor + radius + 0.0015)
    spinning = a.spin("wheel", RIGHT, center, look=other)
    rim = ((0.8, 0.001 - slot), (1.0, -0.3 * slot), (1.0, 0.3 * slot), (0.8, slot - 0.001))
    spinning.add(lathe([(r * radius, x) for r, x in rim], center, X, 20))
    if a.happens(0.5):
        wire = [(0, 0.002, 0.3 * low[0]), (0, -0.01, 0.004), (0.01, -0.05, 0.002)]
        body.add(pipe([(x, out - long, z) for x, out, z in wire], 0.0016, 8, up=UP), look=other)


def _bar(y: FloatArray, *section: tuple[FloatArray, FloatArray]) -> Form:
    """Return a bar along y whose corners, each an x and a z per place, change along it."""
    return loft(np.stack([np.stack([x, y, z], axis=1) for x, z in section], axis=1))


def printer(a: Assembly) -> None:
    """Build a box with a scanner lid, a paper drawer, flaps in front and behind, and buttons."""
    half, deep, high, r = a.draws((0.19, 0.26), (0.15, 0.22), (0.13, 0.3), (0.004, 0.03))
    skin, dark = a.picks((WHITE, BLACK, STEEL), (BLACK, STEEL))
    body = a.body(skin)
    x, y = centred(half, deep)
    z = (a.draw(0.3, 0.5) * high, high)
    body.add(block(x, y, z, r))
    front = y[0] - 0.001
    if a.happens(0.8):
        _paper_drawer(a, x, y, z[0], r, dark)
    else:
        body.add(block(x, y, (0.0, z[0]), r))
    if a.happens(0.8):
        low = high + 0.001
        look = a.pick(skin, dark)
        lid = a.hinge("lid", LEFT, (0, y[1] - 0.003, low), a.degrees(60, 90), look=look)
        start, thick = a.draws((0.0, 0.04), (0.012, 0.04))
        lid.add(block(x, within(y, start, 0.004), span(low, thick), r, 0.003))
        body.add(box(about(0.8 * half), about(0.7 * deep), span(high, 0.0006)), look=GLASS)
    each = a.draw(0.005, 0.009)
    level = about(each, high - 0.012 - each / 2)
    if a.happens(0.7):
        top = min(z[0] + a.draw(0.5, 0.7) * size(z), level[0] - 0.002)
        flap_z = (z[0] + 0.005, top)
        at = (0.0, front - 0.006, flap_z[0])
        look = a.pick(skin, dark)
        flap = a.hinge("front_flap", RIGHT, at, a.degrees(70, 100), look=look)
        flap.add(block(about(0.7 * half), span(front, -0.006), flap_z, 0.004, axis=Y))
    panel = ControlPanel(a, facing_front(y[0]), dark)
    for i in range(a.count(0, 4)):
        key = about(each, -0.75 * half + i * 3 * each)
        panel.button(f"button_{i}", key, level, style=a.draw(0.2, 0.95))
    if a.happens(0.4) or not a.parts:
        behind = span(y[1] + 0.001, 0.005)
        pin = (0, behind[1], 0.5 * high)
        feed = a.hinge("rear_feed", LEFT, pin, a.degrees(20, 60), look=dark)
        feed.add(box(about(0.6 * half), behind, (0.5 * high, high - 0.002)))


def _paper_drawer(a: Assembly, x: Span, y: Span, shelf: float, r: float, dark: Material) -> None:
    deep = within(y, r)
    a.root.add(*(box(end, deep, (0.0, shelf)) for end in ends(x, 0.006)))
    a.root.add(box(within(x, 0.006), deep, (0.0, 0.006)))
    inner = within(x, 0.007)
    drawer = a.slider("drawer", FRONT, (0, y[0], 0.006), a.draw(0.8, 1.3) * y[1], look=dark)
    drawer.add(*tray(inner, (y[0] + 0.008, 0.7 * y[1]), (0.007, 0.6 * shelf), 0.003, False))
    face = block(inner, span(y[0], 0.008), (0.007, shelf - 0.002), 0.003, axis=Y)
    drawer.add(face, look=a.pick(a.root.look, dark))
