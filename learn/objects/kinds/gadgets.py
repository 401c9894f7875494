"""Things for the hand, the nose and the wall: USB sticks, phones, cameras, clocks, eyeglasses."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly
from ..kit.axes import BACK, FRONT, LEFT, RIGHT, UP, X, Y, Z, facing_up
from ..kit.controls import ControlPanel, cells, key
from ..kit.looks import BLACK, BLUE, BRASS, GLASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.outlines import oval, raised, rounded
from ..kit.shapes import ball, block, both, box, cylinder, lathe, loft, pipe, prism, ribbon
from ..kit.spans import PLAY, Span, about, centred, span, within


def usb_stick(a: Assembly) -> None:
    """Build a stick with a cap, a bracket that swings round, or a plug that slides out."""
    half, long, thick = a.draws((0.006, 0.011), (0.025, 0.045), (0.005, 0.011))
    skin, other = a.picks((BLACK, BLUE, RED, WHITE), (STEEL, BLACK, GREEN))
    x = about(half)
    z = (0.0, thick)
    middle = thick / 2
    body = a.body(skin)
    style = a.pick("cap", "bracket", "slide")
    if style == "slide":
        _sliding_plug(a, x, z, long, other)
        return
    tip = about(min(half - 0.001, 0.006))
    tongue = about(0.0022, middle)
    end = -0.013
    body.add(block(x, (0.0, long), z, a.draw(0.0005, 0.003), 0.0005, Y))
    body.add(box(tip, (end + 0.001, 0.0), tongue), look=STEEL)
    if style == "cap":
        cap = a.slider("cap", FRONT, (0, 0, middle), a.draw(0.012, 0.03), look=other)
        hole = rounded(within(tip, -PLAY), within(tongue, -PLAY), 0.0004, 2)
        cap.add(ribbon(rounded(x, z, 0.001, 2), hole, (end, -PLAY), Y, looped=True))
        cap.add(block(x, span(end, -0.002), z, 0.001, axis=Y))
        return
    pivot = 0.75 * long
    # The closed end comes round behind the body.
    clears = float(np.hypot(half, long - pivot)) < pivot + 0.012
    upper = np.pi if clears else a.degrees(90, 120)
    bracket = a.hinge("bracket", UP, (0, pivot, middle), upper, -upper, look=other)
    outer = within(z, -PLAY)
    for face, cover in ((outer[0], -0.0008), (outer[1], 0.0008)):
        bracket.add(box(x, (end, pivot + 0.8 * half), span(face, cover)))
    bracket.add(box(x, span(end, -0.0008), within(outer, -0.0008)))
    rivet = cylinder(Z, (0.0, pivot), 0.4 * half, span(outer[1] + 0.0008, 0.0005), 14)
    bracket.add(rivet, look=STEEL)


def _sliding_plug(a: Assembly, x: Span, z: Span, long: float, look: Material) -> None:
    wall = 0.001
    inner_x = within(x, wall)
    inner_z = within(z, wall)
    tube = rounded(x, z, 0.002), rounded(inner_x, inner_z, 0.001)
    a.root.add(ribbon(*tube, (0.0, long), Y, looped=True))
    a.root.add(block(inner_x, span(long, -0.001), inner_z, 0.001, axis=Y))
    plug = a.slider("plug", FRONT, (0, 0, z[1] / 2), 0.0115, look=look)
    free = within(inner_z, PLAY)
    plug.add(box(within(inner_x, PLAY), (0.012, 0.7 * long), free))
    lip = about(min(inner_x[1] - PLAY, 0.006))
    plug.add(box(lip, (0.0005, 0.012), within(free, 0.0002)), look=STEEL)


def phone(a: Assembly) -> None:
    """Build a phone that flips, or whose screen slides up or sideways over its keys."""
    half, long, thick, r = a.draws((0.022, 0.03), (0.08, 0.12), (0.006, 0.011), (0.002, 0.012))
    skin, other = a.picks((BLACK, STEEL, BLUE, RED), (BLACK, STEEL, WHITE))
    x, y = centred(half, long / 2)
    body = a.body(skin, block(x, y, (0.0, thick), r, 0.001))
    for _, key_x, key_y in cells(about(0.85 * half), (y[0] + 0.006, 0.0), 4, 3):
        body.add(key(key_x, key_y, (0.0, 0.0006), 0.6).moved(facing_up(thick)), look=other)
    low = thick + 0.0006 + PLAY
    z = span(low, a.draw(0.004, 0.008))
    cover = block(x, y, z, r, 0.0008)
    if a.happens(0.5):
        sideways = a.happens(0.3)
        reach = a.draw(0.4, 0.6) * (2 * half if sideways else long)
        screen = a.slider("screen", RIGHT if sideways else BACK, (0, 0, low), reach, look=other)
        lens = cylinder(Z, (0.0, y[0] + 0.006), 0.003, span(z[1], 0.0005), 12)
        glass = box(within(x, 0.004), within(y, 0.012, 0.008), span(z[1], 0.0004))
        screen.add(cover)
        screen.add(glass, lens, look=GLASS)
        return
    pin = (y[1] + 0.004, low - PLAY / 2)
    lid = a.hinge("lid", LEFT, (0.0, *pin), a.degrees(130, 165), look=other)
    lid.add(cover, cylinder(X, pin, 0.0035, about(0.5 * half), 14))
    lid.add(box(within(x, 0.004), within(y, 0.01), span(low, -0.0004)), look=GLASS)
    tab = (y[1] - 0.002, pin[0])
    lid.add(box(about(0.48 * half), tab, span(low + 0.001, 0.002)))
    barrel = (0.5 * half + PLAY, 0.9 * half)
    ear = box(within(barrel, 0.0003), tab, (thick - 0.003, thick - 0.0008))
    body.add(*both(cylinder(X, pin, 0.0035, barrel, 14), ear))


def remote(a: Assembly) -> None:
    """Build a remote control or a keypad: rows of buttons that go down."""
    half, long, thick, stroke = a.draws((0.018, 0.05), (0.05, 0.1), (0.01, 0.02), (0.001, 0.002))
    skin, other = a.picks((BLACK, WHITE, STEEL), (WHITE, RED, BLUE, STEEL))
    a.body(skin, block(about(half), about(long), (0.0, thick), a.draw(0.002, 0.8 * half), 0.002))
    y = (0.01 - long, a.draw(0.2, 0.7) * long)
    top = ControlPanel(a, facing_up(thick), other)
    for name, key_x, key_y in cells(about(0.68 * half), y, a.count(2, 4), a.count(1, 3)):
        top.button(f"key_{name}", key_x, key_y, stroke, 0.002, 0.6)


def calculator(a: Assembly) -> None:
    """Build a wedge with a display and rows of keys that go down."""
    half, long, thick, stroke = a.draws((0.03, 0.08), (0.05, 0.09), (0.006, 0.014), (0.0012, 0.003))
    tall, style, margin = a.draws((0.0015, 0.005), (0.2, 0.9), (0.06, 0.18))
    skin, other = a.picks((BLACK, WHITE, STEEL, BLUE), (WHITE, BLACK, RED, STEEL))
    body = a.body(skin, block(about(half), about(long), (0.0, thick), a.draw(0.002, 0.012), 0.001))
    display = (0.45 * long, 0.85 * long)
    body.add(box(about(0.85 * half), display, span(thick, 0.0006)), look=GLASS)
    pad = (about(0.875 * half), (-0.9 * long, 0.35 * long))
    top = ControlPanel(a, facing_up(thick), other)
    for name, key_x, key_y in cells(*pad, a.count(2, 3), a.count(3, 4), margin):
        top.button(f"key_{name}", key_x, key_y, stroke, tall, style)


def lighter(a: Assembly) -> None:
    """Build a flip lighter: a lid, and under it a wheel."""
    half, deep, high, rise = a.draws((0.016, 0.021), (0.005, 0.007), (0.03, 0.04), (0.016, 0.02))
    x, y = centred(half, deep)
    body = a.body(a.pick(STEEL, BRASS, BLACK), block(x, y, (0.0, high), 0.002))
    works = block(within(x, 0.003, 0.006), within(y, 0.002), span(high + 0.0002, 0.0068), 0.001)
    body.add(works, look=STEEL)
    z = (high + PLAY, high + rise)
    lid = a.hinge("lid", BACK, (half + 0.001, 0.0, z[0]), a.degrees(100, 140))
    inner = rounded(within(x, 0.0008), within(y, 0.0008), 0.0012)
    lid.add(ribbon(rounded(x, y, 0.002), inner, z, looped=True))
    lid.add(block(x, y, span(z[1], 0.0008), 0.002))
    at = (-0.004, high + 0.0105)
    spark = a.spin("spark_wheel", BACK, (at[0], 0.0, at[1]), look=STEEL)
    spark.add(cylinder(Y, at, 0.003, about(0.0025), 14))


def camera(a: Assembly) -> None:
    """Build a body with a lens that turns or pulls out, dials and a release on top."""
    half, deep, high, long = a.draws((0.045, 0.075), (0.015, 0.03), (0.055, 0.09), (0.02, 0.06))
    skin, metal = a.picks((BLACK, STEEL), (BLACK, STEEL))
    body = a.body(skin)
    body.add(block(about(half), about(deep), (0.0, high), a.draw(0.003, 0.014), 0.002, Y))
    if a.happens(0.5):
        w = a.draw(0.15, 0.24) * half
        left, right = ([(side, high - 0.001), (0.6 * side, high + 0.014)] for side in (-w, w))
        body.add(ribbon(left, right, (-deep - 0.004, 0.6 * deep), Y))
    radius = a.draw(0.36, 0.45) * high
    at = (a.draw(-0.1, 0.1) * half, 0.47 * high)
    front = -deep - PLAY - 0.0035
    body.add(cylinder(Y, at, 0.95 * radius, span(front, 0.004), 28), look=metal)
    start = (at[0], front - PLAY, at[1])
    kind = a.weighted({"both": 0.4, "turn": 0.3, "slide": 0.3})
    reach = a.draw(0.01, 0.035)
    if kind == "slide":
        lens = a.slider("lens", FRONT, start, reach, look=metal)
    else:
        lens = a.spin("lens", FRONT, start, reach if kind == "both" else 0.0, look=metal)
    tube = ((0.9, 0.0), (0.9, 0.6), (0.8, 1.0), (0.6, 1.0), (0.5, 0.8))
    lens.add(lathe([(r * radius, -z * long) for r, z in tube], start, Y, 28))
    for i in range(a.count(1, 2)):
        spot = (half * (0.78 - 0.32 * i), 0.2 * deep)
        dial = a.spin(f"dial_{i}", UP, (*spot, high), look=metal)
        dial.add(cylinder(Z, spot, 0.14 * half, span(high + PLAY, 0.006)))
    x = about(0.006, -0.7 * half)
    y = about(0.006, -0.2 * deep)
    ControlPanel(a, facing_up(high), metal).button("release", x, y, stroke=0.0015, thick=0.003)


def clock(a: Assembly) -> None:
    """Build a dial with two or three hands in a case; at times a pendulum below."""
    radius, deep, rim = a.draws((0.05, 0.18), (0.015, 0.05), (0.006, 0.02))
    skin, dark = a.picks((WHITE, OAK, BLACK, RED, STEEL), (BLACK, RED, BRASS))
    half = radius + rim
    level = half + 0.3
    face = -0.4 * deep
    body = a.body(skin)
    corner = half if a.happens(0.6) else 0.02
    outer, inner = (rounded(about(r), about(r, level), corner, 5) for r in (half, radius))
    body.add(ribbon(outer, inner, (-deep, 0.0), Y, looped=True))
    body.add(prism(inner, (face, -0.001), Y))
    dots = oval(0.88 * radius, 0.88 * radius, 12).tolist()
    body.add(*(ball((x, face, level + z), 0.02 * radius, 6) for x, z in dots), look=dark)
    front = face - 0.02 * radius - PLAY
    hands = (("hour", 0.5, 0.05), ("minute", 0.8, 0.035), ("second", 0.78, 0.012))
    for i, (name, long, wide) in enumerate(hands[: a.count(2, 3)]):
        y = (front - 0.0014 * (i + 1), front - 0.0014 * i - PLAY)
        hand = a.spin(f"{name}_hand", BACK, (0, front, level), look=dark)
        lines = [np.array([(-0.15, side), (long, 0.3 * side)]) for side in (-wide, wide)]
        left, right = (radius * line + (0.0, level) for line in lines)
        plate = ribbon(left, right, y, Y).turned(BACK, a.draw(0, 2 * np.pi), (0, 0, level))
        hand.add(plate, cylinder(Y, (0.0, level), 1.6 * wide * radius, y, 12))
    if a.happens(0.3):
        y0 = -0.6 * deep
        z = (level - half - a.draw(0.1, 0.25), level - half)
        swing = a.hinge("pendulum", BACK, (0, y0, z[1]), 0.25, -0.25, look=BRASS)
        swing.add(box(about(0.002), span(y0, 0.002), within(z, 0.0, 0.003)))
        swing.add(lathe([(0.02, 0.004), (0.025, 0.001), (0.02, -0.002)], (0, y0, z[0]), Y))


def eyeglasses(a: Assembly) -> None:
    """Build lenses or a shield, and temples, spread as worn; positive values fold them in."""
    half, high, long, bar = a.draws((0.062, 0.074), (0.016, 0.025), (0.12, 0.15), (0.0018, 0.005))
    bend, drop, back, ratio = a.draws((0.6, 0.8), (0.01, 0.04), (0.012, 0.02), (1.0, 2.2))
    skin, tint = a.picks((BLACK, STEEL, BRASS, RED, WALNUT), (GLASS, STEEL, BLUE))
    body = a.body(skin)
    level = 0.05
    front = 0.0
    start = half - 0.006
    if a.happens(0.2):
        front = _shield(a, half, high, level, tint)
        start = half
    else:
        _lenses(a, half, high, level, tint)
    z = level + a.draw(0.0, 0.6) * high
    pivot = front + back
    # A folded temple ends beside the other one.
    long = min(long, 2 * (half - bar))
    curl = [(bend + t * (1 - bend), -ratio * drop * t**1.5) for t in (0.33, 0.66, 1.0)]
    line = np.array([(0.0, 0.0), (0.3, 0.0), (bend, 0.0), *curl]) * (long, 1.0) + (pivot, z)
    width = ratio * bar * np.array((1.0, 0.9, 0.8, 1.0, 1.0, 1.0))
    sides = a.pick(4, 8)
    upper = a.degrees(75, 88)
    corner = [(start, front, z), (half, front + 0.003, z), (half, pivot - bar - 0.001, z)]
    body.add(*both(pipe(corner, bar * 0.95, 4, up=UP, flat=ratio)))
    for name, side in (("left", -1.0), ("right", 1.0)):
        x = side * half
        temple = a.hinge(f"{name}_temple", (0.0, 0.0, side), (x, pivot, z), upper)
        temple.add(pipe(raised(line, x, X), width, sides, up=RIGHT, flat=1.0 / ratio))


def _lenses(a: Assembly, half: float, high: float, level: float, tint: Material) -> None:
    """Build two rims around lenses, a bridge, at times pads for the nose."""
    body = a.root
    wide = min(a.draw(0.022, 0.028), 0.42 * half)
    rim, lean, tilted, lift = a.draws((0.0012, 0.003), (0.0, 0.12), (0.0, 0.15), (0.0, 0.45))
    rimless, empty, padded = a.happen(0.15, 0.1, 0.5)
    center = half - wide - 0.004
    way = oval(1.0, 1.0)
    x, z = (np.sign(way) * np.abs(way) ** (2 / a.pick(2.0, 2.5, 3.5))).T
    # Higher on the outer side, as cat-eye frames are.
    rise = high * (z + tilted * x)
    line = np.stack([center + wide * x, lean * wide * x, level + rise], axis=1)
    if not rimless:
        body.add(*both(pipe(line, rim, 6, looped=True, up=BACK)))
    if rimless or not empty:
        thick = np.array([0.0, 0.0006, 0.0])
        body.add(*both(loft(np.stack([line - thick, line + thick]))), look=tint)
    inner = center - 0.97 * wide
    y = -lean * wide
    top = level + lift * high
    bridge = [(inner, y, top), (0.4 * inner, y - 0.002, top + 0.004)]
    path = [*((-px, py, pz) for px, py, pz in bridge), *bridge[::-1]]
    body.add(pipe(path, max(rim, 0.0015), 8, up=UP))
    if padded:
        tip = (0.6 * inner, y + 0.009, level - 0.3 * high)
        body.add(*both(pipe([(inner, y, level - 0.1 * high), tip], 0.0008, 6)))
        pad = [(tip[0], tip[1], tip[2] + rise) for rise in (-0.006, 0.0, 0.006)]
        body.add(*both(pipe(pad, [0.0015, 0.003, 0.0015], 8)), look=tint)


def _shield(a: Assembly, half: float, high: float, level: float, tint: Material) -> float:
    """Build one bent lens with a notch for the nose; returns where its ends lie, on y [m]."""
    bend = a.draw(0.01, 0.022)
    x = np.linspace(-half, half, 17)
    back = bend * (x / half) ** 2
    low = level - high + 0.7 * high * np.exp(-((x / 0.012) ** 2))
    top = level + high - 0.15 * high * (x / half) ** 2
    corners = ((0.0, low), (0.0016, low), (0.0016, top), (0.0, top))
    lens = loft(np.stack([np.stack([x, back + off, z], axis=1) for off, z in corners], axis=1))
    near, far = (np.stack([x, back + off], axis=1) for off in (-0.001, 0.003))
    a.root.add(lens, ribbon(near, far, (level + 0.8 * high, level + high + 0.003)), look=tint)
    return bend + 0.001
