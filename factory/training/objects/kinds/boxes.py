"""Boxes with flaps, cases, suitcases, mailboxes."""

from __future__ import annotations

import numpy as np

from ....mesh import Material
from ..kit.assembly import LEFT, RIGHT, UP, Assembly
from ..kit.looks import BLACK, BLUE, BRASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.shapes import (
    Form,
    Point,
    Span,
    X,
    Y,
    Z,
    about,
    arc,
    block,
    box,
    cylinder,
    mid,
    pipe,
    ribbon,
    rounded,
    span,
    stack,
    within,
)  # fmt: skip
from ..kit.wheels import bracket, castor, wheel

PLAY = 0.0008
SQUARE = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])


def _opened(a: Assembly, upper: float) -> float:
    """At which angle [rad] a flap stands open that may go to ``upper``; not if that is hardly open."""
    return a.draw(1.62, 0.9 * upper) if upper > 1.9 else 0.0


def flap_box(a: Assembly) -> None:
    """A carton with two to four flaps, or a lid with a tongue, closed or standing open at rest.

    Flaps turn outwards. Where two pairs lie on each other, each is free on its own: who opens a
    lower flap pushes the upper ones up.
    """
    half_x, half_y, high, wall = a.draws((0.06, 0.3), (0.06, 0.25), (0.06, 0.4), (0.0015, 0.005))
    x, y, body = about(half_x), about(half_y), a.body(a.pick(OAK, WHITE, BLUE, BRASS))
    walls = SQUARE * (half_x, half_y)
    body.add(ribbon(walls, walls - wall * SQUARE, (0.0, high), looped=True))
    body.add(box(within(x, wall), within(y, wall), (0.0, wall)))
    style, level, share = (
        a.pick("four", "four", "long", "short", "lid", "tuck"),
        high + PLAY,
        a.draw(0.6, 1.0),
    )
    if style == "lid":
        lid = a.hinge("lid", LEFT, (0, half_y, level), a.degrees(90, 170))
        lid.add(box(x, (y[0] - 0.001, y[1]), span(level, wall)))
        return
    if style == "tuck":
        _flap_pair(
            a, 0, half_x, half_y - wall, a.draw(0.5, 0.95) * min(half_x, half_y), level, wall, True
        )
        _tuck_lid(a, half_x, half_y, level + wall + PLAY, wall)
        return
    opened = a.happens(0.4)
    if style != "long":
        long = share * min(half_y, half_x) if style == "four" else half_x - PLAY
        _flap_pair(a, 0, half_x, half_y - wall, long, level, wall, opened)
        level += wall + PLAY
    if style != "short":
        _flap_pair(a, 1, half_y, half_x, half_y - PLAY, level, wall, opened)


def _tuck_lid(a: Assembly, half_x: float, half_y: float, low: float, wall: float) -> None:
    """The lid of a product box, standing open, with a tongue at its end."""
    value, tongue, z = a.draw(1.65, 2.6), a.draw(0.15, 0.5) * half_y, span(low, wall)
    at, edge = (0.0, half_y + wall, low), -half_y - PLAY
    lid = a.hinge("lid", LEFT, at, value + a.draw(0.2, 1.0), rest=value)
    lid.add(box(about(half_x), about(half_y), z))
    bend = a.hinge("tongue", LEFT, (0.0, edge, low), 0.1, -np.pi / 2, on=lid)
    bend.add(box(about(0.96 * half_x), span(edge, -tongue), z))


def _flap_pair(
    a: Assembly,
    axis: int,
    edge: float,
    half: float,
    long: float,
    level: float,
    wall: float,
    opened: bool,
) -> None:
    """Two flaps at ``+-edge`` along ``axis``, each reaching inwards by ``long`` [m]."""
    upper = a.degrees(180, 250) if a.happens(0.6) else a.degrees(90, 170)
    across = about(0.98 * half - 0.001)
    for name, side in (("near", -1.0), ("far", 1.0)):
        reach, pin = span(side * edge, -side * long), side * (edge + wall)
        # A little outside the wall it hangs on, or the flap would cut into that.
        turn: Point = (0.0, side, 0.0) if axis == 0 else (-side, 0.0, 0.0)
        at = (pin, 0.0, level) if axis == 0 else (0.0, pin, level)
        # All of them lean outwards, or one would stand in another's way.
        rest = _opened(a, upper) if opened else 0.0
        flap = a.hinge(f"flap_{'xy'[axis]}_{name}", turn, at, upper, rest=rest)
        x, y = (reach, across) if axis == 0 else (across, reach)
        flap.add(box(x, y, span(level, wall)))


def _half_shell(x: Span, y: Span, z: Span, wall: float, radius: float, axis: int = Z) -> Form:
    """An open tray with rounded corners; its floor lies at ``z[0]``, whichever end that is.

    ``z`` runs along ``axis``, and ``x`` and ``y`` across it.
    """
    outer = rounded(x, y, radius)
    inner = rounded(within(x, wall), within(y, wall), max(radius - wall, 0.001))
    middle, (low, high) = (mid(x), mid(y)), z
    soft, up = (outer - middle) * (0.99, 0.98) + middle, 1.0 if high > low else -1.0
    shoulder = low + 0.2 * (high - low)
    rows = [(soft, low), (outer, shoulder), (outer, high), (inner, high), (inner, low + up * wall)]
    return stack(rows, axis)


def case(a: Assembly) -> None:
    """A briefcase, a tool case or a suitcase lying down: two shells, latches, a grip that folds."""
    skin, metal = a.picks((BLACK, WALNUT, BLUE, STEEL, RED), (BRASS, STEEL, BLACK))
    half_x, half_y, low, high = a.draws((0.15, 0.35), (0.11, 0.24), (0.03, 0.12), (0.025, 0.1))
    radius, seam, pin, x, y = (
        a.draw(0.006, 0.05),
        low + PLAY,
        half_y + 0.004,
        about(half_x),
        about(half_y),
    )
    body = a.body(skin)
    body.add(_half_shell(x, y, (0.0, low), 0.004, radius))
    lid = a.hinge("lid", LEFT, (0, pin, seam), a.degrees(80, 120))
    lid.add(_half_shell(x, y, (seam + high, seam), 0.004, radius))
    for part, side in ((body, -1.0), (lid, 1.0)):
        for cx in (-0.6 * half_x, 0.6 * half_x):
            plate = span(cx + side * 0.003, side * 0.025), (half_y - 0.002, pin)
            part.add(
                cylinder(X, (pin, seam), 0.003, span(cx + side * 0.001, side * 0.029), 8),
                look=metal,
            )
            part.add(box(*plate, span(seam + side * 0.001, side * 0.011)), look=metal)
    if a.happens(0.7):
        for i, cx in enumerate((-0.55 * half_x, 0.55 * half_x)):
            at, z = (cx, y[0] - 0.006, seam - 0.012), (seam - 0.012, seam + 0.008)
            latch = a.hinge(f"latch_{i}", RIGHT, at, a.degrees(60, 120), look=metal)
            latch.add(box(about(0.012, cx), (y[0] - 0.006, y[0] - PLAY), z))
    half, reach, z = a.draw(0.045, 0.07), y[0] - a.draw(0.025, 0.04), min(0.6 * low, low - 0.016)
    for cx in (-half - 0.008, half + 0.008):
        body.add(box(about(0.003, cx), (y[0] - 0.011, y[0] + 0.002), about(0.005, z)), look=metal)
    start = y[0] - 0.008
    folds = a.happens(0.7)
    grip = a.hinge("grip", RIGHT, (0, start, z), a.degrees(50, 75), -0.1) if folds else body
    path = [(-half, start, z), (-0.85 * half, reach, z), (0.85 * half, reach, z), (half, start, z)]
    grip.add(pipe(path, 0.004, 8), look=BLACK)


def trolley_case(a: Assembly) -> None:
    """An upright suitcase: a telescopic handle, two or four wheels, at times a front that opens."""
    skin, metal = a.picks((BLACK, BLUE, RED, GREEN, STEEL), (STEEL, BLACK))
    half_x, half_y, high = a.draws((0.17, 0.25), (0.1, 0.15), (0.45, 0.7))
    radius, r, tube, well = *a.draws((0.018, 0.03), (0.02, 0.06)), 0.006, 0.022
    base, apart = 2 * radius + 0.008, a.draw(0.05, 0.5 * half_x)
    y, z, x, body = (-half_y, half_y - 2 * well), span(base, high), about(half_x), a.body(skin)
    if a.happens(0.5):
        split, side = y[0] + a.draw(0.3, 0.65) * (y[1] - y[0]), a.sign()
        body.add(_half_shell(x, z, (y[1], split + PLAY), 0.004, r, Y))
        pin = (side * (half_x + 0.002), split, mid(z))
        front = a.hinge("front", (0.0, 0.0, side), pin, a.degrees(80, 170))
        front.add(_half_shell(x, z, (y[0], split), 0.004, r, Y))
    else:
        body.add(block(x, y, z, r, 0.015, Y))
    floor = box(within(x, r), (y[1] - 0.003, y[1] + well), (base + 0.01, base + 0.05))
    body.add(floor, look=metal)
    rail, top = y[1] + 0.011, z[1] + a.draw(0.005, 0.04)
    handle = a.slider("handle", UP, (0, rail, top), a.draw(0.25, 0.8) * high, look=metal)
    for side in (-1.0, 1.0):
        at = (side * apart, rail)
        sleeve, hole = SQUARE * (0.011, 0.0105) + at, SQUARE * (tube + PLAY) + at
        body.add(ribbon(sleeve, hole, (base + 0.051, z[1]), looped=True), look=metal)
        handle.add(cylinder(Z, at, tube, (base + 0.055, top), 10))
    grip = block(about(apart + 0.012), about(0.011, rail), span(top, 0.022), 0.008, 0.004)
    handle.add(grip, look=BLACK)
    _luggage_wheels(a, half_x - r - 0.012, y, radius, base, a.happens(0.5), metal)


def _luggage_wheels(
    a: Assembly, half: float, y: Span, radius: float, base: float, four: bool, metal: Material
) -> None:
    for name, x in (("left", -half), ("right", half)):
        if four:
            for row, at in (("rear", y[1] - 0.04), ("front", y[0] + 0.03)):
                castor(a, f"{row}_{name}", (x, at, base), radius, 0.012, 0.0, metal)
            continue
        rear = y[1] - 0.02
        wheel(a, f"{name}_wheel", (x, rear, radius), radius, 0.02, metal)
        a.root.add(*bracket(x, rear, radius, 0.02, base + 0.002), look=metal)
        foot = box(about(0.01, x), about(0.015, y[0] + 0.03), (0.0, base - 0.008))
        a.root.add(foot, look=metal)


def mailbox(a: Assembly) -> None:
    """An arched box with a door in front and a flag, on a post or on its own."""
    skin, metal = a.picks((BLACK, WHITE, BLUE, STEEL, RED), (OAK, STEEL))
    half, long, tall, rise = a.draws((0.07, 0.12), (0.2, 0.28), (0.06, 0.16), (0.5, 1.0))
    post, wall, body = a.draw(0.7, 1.0) if a.happens(0.5) else 0.0, 0.003, a.body(skin)

    def arch(inset: float) -> np.ndarray:
        curve = arc((0.0, 0.0), 1.0, 0.0, np.pi, 11) * (half - inset, rise * half - inset)
        ends = ((half - inset, inset), (inset - half, inset))
        return np.vstack([ends[:1], curve + (0.0, tall), ends[1:]]) + (0.0, post)

    body.add(ribbon(arch(0.0), arch(wall), about(long), Y, looped=True))
    body.add(stack([(arch(wall), long - wall), (arch(wall), long)], Y))
    if post:
        width = about(a.draw(0.03, 0.05))
        body.add(box(width, width, (0.0, post)), look=metal)
    y, level = span(-long - PLAY, -0.004), post + tall + 0.2 * half
    door = a.hinge("door", RIGHT, (0, y[0], post), a.degrees(80, 120))
    door.add(stack([(arch(0.0), y[0]), (arch(0.0), y[1])], Y))
    door.add(block(about(0.01), span(y[0], -0.02), span(level, 0.03), 0.004, axis=Y), look=metal)
    if a.happens(0.8):
        x, along, z, reach = (
            half + PLAY,
            a.draw(-0.5, 0.3) * long,
            post + 0.7 * tall,
            a.draw(0.08, 0.14),
        )
        flag = a.hinge("flag", RIGHT, (x, along, z), np.pi / 2, look=a.pick(RED, BRASS))
        flag.add(cylinder(X, (along, z), 0.008, span(x, 0.006), 12), look=metal)
        flag.add(box(span(x + 0.001, 0.003), span(along, reach), about(0.006, z)))
        flag.add(
            box(
                span(x + 0.0012, 0.0026),
                (along + 0.7 * reach, along + reach),
                span(z + 0.005, 0.03),
            )
        )


MAKERS = {"flap_box": flap_box, "case": case, "trolley_case": trolley_case, "mailbox": mailbox}
