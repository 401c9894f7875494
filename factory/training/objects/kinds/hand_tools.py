"""Scissors, pliers, staplers, knives, pens."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ....mesh import Material
from ..kit.assembly import BACK, DOWN, FRONT, LEFT, UP, Assembly, PartDraft
from ..kit.looks import BLACK, BLUE, GREEN, RED, STEEL
from ..kit.shapes import (
    Form,
    Span,
    X,
    Y,
    Z,
    about,
    block,
    box,
    cylinder,
    lathe,
    oval,
    pipe,
    ribbon,
    span,
    within,
)  # fmt: skip

#: Between blades that slide past each other [m].
PLAY = 0.0006


def _strip(rows: npt.ArrayLike, along: Span, axis: int = Z) -> Form:
    """A plate given by rows of one place and two edges there: y, left, right for axis Z, else y or x, low, high."""
    place, left, right = np.asarray(rows, dtype=np.float64).T
    lines = [
        np.stack((edge, place) if axis == Z else (place, edge), axis=1) for edge in (left, right)
    ]
    return ribbon(*lines, along, axis)


def scissors(a: Assembly) -> None:
    """Two blades on a pin, closed, lying flat; each ends in a loop for the fingers."""
    thick, blade, grip, half = a.draws((0.0015, 0.003), (0.07, 0.13), (0.06, 0.1), (0.006, 0.011))
    skin, tip, loop = (
        a.pick(RED, BLACK, BLUE, STEEL, GREEN),
        a.draw(0.001, 0.4 * half),
        a.draw(0.014, 0.024),
    )
    edge, body = a.draw(0.0, 0.3) * half, a.body(STEEL)
    layers = (0.0, thick), span(thick + PLAY, thick)
    full = (min(0.0, thick - 0.004), layers[1][1] + 0.002)
    rows = [(blade, -tip, tip), (0.6 * blade, -0.8 * half, 0.9 * half), (half, -half, half), (0.0, -half, half),
            (-half, -0.6 * half, half), (-0.45 * grip, 0.1 * half + edge, half + 0.002),
            (-0.6 * grip, 0.0012, half + 0.004)]  # fmt: skip
    other = a.hinge("blade", DOWN, (0, 0, 0), a.degrees(35, 70))
    for part, z in ((body, layers[0]), (other, layers[1])):
        wide, long = loop * (1.0 if part is body else a.draw(0.8, 1.2)), a.draw(0.018, 0.038)
        center = (0.0012 + wide + 0.004, -0.55 * grip - long)
        ring = np.column_stack([oval(wide, long, 20) + center, np.full(20, sum(full) / 2)])
        flat = (full[1] - full[0]) / 0.009
        forms = [_strip(rows, z), pipe(ring, 0.0045, a.pick(4, 8), looped=True, flat=flat)]
        steel, handle = forms if part is body else [form.mirrored() for form in forms]
        part.add(steel)
        part.add(handle, look=skin)
    body.add(cylinder(Z, (0.0, 0.0), 0.4 * half, (-0.001, -PLAY / 2), 12))
    other.add(cylinder(Z, (0.0, 0.0), 0.45 * half, span(layers[1][1], 0.0015), 12))


def pliers(a: Assembly) -> None:
    """Two levers crossing at a rivet: jaws on one side, handles on the other."""
    thick, boss, jaw, grip = a.draws((0.008, 0.014), (0.009, 0.014), (0.025, 0.07), (0.09, 0.15))
    skin, gap, bow = a.pick(RED, BLUE, BLACK, STEEL), 0.0004, a.draw(0.012, 0.03)
    # Flat jaws, needles, cutters and slip joints.
    jaw_tip, start, body = (
        a.pick(0.8 * boss, a.draw(0.002, 0.008), 0.9 * boss, 0.6 * boss),
        boss + 0.0012,
        a.body(STEEL),
    )
    lever = a.hinge("lever", UP, (0, 0, 0), a.degrees(15, 45))
    for part, z in ((body, (0.0, (thick - PLAY) / 2)), (lever, ((thick + PLAY) / 2, thick))):
        path = [(-0.5 * boss, -start - 0.0055), (-bow, -0.3 * grip), (-bow * a.draw(0.9, 1.2), -0.7 * grip),
                (-bow * a.draw(0.7, 1.1), -grip)]  # fmt: skip
        line = np.column_stack([path, np.full(4, thick / 2)])
        handle = pipe(
            line, [0.45 * boss, 0.0055, 0.0065, 0.006], a.pick(4, 8, 10), up=UP, flat=thick / 0.013
        )
        forms = [
            cylinder(Z, (0.0, 0.0), boss, z, 20),
            _strip([(start + 0.002, gap, 0.9 * boss), (0.0, gap - 0.3 * boss, boss)], z),
            _strip(
                [(start + jaw, gap, jaw_tip), (start + 0.4 * jaw, gap, boss), (start, gap, boss)],
                (0.0, thick),
            ),
            _strip([(0.0, -boss, 0.3 * boss), (-start - 0.002, -boss, -gap)], z),
        ]
        if part is lever:
            forms, handle = [form.mirrored() for form in forms], handle.mirrored()
        part.add(*forms)
        part.add(handle, look=skin)
    lever.add(cylinder(Z, (0.0, 0.0), 0.5 * boss, span(thick, 0.0015), 12))


def stapler(a: Assembly) -> None:
    """A base with its anvil, a magazine and a cover that turn about a pin at the back.

    Cover and magazine both hang on the base, each on its own: what opens the magazine lifts the
    cover too.
    """
    long, half, foot, rise, mag = a.draws(
        (0.09, 0.2), (0.014, 0.022), (0.005, 0.011), (0.014, 0.024), (0.009, 0.013)
    )
    skin, dark = a.picks((BLACK, RED, BLUE, STEEL), (BLACK, STEEL))
    front, body, pin = -long, a.body(skin), (0.0, 0.0, foot + rise)
    base = about(a.draw(1.0, 1.3) * half), (front - 0.004, 0.016), (0.0, foot)
    body.add(block(*base, a.draw(0.002, 0.016), 0.001))
    body.add(
        box(about(0.4 * half), span(front + 0.004, 0.016), span(foot + 0.0001, 0.0014)), look=STEEL
    )
    for side in (-1.0, 1.0):
        ear = span(side * (half + 0.0008), side * 0.0022)
        body.add(box(ear, about(0.012), (foot - 0.001, pin[2] + 0.008)), look=dark)
    low, inner = pin[2] - 0.35 * mag, about(0.75 * half)
    magazine = a.hinge("magazine", LEFT, pin, a.degrees(20, 45), look=STEEL)
    magazine.add(box(inner, (front, 0.002), span(low, 0.002)))
    for end, way in zip(inner, (0.0015, -0.0015), strict=True):
        magazine.add(box(span(end, way), (front + 0.0005, 0.0015), (low + 0.002, low + mag)))
    nose = box(within(inner, 0.0016), span(front - 0.001, 0.005), (low + 0.001, low + mag))
    magazine.add(nose, look=dark)
    start, hump, steep = low + mag + a.draw(0.001, 0.006), a.draw(0.012, 0.03), a.draw(0.3, 0.9)
    cover = a.hinge("cover", LEFT, pin, a.degrees(60, 130))
    top = [(front - 0.002, steep), (0.7 * front, 0.95), (0.3 * front, 1.0), (0.0, 0.6)]
    cover.add(_strip([(y, start, start + share * hump) for y, share in top], about(half), X))
    lips = (0.9 * front, -0.004), (low + 0.4 * mag, start)
    cover.add(*(box(span(side * half, -side * 0.002), *lips) for side in (-1.0, 1.0)))


def pocket_knife(a: Assembly) -> None:
    """A handle of two scales with one to three blades folded in between."""
    long, high, scale = a.draws((0.07, 0.11), (0.014, 0.022), (0.003, 0.006))
    count, slot, body = a.count(1, 3), 0.0025 + 2 * PLAY, a.body(a.pick(RED, BLACK, STEEL, GREEN))
    width = count * slot
    outline = np.array([(-0.003, 0.15, 0.85), (0.006, 0.0, 1.0), (0.5 * long, a.draw(-0.1, 0.1), a.draw(0.95, 1.1)),
                        (long - 0.006, 0.0, 1.0), (long, 0.2, 0.8)]) * (1.0, high, high)  # fmt: skip
    body.add(_strip(outline, (-scale, 0.0), Y), _strip(outline, span(width, scale), Y))
    body.add(box((0.012, long - 0.012), (0.0, width), (0.0, 0.12 * high)), look=STEEL)
    z, base = 0.72 * high, 0.45 * high
    for i in range(count):
        reach, end = a.draw(0.7, 0.9) * (long - 0.012), base + a.draw(0.0, 0.24) * high
        rows = np.array([(0.004, z - 0.15 * high, z + 0.15 * high), (0.015, base, z + a.draw(0.3, 0.55) * high),
                         (0.7 * reach, base, z + 0.5 * high), (reach, end, end + 0.001)])  # fmt: skip
        right, pivot = i % 2 == 1, 0.006
        if right:
            rows[:, 0] = long - rows[:, 0]
            pivot = long - pivot
        y = within((i * slot, (i + 1) * slot), PLAY)
        at = (pivot, 0.0, z)
        blade = a.hinge(f"blade_{i}", BACK if right else FRONT, at, a.degrees(160, 180), look=STEEL)
        blade.add(_strip(rows, y, Y), cylinder(Y, (pivot, z), 0.2 * high, y, 14))


def cutter(a: Assembly) -> None:
    """A utility knife: a hollow grip with a blade that a thumb slide pushes out."""
    long, half, thick, wall = *a.draws((0.11, 0.17), (0.008, 0.013), (0.01, 0.016)), 0.002
    slit, y, body = 0.0035, (0.0, long), a.body(a.pick(RED, BLACK, BLUE, GREEN))
    body.add(block(about(half), y, (0.0, wall), 0.003))
    for side in (-1.0, 1.0):
        body.add(box(span(side * half, -side * wall), within(y, 0.003), (wall, thick)))
        edge = span(side * (half - wall), side * (slit + wall - half))
        body.add(box(edge, within(y, 0.004), (thick - wall, thick - 0.0002)))
    body.add(box(about(half - wall), span(long - 0.004, -0.002), (wall, thick - wall)))
    level, inner, tip = (
        wall + 0.3 * (thick - 2 * wall),
        half - wall - PLAY,
        0.004 + 0.6 * (half - wall),
    )
    at, reach = a.draw(0.5, 0.55) * long, a.draw(0.3, 0.45) * long
    blade = a.slider("blade", FRONT, (0, at, level), reach, look=BLACK)
    rows = [(0.004, -inner, 0.001 - inner), (tip, -inner, inner), (0.55 * long, -inner, inner)]
    blade.add(_strip(rows, span(level, 0.001)), look=STEEL)
    blade.add(box(about(slit - PLAY), span(at, -0.02), (level + 0.001, thick + 0.001)))
    blade.add(
        block(about(0.7 * half), (at - 0.022, at + 0.002), span(thick + 0.001, 0.004), 0.003, 0.001)
    )


def pen(a: Assembly) -> None:
    """A pen lying along Y: with a cap that pulls off and turns, or with a button at its end."""
    skin, other = a.picks((BLACK, BLUE, RED, STEEL), (BLACK, STEEL, BLUE))
    radius, long, sides, body = (
        *a.draws((0.0035, 0.007), (0.11, 0.15)),
        a.pick(6, 12, 20),
        a.body(skin),
    )
    tip = [(0.0006, 0.0), (0.35 * radius, 0.008), (0.8 * radius, 0.02)]
    if a.happens(0.45):
        stroke = a.draw(0.002, 0.005)
        body.add(lathe([*tip, (radius, 0.03), (radius, long)], axis=Y, sides=sides))
        _clip(body, radius, (long - 0.002, long - 0.045), other)
        start = long + stroke + PLAY
        button = a.slider("button", FRONT, (0, start, 0), stroke, look=other)
        button.add(cylinder(Y, (0.0, 0.0), 0.5 * radius, span(start, a.draw(0.006, 0.014)), 14))
        return
    shaft = [(0.8 * radius, 0.045), (radius, 0.046), (0.9 * radius, long)]
    body.add(lathe([*tip, *shaft], axis=Y, sides=sides))
    bore, edge, outer = 0.8 * radius / np.cos(np.pi / 20) + PLAY, 0.045 - PLAY, 1.12 * radius
    at, reach = (0.0, edge, 0.0), a.draw(0.045, 0.08)
    if a.happens(0.5):
        cap = a.slider("cap", FRONT, at, reach, look=other)
    else:
        cap = a.spin("cap", FRONT, at, reach, look=other)
    shape = [(bore, -0.002), (bore, edge), (outer, edge), (outer, 0.0), (0.8 * radius, -0.008)]
    cap.add(lathe(shape, axis=Y, sides=20))
    _clip(cap, outer, (0.0, 0.038), other)


def _clip(part: PartDraft, radius: float, y: tuple[float, float], look: Material) -> None:
    """A flat bar along the top, held at its first end."""
    foot = span(y[0], 0.004 if y[1] > y[0] else -0.004)
    part.add(box(about(0.0015), span(y[0], y[1] - y[0]), span(radius + 0.001, 0.001)), look=look)
    part.add(box(about(0.0014), foot, (0.7 * radius, radius + 0.001)), look=look)


MAKERS = {
    "scissors": scissors,
    "pliers": pliers,
    "stapler": stapler,
    "pocket_knife": pocket_knife,
    "cutter": cutter,
    "pen": pen,
}
