"""Scissors, pliers, staplers, knives, pens."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, DOWN, FRONT, LEFT, UP, X, Y, Z
from ..kit.looks import BLACK, BLUE, GREEN, RED, STEEL
from ..kit.outlines import oval, raised
from ..kit.shapes import Form, block, both, box, cylinder, lathe, pipe, ribbon
from ..kit.spans import PLAY, Span, about, ends, span, within


def _strip(rows: npt.ArrayLike, along: Span, axis: int = Z) -> Form:
    """Return a plate across an axis, given by rows of a place and the two edges there.

    Places lie on y across Z and X, on x across Y; edges on x, z and z.
    """
    place, left, right = np.asarray(rows, dtype=np.float64).T
    order = (1, 0) if axis == Z else (0, 1)
    one, other = (np.stack((place, edge), axis=1)[:, order] for edge in (left, right))
    return ribbon(one, other, along, axis)


def scissors(a: Assembly) -> None:
    """Build two blades on a pin, closed, lying flat; each ends in a loop for the fingers."""
    thick, long, grip, half = a.draws((0.0015, 0.003), (0.07, 0.13), (0.06, 0.1), (0.006, 0.011))
    skin = a.pick(RED, BLACK, BLUE, STEEL, GREEN)
    tip, edge = a.draws((0.001, 0.4 * half), (0.0, 0.3 * half))
    rows = [
        (long, -tip, tip),
        (0.6 * long, -0.8 * half, 0.9 * half),
        (half, -half, half),
        (0.0, -half, half),
        (-half, -0.6 * half, half),
        (-0.45 * grip, 0.1 * half + edge, half + 0.002),
        (-0.6 * grip, 0.0012, half + 0.004),
    ]
    body = a.body(STEEL)
    blade = a.hinge("blade", DOWN, (0, 0, 0), a.degrees(35, 70))
    upper = span(thick + PLAY, thick)
    low = min(0.0, thick - 0.004)
    high = upper[1] + 0.002
    loop = a.draw(0.014, 0.024)
    for part, z in ((body, (0.0, thick)), (blade, upper)):
        wide = loop * (1.0 if part is body else a.draw(0.8, 1.2))
        tall = a.draw(0.018, 0.038)
        path = raised(oval(wide, tall, 20), (low + high) / 2)
        handle = pipe(path, 0.0045, a.pick(4, 8), looped=True, flat=(high - low) / 0.009)
        handle = handle.shifted((0.0012 + wide + 0.004, -0.55 * grip - tall, 0.0))
        forms = [_strip(rows, z), handle]
        if part is blade:
            forms = [form.mirrored() for form in forms]
        part.add(forms[0])
        part.add(forms[1], look=skin)
    body.add(cylinder(Z, (0.0, 0.0), 0.4 * half, (-0.001, -PLAY / 2), 12))
    blade.add(cylinder(Z, (0.0, 0.0), 0.45 * half, span(upper[1], 0.0015), 12))


def pliers(a: Assembly) -> None:
    """Build two levers crossing at a rivet: jaws on one side, handles on the other."""
    thick, boss, jaw, grip = a.draws((0.008, 0.014), (0.009, 0.014), (0.025, 0.07), (0.09, 0.15))
    skin = a.pick(RED, BLUE, BLACK, STEEL)
    bow = a.draw(0.012, 0.03)
    # Flat jaws, needles, cutters and slip joints.
    tip = a.pick(0.8 * boss, a.draw(0.002, 0.008), 0.9 * boss, 0.6 * boss)
    start = boss + 0.0012
    gap = 0.0004
    body = a.body(STEEL)
    lever = a.hinge("lever", UP, (0, 0, 0), a.degrees(15, 45))
    for part, z in ((body, (0.0, (thick - PLAY) / 2)), (lever, ((thick + PLAY) / 2, thick))):
        bend = [
            (-0.5 * boss, -start - 0.0055),
            (-bow, -0.3 * grip),
            (-bow * a.draw(0.9, 1.2), -0.7 * grip),
            (-bow * a.draw(0.7, 1.1), -grip),
        ]
        path = [(x, y, thick / 2) for x, y in bend]
        width = [0.45 * boss, 0.0055, 0.0065, 0.006]
        handle = pipe(path, width, a.pick(4, 8, 10), up=UP, flat=thick / 0.013)
        jaws = [(start + jaw, gap, tip), (start + 0.4 * jaw, gap, boss), (start, gap, boss)]
        forms = [
            handle,
            cylinder(Z, (0.0, 0.0), boss, z, 20),
            _strip([(start + 0.002, gap, 0.9 * boss), (0.0, gap - 0.3 * boss, boss)], z),
            _strip(jaws, (0.0, thick)),
            _strip([(0.0, -boss, 0.3 * boss), (-start - 0.002, -boss, -gap)], z),
        ]
        if part is lever:
            forms = [form.mirrored() for form in forms]
        part.add(forms[0], look=skin)
        part.add(*forms[1:])
    lever.add(cylinder(Z, (0.0, 0.0), 0.5 * boss, span(thick, 0.0015), 12))


def stapler(a: Assembly) -> None:
    """Build a base with its anvil, a magazine and a cover that turn about a pin at the back.

    Cover and magazine both hang on the base: what opens the magazine lifts the cover too.
    """
    long, half, foot, rise = a.draws((0.09, 0.2), (0.014, 0.022), (0.005, 0.011), (0.014, 0.024))
    mag, gap, hump, steep = a.draws((0.009, 0.013), (0.001, 0.006), (0.012, 0.03), (0.3, 0.9))
    skin, dark = a.picks((BLACK, RED, BLUE, STEEL), (BLACK, STEEL))
    front = -long
    pin = (0.0, 0.0, foot + rise)
    body = a.body(skin)
    wide = about(a.draw(1.0, 1.3) * half)
    body.add(block(wide, (front - 0.004, 0.016), (0.0, foot), a.draw(0.002, 0.016), 0.001))
    anvil = box(about(0.4 * half), span(front + 0.004, 0.016), span(foot + 0.0001, 0.0014))
    body.add(anvil, look=STEEL)
    ear = box(span(half + 0.0008, 0.0022), about(0.012), (foot - 0.001, pin[2] + 0.008))
    body.add(*both(ear), look=dark)
    low = pin[2] - 0.35 * mag
    inner = about(0.75 * half)
    magazine = a.hinge("magazine", LEFT, pin, a.degrees(20, 45), look=STEEL)
    magazine.add(box(inner, (front, 0.002), span(low, 0.002)))
    wall = (front + 0.0005, 0.0015)
    magazine.add(*(box(end, wall, (low + 0.002, low + mag)) for end in ends(inner, 0.0015)))
    nose = box(within(inner, 0.0016), span(front - 0.001, 0.005), (low + 0.001, low + mag))
    magazine.add(nose, look=dark)
    start = low + mag + gap
    cover = a.hinge("cover", LEFT, pin, a.degrees(60, 130))
    top = [(front - 0.002, steep), (0.7 * front, 0.95), (0.3 * front, 1.0), (0.0, 0.6)]
    cover.add(_strip([(y, start, start + share * hump) for y, share in top], about(half), X))
    lip = (low + 0.4 * mag, start)
    cover.add(*(box(end, (0.9 * front, -0.004), lip) for end in ends(about(half), 0.002)))


def pocket_knife(a: Assembly) -> None:
    """Build a handle of two scales with one to three blades folded in between."""
    long, high, scale = a.draws((0.07, 0.11), (0.014, 0.022), (0.003, 0.006))
    belly, back = a.draws((-0.1, 0.1), (0.95, 1.1))
    count = a.count(1, 3)
    slot = 0.0025 + 2 * PLAY
    body = a.body(a.pick(RED, BLACK, STEEL, GREEN))
    nose = [(-0.003, 0.15, 0.85), (0.006, 0.0, 1.0), (0.5 * long, belly, back)]
    tail = [(long - 0.006, 0.0, 1.0), (long, 0.2, 0.8)]
    outline = np.array([*nose, *tail]) * (1.0, high, high)
    inside = (0.0, count * slot)
    body.add(*(_strip(outline, end, Y) for end in ends(within(inside, -scale), scale)))
    body.add(box((0.012, long - 0.012), inside, (0.0, 0.12 * high)), look=STEEL)
    z = 0.72 * high
    base = 0.45 * high
    for i in range(count):
        reach = a.draw(0.7, 0.9) * (long - 0.012)
        end = base + a.draw(0.0, 0.24) * high
        hump = z + a.draw(0.3, 0.55) * high
        heel = [(0.004, z - 0.15 * high, z + 0.15 * high), (0.015, base, hump)]
        point = [(0.7 * reach, base, z + 0.5 * high), (reach, end, end + 0.001)]
        rows = np.array([*heel, *point])
        right = i % 2 == 1
        if right:
            rows[:, 0] = long - rows[:, 0]
        pivot = long - 0.006 if right else 0.006
        y = within(span(i * slot, slot), PLAY)
        axis = BACK if right else FRONT
        blade = a.hinge(f"blade_{i}", axis, (pivot, 0.0, z), a.degrees(160, 180), look=STEEL)
        blade.add(_strip(rows, y, Y), cylinder(Y, (pivot, z), 0.2 * high, y, 14))


def cutter(a: Assembly) -> None:
    """Build a utility knife: a hollow grip with a blade that a thumb slide pushes out."""
    long, half, thick = a.draws((0.11, 0.17), (0.008, 0.013), (0.01, 0.016))
    wall = 0.002
    slit = 0.0035
    y = (0.0, long)
    body = a.body(a.pick(RED, BLACK, BLUE, GREEN), block(about(half), y, (0.0, wall), 0.003))
    body.add(box(about(half - wall), span(long - 0.004, -0.002), (wall, thick - wall)))
    side = box((half - wall, half), within(y, 0.003), (wall, thick))
    edge = box((slit, half - wall), within(y, 0.004), (thick - wall, thick - 0.0002))
    body.add(*both(side, edge))
    level = wall + 0.3 * (thick - 2 * wall)
    inner = half - wall - PLAY
    at = a.draw(0.5, 0.55) * long
    blade = a.slider("blade", FRONT, (0, at, level), a.draw(0.3, 0.45) * long, look=BLACK)
    tip = 0.004 + 0.6 * (half - wall)
    rows = [(0.004, -inner, 0.001 - inner), (tip, -inner, inner), (0.55 * long, -inner, inner)]
    blade.add(_strip(rows, span(level, 0.001)), look=STEEL)
    blade.add(box(about(slit - PLAY), span(at, -0.02), (level + 0.001, thick + 0.001)))
    thumb = (at - 0.022, at + 0.002)
    blade.add(block(about(0.7 * half), thumb, span(thick + 0.001, 0.004), 0.003, 0.001))


def pen(a: Assembly) -> None:
    """Build a pen along Y, with a cap that pulls off and turns, or a button at its end."""
    radius, long = a.draws((0.0035, 0.007), (0.11, 0.15))
    skin, other = a.picks((BLACK, BLUE, RED, STEEL), (BLACK, STEEL, BLUE))
    sides = a.pick(6, 12, 20)
    body = a.body(skin)
    tip = [(0.0006, 0.0), (0.35 * radius, 0.008), (0.8 * radius, 0.02)]
    if a.happens(0.45):
        out, stroke = a.draws((0.006, 0.014), (0.002, 0.005))
        body.add(lathe([*tip, (radius, 0.03), (radius, long)], axis=Y, sides=sides))
        _clip(body, radius, long - 0.002, -0.043, other)
        start = long + stroke + PLAY
        button = a.slider("button", FRONT, (0, start, 0), stroke, look=other)
        button.add(cylinder(Y, (0.0, 0.0), 0.5 * radius, span(start, out), 14))
        return
    shaft = [(0.8 * radius, 0.045), (radius, 0.046), (0.9 * radius, long)]
    body.add(lathe([*tip, *shaft], axis=Y, sides=sides))
    edge = 0.045 - PLAY
    cap = a.screw("cap", FRONT, (0, edge, 0), a.draw(0.045, 0.08), 0.5, look=other)
    bore = 0.8 * radius / np.cos(np.pi / 20) + PLAY
    outer = 1.12 * radius
    shape = [(bore, -0.002), (bore, edge), (outer, edge), (outer, 0.0), (0.8 * radius, -0.008)]
    cap.add(lathe(shape, axis=Y, sides=20))
    _clip(cap, outer, 0.0, 0.038, other)


def _clip(part: PartDraft, radius: float, start: float, long: float, look: Material) -> None:
    """Build a flat bar along the top, held at its start."""
    foot = span(start, 0.004 if long > 0.0 else -0.004)
    bar = box(about(0.0015), span(start, long), span(radius + 0.001, 0.001))
    part.add(bar, box(about(0.0014), foot, (0.7 * radius, radius + 0.001)), look=look)
