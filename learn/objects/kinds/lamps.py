"""Desk lamps and standing lamps."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import DOWN, RIGHT, UP, Assembly, PartDraft, facing_up
from ..kit.controls import button, knob
from ..kit.looks import BLACK, BRASS, RED, STEEL, WHITE
from ..kit.shapes import ball, block, cylinder, lathe, pipe
from ..kit.spans import PLAY, Span, X, Z, about, span


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
    if a.happens(0.5):
        knob(a, "dimmer", at, 0.011, metal, facing_up(top), upper=a.degrees(180, 320))
        return
    x, y = (about(0.01, v) for v in at)
    thick = a.draw(0.004, 0.008)
    button(a, "switch", x, y, metal, facing_up(top), stroke=0.0035, thick=thick)


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
