"""Things for the hand, the nose and the wall: USB sticks, phones, cameras, clocks, eyeglasses."""

from __future__ import annotations

import numpy as np

from ....mesh import Material
from ..kit.assembly import BACK, FRONT, LEFT, RIGHT, UP, Assembly, facing_up
from ..kit.controls import button, cells, key
from ..kit.looks import BLACK, BLUE, BRASS, GLASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.shapes import (
    X,
    Y,
    Z,
    about,
    ball,
    block,
    box,
    cylinder,
    lathe,
    loft,
    oval,
    pipe,
    ribbon,
    rounded,
    span,
    within,
)  # fmt: skip

PLAY = 0.0005
SIDES = (("left", -1.0), ("right", 1.0))


def usb_stick(a: Assembly) -> None:
    """A stick with a cap that pulls off, a bracket that swings round, or a plug that slides out."""
    half, long, thick = a.draws((0.006, 0.011), (0.025, 0.045), (0.005, 0.011))
    skin, other = a.picks((BLACK, BLUE, RED, WHITE), (STEEL, BLACK, GREEN))
    x, z, body, middle, wall = about(half), (0.0, thick), a.body(skin), thick / 2, 0.001
    tip, tongue, tail = about(min(half - 0.001, 0.006)), about(0.0022, middle), -0.012
    style = a.pick("cap", "bracket", "slide")
    if style == "slide":
        inner = within(x, wall), within(z, wall)
        body.add(ribbon(rounded(x, z, 0.002), rounded(*inner, 0.001), (0.0, long), Y, looped=True))
        body.add(block(inner[0], span(long, -0.001), inner[1], 0.001, axis=Y))
        plug = a.slider("plug", FRONT, (0, 0, middle), 0.0115, look=other)
        free = within(inner[1], PLAY)
        plug.add(box(within(inner[0], PLAY), (0.012, 0.7 * long), free))
        lip = about(min(half - wall - PLAY, 0.006))
        plug.add(box(lip, (0.0005, 0.012), within(free, 0.0002)), look=STEEL)
        return
    body.add(block(x, (0.0, long), z, a.draw(0.0005, 0.003), 0.0005, Y))
    body.add(box(tip, (tail, 0.0), tongue), look=STEEL)
    end = tail - 0.001
    if style == "cap":
        cap = a.slider("cap", FRONT, (0, 0, middle), a.draw(0.012, 0.03), look=other)
        hole = rounded(within(tip, -PLAY), within(tongue, -PLAY), 0.0004, 2)
        cap.add(ribbon(rounded(x, z, 0.001, 2), hole, (end, -PLAY), Y, looped=True))
        cap.add(block(x, span(end, -0.002), z, 0.001, axis=Y))
        return
    pivot, cover = 0.75 * long, 0.0008
    # The closed end comes round behind the body.
    clears = float(np.hypot(half, long - pivot)) < pivot - tail
    upper = np.pi if clears else a.degrees(90, 120)
    bracket = a.hinge("bracket", UP, (0, pivot, middle), upper, -upper, look=other)
    reach, outer = (end, pivot + 0.8 * half), within(z, -PLAY)
    bracket.add(box(x, reach, span(outer[0], -cover)), box(x, reach, span(outer[1], cover)))
    bracket.add(box(x, span(end, -cover), within(outer, -cover)))
    rivet = cylinder(Z, (0.0, pivot), 0.4 * half, span(outer[1] + cover, 0.0005), 14)
    bracket.add(rivet, look=STEEL)


def phone(a: Assembly) -> None:
    """A phone that flips, or whose screen slides up or sideways over its keys."""
    half, long, thick, r = a.draws((0.022, 0.03), (0.08, 0.12), (0.006, 0.011), (0.002, 0.012))
    skin, other = a.picks((BLACK, STEEL, BLUE, RED), (BLACK, STEEL, WHITE))
    x, y, body, place = about(half), about(long / 2), a.body(skin), facing_up(thick)
    body.add(block(x, y, (0.0, thick), r, 0.001))
    for _, key_x, key_y in cells(about(0.85 * half), (y[0] + 0.006, 0.0), 4, 3):
        body.add(place.form(key(key_x, key_y, (0.0, 0.0006), 0.6)), look=other)
    low = thick + 0.0006 + PLAY
    lid_z = span(low, a.draw(0.004, 0.008))
    cover = block(x, y, lid_z, r, 0.0008)
    if a.happens(0.5):
        sideways = a.happens(0.3)
        reach = a.draw(0.4, 0.6) * (2 * half if sideways else long)
        screen = a.slider("screen", RIGHT if sideways else BACK, (0, 0, low), reach, look=other)
        glass = box(within(x, 0.004), within(y, 0.012, 0.008), span(lid_z[1], 0.0004))
        screen.add(cover)
        screen.add(
            glass, cylinder(Z, (0.0, y[0] + 0.006), 0.003, span(lid_z[1], 0.0005), 12), look=GLASS
        )
        return
    pin = (y[1] + 0.004, low - PLAY / 2)
    lid = a.hinge("lid", LEFT, (0.0, *pin), a.degrees(130, 165), look=other)
    lid.add(cover, cylinder(X, pin, 0.0035, about(0.5 * half), 14))
    lid.add(box(within(x, 0.004), within(y, 0.01), span(low, -0.0004)), look=GLASS)
    tab = (y[1] - 0.002, pin[0])
    lid.add(box(about(0.48 * half), tab, span(low + 0.001, 0.002)))
    for side in (-1.0, 1.0):
        barrel = span(side * (0.5 * half + PLAY), side * (0.4 * half - PLAY))
        ear = box(within(barrel, 0.0003), tab, (thick - 0.003, thick - 0.0008))
        body.add(cylinder(X, pin, 0.0035, barrel, 14), ear)


def remote(a: Assembly) -> None:
    """A remote control or a keypad: rows of buttons that go down."""
    half, long, thick, stroke = a.draws((0.018, 0.05), (0.05, 0.1), (0.01, 0.02), (0.001, 0.002))
    skin, other = a.picks((BLACK, WHITE, STEEL), (WHITE, RED, BLUE, STEEL))
    y, body = about(long), a.body(skin)
    body.add(block(about(half), y, (0.0, thick), a.draw(0.002, 0.8 * half), 0.002))
    pad = about(0.68 * half), (y[0] + 0.01, a.draw(0.2, 0.7) * long)
    for name, x, z in cells(*pad, a.count(2, 4), a.count(1, 3)):
        button(
            a, f"key_{name}", x, z, other, facing_up(thick), stroke=stroke, thick=0.002, style=0.6
        )


def calculator(a: Assembly) -> None:
    """A wedge with a display and rows of keys that go down."""
    half, long, thick, stroke = a.draws((0.03, 0.08), (0.05, 0.09), (0.006, 0.014), (0.0012, 0.003))
    skin, other = a.picks((BLACK, WHITE, STEEL, BLUE), (WHITE, BLACK, RED, STEEL))
    body, tall, style = a.body(skin), a.draw(0.0015, 0.005), a.draw(0.2, 0.9)
    body.add(block(about(half), about(long), (0.0, thick), a.draw(0.002, 0.012), 0.001))
    body.add(box(about(0.85 * half), (0.45 * long, 0.85 * long), span(thick, 0.0006)), look=GLASS)
    pad, margin = (about(0.875 * half), (-0.9 * long, 0.35 * long)), a.draw(0.06, 0.18)
    for name, x, z in cells(*pad, a.count(2, 3), a.count(3, 4), margin):
        button(
            a, f"key_{name}", x, z, other, facing_up(thick), stroke=stroke, thick=tall, style=style
        )


def lighter(a: Assembly) -> None:
    """A flip lighter: a lid, and under it a wheel."""
    half, deep, high, rise = a.draws((0.016, 0.021), (0.005, 0.007), (0.03, 0.04), (0.016, 0.02))
    x, y, body, r, wall = (
        about(half),
        about(deep),
        a.body(a.pick(STEEL, BRASS, BLACK)),
        0.002,
        0.0008,
    )
    body.add(block(x, y, (0.0, high), r))
    works = block(within(x, 0.003, 0.006), within(y, 0.002), span(high + 0.0002, 0.0068), 0.001)
    body.add(works, look=STEEL)
    low, top = high + PLAY, high + rise
    lid = a.hinge("lid", BACK, (half + 0.001, 0.0, low), a.degrees(100, 140))
    inner = rounded(within(x, wall), within(y, wall), r - wall)
    lid.add(ribbon(rounded(x, y, r), inner, (low, top), looped=True))
    lid.add(block(x, y, span(top, wall), r))
    at = (-0.004, 0.0, high + 0.0105)
    spark = a.spin("spark_wheel", BACK, at, look=STEEL)
    spark.add(cylinder(Y, (at[0], at[2]), 0.003, about(0.0025), 14))


def camera(a: Assembly) -> None:
    """A body with a lens that turns or pulls out, dials and a release on top."""
    half, deep, high, long = a.draws((0.045, 0.075), (0.015, 0.03), (0.055, 0.09), (0.02, 0.06))
    skin, metal = a.picks((BLACK, STEEL), (BLACK, STEEL))
    body, top = a.body(skin), facing_up(high)
    body.add(block(about(half), about(deep), (0.0, high), a.draw(0.003, 0.014), 0.002, Y))
    if a.happens(0.5):
        w, hump = a.draw(0.15, 0.24) * half, (high - 0.001, high + 0.014)
        left, right = ([(s * w, hump[0]), (0.6 * s * w, hump[1])] for s in (-1, 1))
        body.add(ribbon(left, right, (-deep - 0.004, 0.6 * deep), Y))
    radius, at = a.draw(0.36, 0.45) * high, (a.draw(-0.1, 0.1) * half, 0.47 * high)
    front = -deep - PLAY - 0.0035
    body.add(cylinder(Y, at, 0.95 * radius, span(front, 0.004), 28), look=metal)
    start = (at[0], front - PLAY, at[1])
    kind, reach = a.weighted({"both": 0.4, "turn": 0.3, "slide": 0.3}), a.draw(0.01, 0.035)
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
    spot = about(0.006, -0.7 * half), about(0.006, -0.2 * deep)
    button(a, "release", *spot, metal, top, stroke=0.0015, thick=0.003)


def clock(a: Assembly) -> None:
    """A dial with two or three hands, in a round or square case; at times a pendulum below."""
    radius, deep, rim = a.draws((0.05, 0.18), (0.015, 0.05), (0.006, 0.02))
    skin, dark = a.picks((WHITE, OAK, BLACK, RED, STEEL), (BLACK, RED, BRASS))
    body, half, face, level = a.body(skin), radius + rim, -0.4 * deep, radius + rim + 0.3
    if a.happens(0.6):
        body.add(
            lathe(
                [(half, 0.0), (half, -deep), (radius, -deep), (radius, face)], (0, 0, level), Y, 40
            )
        )
    else:
        outer, inner = (
            rounded(about(w), about(w, level), r) for w, r in ((half, 0.02), (radius, 0.01))
        )
        body.add(ribbon(outer, inner, (-deep, 0.0), Y, looped=True))
        body.add(block(about(radius), (face, -0.001), about(radius, level), 0.01, axis=Y))
    dots = oval(0.88 * radius, 0.88 * radius, 12)
    body.add(*(ball((x, face, level + z), 0.02 * radius, 6) for x, z in dots.tolist()), look=dark)
    front, step = face - 0.02 * radius, 0.0014
    hands = (("hour", 0.5, 0.05), ("minute", 0.8, 0.035), ("second", 0.78, 0.012))
    for i, (name, long, wide) in enumerate(hands[: a.count(2, 3)]):
        y, angle = (
            (front - PLAY - (i + 1) * step, front - 2 * PLAY - i * step),
            a.draw(0, 2 * np.pi),
        )
        hand = a.spin(f"{name}_hand", BACK, (0, front, level), look=dark)
        edges = [[(-0.15, s * wide), (long, 0.3 * s * wide)] for s in (-1, 1)]
        left, right = (radius * np.array(edge) + (0.0, level) for edge in edges)
        boss = cylinder(Y, (0.0, level), 1.6 * wide * radius, y, 12)
        hand.add(boss, ribbon(left, right, y, Y).turned(BACK, angle, (0, 0, level)))
    if a.happens(0.3):
        y, low, long = -0.6 * deep, level - half, a.draw(0.1, 0.25)
        swing = a.hinge("pendulum", BACK, (0, y, low), 0.25, -0.25, look=BRASS)
        swing.add(box(about(0.002), span(y, 0.002), (low - long, low - 0.003)))
        swing.add(lathe([(0.02, 0.004), (0.025, 0.001), (0.02, -0.002)], (0, y, low - long), Y))


def eyeglasses(a: Assembly) -> None:
    """A front with two lenses or a shield, and two temples, spread as they are worn; positive values fold them in."""
    skin, tint = a.picks((BLACK, STEEL, BRASS, RED, WALNUT), (GLASS, STEEL, BLUE))
    half, high, long, bar = a.draws((0.062, 0.074), (0.016, 0.025), (0.12, 0.15), (0.0018, 0.005))
    level, front, start, body = 0.05, 0.0, half - 0.006, a.body(skin)
    if a.happens(0.2):
        bend = a.draw(0.01, 0.022)
        front, start = _shield(a, half, high, bend, level, tint), half
    else:
        _lenses(a, half, min(a.draw(0.022, 0.028), 0.42 * half), high, level, tint)
    z, thick, pivot = (
        level + a.draw(0.0, 0.6) * high,
        bar * a.draw(1.0, 2.2),
        front + a.draw(0.012, 0.02),
    )
    drop, bend = a.draw(0.01, 0.04) * thick / bar, a.draw(0.6, 0.8)
    curl = [(bend + t * (1 - bend), -drop * t**1.5) for t in (0.33, 0.66, 1.0)]
    line = np.array([(0.0, 0.0), (0.3, 0.0), (bend, 0.0), *curl]) * (long, 1.0) + (pivot, z)
    width, sides, upper = (
        bar * np.array((1.0, 0.9, 0.8, 1.0, 1.0, 1.0)),
        a.pick(4, 8),
        a.degrees(75, 88),
    )
    for name, side in SIDES:
        x = side * half
        corner = [(side * start, front, z), (x, front + 0.003, z), (x, pivot - bar - 0.001, z)]
        body.add(pipe(corner, bar * 0.95, 4, up=UP, flat=thick / bar))
        temple = a.hinge(f"{name}_temple", (0.0, 0.0, side), (x, pivot, z), upper)
        path = np.column_stack([np.full(len(line), x), line])
        temple.add(pipe(path, width * thick / bar, sides, up=RIGHT, flat=bar / thick))


def _lenses(
    a: Assembly, half: float, wide: float, high: float, level: float, tint: Material
) -> None:
    """Two rims around lenses, a bridge, at times pads for the nose."""
    body, power, rim, rimless = (
        a.root,
        a.pick(2.0, 2.5, 3.5),
        a.draw(0.0012, 0.003),
        a.happens(0.15),
    )
    center, lean, tilted = half - wide - 0.004, a.draw(0.0, 0.12), a.draw(0.0, 0.15) * high
    way = oval(1.0, 1.0)
    x, z = (np.sign(way) * np.abs(way) ** (2 / power)).T
    # Higher on the outer side, as cat-eye frames are.
    right = np.stack([center + wide * x, lean * wide * x, level + high * z + tilted * x], axis=1)
    for side in (-1.0, 1.0):
        line = right * (side, 1.0, 1.0)
        if not rimless:
            body.add(pipe(line, rim, 6, looped=True, up=BACK))
        if a.happens(0.9):
            depth = np.array([0.0, 0.0006, 0.0])
            body.add(loft(np.stack([line - depth, line + depth])), look=tint)
    inner, y, top = center - 0.97 * wide, -lean * wide, level + a.draw(0.0, 0.45) * high
    bridge = [(inner, y, top), (0.4 * inner, y - 0.002, top + 0.004)]
    body.add(
        pipe([*((-px, py, pz) for px, py, pz in bridge), *bridge[::-1]], max(rim, 0.0015), 8, up=UP)
    )
    for side in (-1.0, 1.0) if a.happens(0.5) else ():
        x_end, y_end, z_end = side * 0.6 * inner, y + 0.009, level - 0.3 * high
        body.add(pipe([(side * inner, y, level - 0.1 * high), (x_end, y_end, z_end)], 0.0008, 6))
        pad = [(x_end, y_end, z_end + rise) for rise in (-0.006, 0.0, 0.006)]
        body.add(pipe(pad, [0.0015, 0.003, 0.0015], 8), look=tint)


def _shield(
    a: Assembly, half: float, high: float, bend: float, level: float, tint: Material
) -> float:
    """One bent lens over both eyes, with a notch for the nose; where its ends lie, on y [m]."""
    x = np.linspace(-half, half, 17)
    back, notch = bend * (x / half) ** 2, 0.7 * high * np.exp(-((x / 0.012) ** 2))
    low, top = level - high + notch, level + high - 0.15 * high * (x / half) ** 2
    corners = ((0.0, low), (0.0016, low), (0.0016, top), (0.0, top))
    lens = loft(np.stack([np.stack([x, back + off, z], axis=1) for off, z in corners], axis=1))
    lines = (np.stack([x, back + off], axis=1) for off in (-0.001, 0.003))
    brow = ribbon(*lines, (level + 0.8 * high, level + high + 0.003))
    a.root.add(lens, brow, look=tint)
    return bend + 0.001


MAKERS = {
    "usb_stick": usb_stick,
    "phone": phone,
    "remote": remote,
    "calculator": calculator,
    "lighter": lighter,
    "camera": camera,
    "clock": clock,
    "eyeglasses": eyeglasses,
}
