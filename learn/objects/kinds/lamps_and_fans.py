"""Lamps, fans and globes: what stands on a foot, or hangs from a ceiling."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, DOWN, FRONT, LEFT, RIGHT, UP, Point, X, Y, Z, facing_up
from ..kit.controls import ControlPanel
from ..kit.looks import BLACK, BLUE, BRASS, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.outlines import arc, oval, raised
from ..kit.shapes import Form, ball, block, cylinder, lathe, loft, pipe
from ..kit.spans import PLAY, Span, about, span


def desk_lamp(a: Assembly) -> None:
    """Build a foot, one to three hinged arms, a shade; a switch or a dimmer on the foot.

    Arms are described straight up, one above the other, and left at an angle. They lie in two
    layers, side by side, so that they can fold past each other.
    """
    wide, thick, bar, post = a.draws((0.07, 0.12), (0.012, 0.035), (0.004, 0.009), (0.015, 0.05))
    skin, metal = a.picks((BLACK, WHITE, RED), (STEEL, BRASS, BLACK))
    body = a.body(skin)
    _foot(a, wide, thick)
    low = thick + PLAY
    holder = body
    if a.happens(0.5):
        holder = a.hinge("turret", UP, (0, 0, low), np.pi, -np.pi, look=metal)
        profile = [(0.022, low), (0.022, low + 0.4 * post), (0.012, low + post)]
        holder.add(lathe(profile, sides=20))
    else:
        body.add(cylinder(Z, (0.0, 0.0), 0.012, (thick, low + post)), look=metal)
    z = low + post + 2.2 * bar + PLAY
    layer = -1.0
    bend = a.draw(-0.5, 0.2)
    count = a.pick(1, 2, 2, 3)
    sharpest = 1.4 if count < 3 else 1.0
    for i in range(count):
        limits = (min(0.45 + bend, 2.4), 0.4 * bend) if i else (1.2, -1.1)
        arm = a.hinge(f"arm_{i}", RIGHT, (0, 0, z), *limits, rest=bend, on=holder, look=metal)
        top = z + a.draw(0.15, 0.35) * 0.85**i
        _arm(a, arm, (z, top), bar, layer * (bar + PLAY))
        holder = arm
        z = top
        layer = -layer
        bend = a.draw(0.5, 1.0) * sharpest
    limits = (min(0.8 + bend, 1.8), bend - a.degrees(20, 50))
    shade = a.hinge("shade", RIGHT, (0, 0, z), *limits, rest=bend, on=holder, look=skin)
    _shade(a, shade, z, bar, layer * (bar + PLAY))
    if a.happens(0.6):
        _switch(a, wide, thick, metal)


def _foot(a: Assembly, wide: float, thick: float) -> None:
    if a.happens(0.55):
        profile = [(wide, 0.0), (wide, 0.5 * thick), (a.draw(0.5, 1.0) * wide, thick)]
        a.root.add(lathe(profile, sides=32))
    else:
        corner = a.draw(0.002, 0.03)
        a.root.add(block(about(wide), about(0.8 * wide), (0.0, thick), corner, 0.002))


def _arm(a: Assembly, arm: PartDraft, z: Span, bar: float, x: float) -> None:
    """Build a bar in one layer, with a disc around the hinge at either end; at times two bars."""
    sides = a.pick(4, 10)
    arm.add(pipe([(x, 0, z[0]), (x, 0, z[1])], 0.98 * bar, sides))
    if a.happens(0.3):
        second = (0.93 * z[0] + 0.07 * z[1], 0.07 * z[0] + 0.93 * z[1])
        arm.add(pipe([(x, 2.6 * bar, level) for level in second], 0.7 * bar, sides))
    arm.add(*(cylinder(X, (0.0, level), 2.0 * bar, about(bar + PLAY / 2, x)) for level in z))


def _shade(a: Assembly, shade: PartDraft, z: float, bar: float, x: float) -> None:
    """Build a shade that looks up, with its bulb and fork; its chain of arms turns it down."""
    neck, long, wide = a.draws((0.015, 0.03), (0.08, 0.16), (0.04, 0.09))
    low = z + 3 * bar + 0.7 * neck
    shade.add(pipe([(x, 0, z), (x, 0, z + 3 * bar + neck)], 0.98 * bar, 8))
    shade.add(cylinder(X, (0.0, z), 2.0 * bar, about(bar + PLAY / 2, x)))
    style = a.pick("cone", "bell", "can", "bar")
    if style == "bar":
        reach = (-a.draw(0.1, 0.2), a.draw(0.1, 0.2))
        shade.add(block(reach, about(0.025), span(low, 0.025), 0.01, 0.003))
        return
    start = wide * (0.7 if style == "can" else a.draw(0.25, 0.4))
    rim = start if style == "can" else wide
    middle = start + (0.85 if style == "bell" else 0.5) * (rim - start)
    top = (rim, low + long)
    outer = [(0.6 * start, low), (start, low + 0.012), (middle, low + 0.5 * long), top]
    inner = [(r - 0.002, h) for r, h in outer[:0:-1]]
    shade.add(lathe([*outer, *inner], sides=a.pick(20, 32)))
    if a.happens(0.6):
        shade.add(ball((0, 0, low + 0.5 * long), 0.6 * min(start, middle)), look=WHITE)


def _switch(a: Assembly, wide: float, top: float, metal: Material) -> None:
    at = (a.draw(-0.4, 0.4) * wide, -0.45 * wide)
    panel = ControlPanel(a, facing_up(top), metal)
    if a.happens(0.5):
        panel.knob("dimmer", at, 0.011, a.degrees(180, 320))
        return
    x, y = (about(0.01, v) for v in at)
    panel.button("switch", x, y, stroke=0.0035, thick=a.draw(0.004, 0.008))


def standing_lamp(a: Assembly) -> None:
    """Build a foot, a pole, a shade on top; a cord or a foot switch, at times a telescopic pole."""
    wide, thick, pole, tall = a.draws((0.1, 0.17), (0.015, 0.03), (0.006, 0.014), (0.9, 1.5))
    skin, metal = a.picks((BLACK, WHITE, BRASS), (STEEL, BRASS, BLACK))
    scale = a.pick(0.35, 1.0)
    wide = max(wide * scale, 0.06)
    tall *= scale
    half = 0.5 * tall
    body = a.body(skin)
    _foot(a, wide, thick)
    holder = body
    if a.happens(0.4):
        thin = 0.6 * pole
        bore = thin + PLAY
        tube = [(pole, thick), (pole, half), (bore, half), (bore, thick + 0.01)]
        body.add(lathe(tube, sides=16), look=metal)
        reach = min(0.8 * (half - thick), a.draw(0.15, 0.5) * tall)
        if a.happens(0.6):
            holder = a.slider("upper_pole", UP, (0, 0, half), reach)
        else:
            holder = a.hinge("upper_pole", UP, (0, 0, half), np.pi, -np.pi, slide=reach)
        holder.add(cylinder(Z, (0.0, 0.0), thin, (thick + 0.012, tall), 12), look=metal)
    else:
        body.add(cylinder(Z, (0.0, 0.0), pole, (thick, tall)), look=metal)
    low, rim = _drum(a, holder, tall, max(scale, 0.5), pole)
    style = a.pick("cord", "cord", "foot", "none")
    if style == "cord":
        x = 0.5 * rim
        end = low - a.draw(0.08, 0.15)
        cord = a.slider("cord", DOWN, (x, 0, low), a.draw(0.02, 0.05), on=holder, look=metal)
        cord.add(cylinder(Z, (x, 0.0), 0.0012, (end, low + 0.05), 6), ball((x, 0, end), 0.007, 8))
    elif style == "foot" or not a.parts:
        _switch(a, wide, thick, metal)


def _drum(
    a: Assembly, part: PartDraft, tall: float, scale: float, pole: float
) -> tuple[float, float]:
    """Return a shade around the top of the pole; the height and the radius of its lower rim [m]."""
    wide, high = a.draws((0.14 * scale, 0.24 * scale), (0.18 * scale, 0.3 * scale))
    taper = a.draw(0.5, 1.0)
    sides = a.pick(4, 6, 20, 32)
    low, top = span(tall - 0.75 * high, high)
    upper = taper * wide
    edges = [(wide, low), (upper, top), (upper - 0.002, top), (wide - 0.002, low)]
    part.add(lathe(edges, sides=sides, looped=True))
    part.add(ball((0, 0, tall), 0.2 * wide + pole), look=WHITE)
    reach = 0.97 * np.cos(np.pi / sides) * wide * (1.0 - 0.75 * (1 - taper))
    spoke = pipe([(0, 0, tall), (reach, 0, tall)], 0.0015, 6)
    part.add(*(spoke.turned(UP, 2 * np.pi * i / 3) for i in range(3)), look=BLACK)
    return low, wide


def _blades(
    a: Assembly, axis: Point, at: Point, count: int, radii: Span, wide: float, pitch: float
) -> list[Form]:
    """Build twisted blades around an axis, Y or Z, between the ``radii`` of hub and tips [m]."""
    share = np.linspace(0.0, 1.0, 5)
    half = 0.5 * wide * (0.45 + 0.55 * np.sin(np.pi * (0.25 + 0.55 * share)) ** 2)
    sweep = a.draw(-0.3, 0.3) * wide * share
    twist = pitch * (1.3 - 0.6 * share)
    hub, tip = radii
    reach = 0.6 * hub + (tip - 0.6 * hub) * share
    corners = []
    for edge, face in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        across = sweep + edge * half * np.cos(twist)
        along = edge * half * np.sin(twist) + face * 0.001
        corners.append((reach, across, along) if axis[2] else (across, along, reach))
    one = loft(np.transpose(corners, (2, 0, 1)) + at)
    return [one.turned(axis, 2 * np.pi * i / count, at) for i in range(count)]


def fan(a: Assembly) -> None:
    """Build a desk or floor fan: a head that tilts, at times swings; blades in a cage, controls."""
    radius, thick, pole, depth = a.draws((0.1, 0.2), (0.015, 0.04), (0.01, 0.018), (0.025, 0.04))
    skin, metal = a.picks((WHITE, BLACK, BLUE, STEEL), (STEEL, BLACK))
    wide = radius * a.draw(0.7, 1.0)
    tall = a.pick(a.draw(0.05, 0.12), a.draw(0.6, 0.9))
    height = thick + tall + radius + 0.03
    neck = height - 0.045
    body = a.body(skin, lathe([(wide, 0.0), (wide, 0.5 * thick), (0.6 * wide, thick)], sides=32))
    body.add(cylinder(Z, (0.0, 0.03), pole, (thick - 0.004, neck)), look=metal)
    half = a.degrees(30, 60)
    turret = a.hinge("turret", UP, (0, 0.03, neck), half, -half) if a.happens(0.4) else body
    collar = [(1.3 * pole, neck + PLAY), (1.1 * pole, height - 0.022)]
    turret.add(lathe(collar, (0, 0.03, 0), sides=16))
    motor = min(max(0.3 * radius, 0.025), 0.05)
    level = height + motor + 0.002
    pin = (0.0, 0.03, height - 0.02)
    head = a.hinge("head", LEFT, pin, a.degrees(10, 25), -a.degrees(3, 9), on=turret)
    shell = [(0.6 * motor, 0.1), (motor, 0.08), (motor, 0.01), (0.7 * motor, -0.002)]
    head.add(lathe(shell, (0, 0, level), Y))
    head.add(cylinder(Y, (0.0, level), 0.004, (-0.012, 0.0), 8), look=metal)
    if a.happens(0.85):
        _cage(a, head, level, radius + 0.012, depth, metal)
    center = (0.0, -0.012 - PLAY - 0.85 * depth, level)
    hub = 0.3 * motor + 0.012
    spinning = a.spin("blades", FRONT, center, on=head)
    core = [(hub, 0.5 * depth), (hub, -0.2 * depth), (0.5 * hub, -0.45 * depth)]
    spinning.add(lathe(core, center, Y, 20))
    pitch = a.draw(0.25, 0.5)
    broad = min(1.4 * depth / np.sin(1.3 * pitch), radius * a.draw(0.5, 0.9))
    spinning.add(*_blades(a, BACK, center, a.count(3, 5), (hub, 0.86 * radius), broad, pitch))
    style = a.weighted({"none": 0.3, "knob": 0.28, "buttons": 0.42})
    panel = ControlPanel(a, facing_up(thick), metal)
    if style == "knob":
        panel.knob("knob", (0.0, -0.55 * wide), 0.014, a.degrees(120, 300))
    elif style == "buttons":
        count = a.count(2, 4)
        for i in range(count):
            x = about(0.008, (i - (count - 1) / 2) * 0.02)
            panel.button(f"button_{i}", x, about(0.006, -0.55 * wide), stroke=0.004, style=0.3)


def _cage(
    a: Assembly, head: PartDraft, level: float, radius: float, depth: float, metal: Material
) -> None:
    """Wire: three rims, spokes front and back, bent outwards."""
    back = 0.002
    front = -0.012 - 2.1 * depth
    middle = (back + front) / 2
    for share, y in ((1.0, middle), (0.6, front), (0.6, back)):
        line = oval(share * radius, share * radius, 24) + np.array((0.0, level))
        head.add(pipe(raised(line, y, Y), 0.0018, 5, looped=True), look=metal)
    bend = [(0.1, front), (0.85, front), (1.0, middle), (0.85, back), (0.25, back)]
    spoke = pipe([(share * radius, y, level) for share, y in bend], 0.0012, 4)
    count = a.pick(8, 12, 16)
    turns = [2 * np.pi * (i + 0.5) / count for i in range(count)]
    head.add(*(spoke.turned(BACK, angle, (0, 0, level)) for angle in turns), look=metal)
    head.add(cylinder(Y, (0.0, level), 0.16 * radius, (front - 0.003, front)), look=metal)


def ceiling_fan(a: Assembly) -> None:
    """Build a canopy and a rod; below, a motor with blades, at times a lamp and a cord."""
    rod, radius, hub = a.draws((0.1, 0.4), (0.4, 0.65), (0.07, 0.11))
    wide, pitch, long = a.draws((0.1, 0.15), (0.12, 0.3), (0.2, 0.3))
    skin, metal = a.picks((OAK, WALNUT, WHITE, BLACK), (BRASS, STEEL, BLACK))
    level = 0.4
    top = level + 0.06 + rod
    body = a.body(metal, lathe([(0.03, top), (0.07, top + 0.04), (0.075, top + 0.05)]))
    body.add(cylinder(Z, (0.0, 0.0), 0.011, (level - 0.05, top + 0.005), 12))
    center = (0.0, 0.0, level)
    spinning = a.spin("blades", UP, center, look=skin)
    shell = [(0.5 * hub, -0.035), (hub, -0.02), (hub, 0.02), (0.6 * hub, 0.05)]
    bore = [(0.013, 0.05), (0.013, -0.035)]
    spinning.add(lathe([*shell, *bore], center, sides=32, looped=True), look=metal)
    spinning.add(*_blades(a, UP, center, a.count(3, 6), (1.2 * hub, radius), wide, pitch))
    low = level - 0.04
    if a.happens(0.6):
        lamp = ((0.6, -0.01), (0.8, -0.03), (0.7, -0.07), (0.3, -0.1))
        body.add(lathe([(0.02, low), *((r * hub, low + z) for r, z in lamp)]), look=WHITE)
    else:
        body.add(lathe([(0.03, low), (0.025, low - 0.012)], sides=16))
    if a.happens(0.5):
        x = 0.9 * hub
        end = level - long
        body.add(pipe([(0.3 * hub, 0, level - 0.048), (x, 0, level - 0.052)], 0.002, 5))
        cord = a.slider("cord", DOWN, (x, 0, level), a.draw(0.02, 0.04))
        cord.add(cylinder(Z, (x, 0.0), 0.001, (end, level - 0.06), 5), ball((x, 0, end), 0.006, 8))


def globe(a: Assembly) -> None:
    """Build a ball on a tilted axis in a half ring on a foot; some half rings swivel."""
    radius, high, gap, lean = a.draws((0.09, 0.18), (0.05, 0.12), (0.008, 0.02), (10, 30))
    skin, metal, wood = a.picks((BLUE, OAK, STEEL), (BRASS, STEEL), (OAK, WALNUT, BLACK))
    swivels = a.happens(0.35)
    foot = radius * a.draw(0.5, 0.75)
    ring = radius + gap
    stem = high + (0.045 if swivels else 0.2 * foot + 0.004)
    center = (0.0, 0.0, stem + ring)
    body = a.body(wood)
    body.add(lathe([(foot, 0.0), (foot, 0.012), (0.35 * foot, 0.03), (0.2 * foot, high)], sides=32))
    body.add(ball((0, 0, high), 0.2 * foot + 0.002))
    top = stem - 0.01 - PLAY if swivels else stem + 0.002
    body.add(cylinder(Z, (0.0, 0.0), 0.004, (high, top), 8), look=metal)
    frame = body
    if swivels:
        frame = a.spin("frame", UP, (0, 0, stem), look=metal)
        frame.add(cylinder(Z, (0.0, 0.0), 0.006, (stem - 0.01, stem + 0.002), 12))
    bow = arc((0.0, center[2]), ring, -np.pi / 2 - 0.05, np.pi / 2 + 0.05, 21)
    forms = [pipe(raised(bow, 0.0, Y), 0.004, 4, flat=a.draw(0.8, 2.0))]
    for way in (-1.0, 1.0):
        pin = span(center[2] + way * ring, way * (radius + 0.001 - ring))
        forms.append(cylinder(Z, (0.0, 0.0), 0.003, pin, 8))
    tilt = np.radians(lean)
    frame.add(*(form.turned(BACK, tilt, center) for form in forms), look=metal)
    axis = (float(np.sin(tilt)), 0.0, float(np.cos(tilt)))
    sphere = a.spin("ball", axis, center, on=frame, look=skin)
    sphere.add(ball(center, radius, a.pick(16, 24, 32)).turned(BACK, tilt, center))
