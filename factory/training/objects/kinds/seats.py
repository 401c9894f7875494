"""Office chairs, folding chairs and toilets."""

from __future__ import annotations

import numpy as np

from ....mesh import FloatArray, Material
from ..kit.assembly import BACK, LEFT, RIGHT, UP, Assembly, PartDraft, facing_up
from ..kit.controls import button
from ..kit.looks import BLACK, BLUE, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.shapes import (
    X,
    Y,
    Z,
    about,
    block,
    box,
    cylinder,
    lathe,
    loft,
    mid,
    pipe,
    ribbon,
    span,
    stack,
    within,
)  # fmt: skip
from ..kit.wheels import castor

PLAY = 0.0015
SIDES = (-1.0, 1.0)


def office_chair(a: Assembly) -> None:
    """Five feet on castors or glides, a column, and a seat that turns and rises; some backs tilt."""
    cloth, metal = a.picks((BLACK, BLUE, RED, GREEN, WHITE), (STEEL, BLACK))
    reach, radius, wide, column, top = a.draws(
        (0.26, 0.34), (0.022, 0.03), (0.02, 0.03), (0.02, 0.03), (0.38, 0.5)
    )
    deck, low, body = 2 * radius + a.draw(0.008, 0.02), 0.7 * top, a.body(metal)
    post = [(1.6, deck + 0.001), (1.7, deck + 0.06), (1.1, deck + 0.08), (1.0, low)]
    body.add(lathe([(r * column, z) for r, z in post], sides=20))
    feet, rolling, heading, twin = (
        a.pick(4, 5, 5),
        a.happens(0.75),
        a.draw(0.0, 2 * np.pi),
        a.happens(0.8),
    )
    for i in range(feet):
        angle = 2 * np.pi * i / feet - np.pi / 2
        way = np.array((np.cos(angle), np.sin(angle), 0.0))
        arm = [0.9 * column * way + (0, 0, deck + 0.045), reach * way + (0, 0, deck + 0.012)]
        body.add(pipe(arm, [0.022, 0.0155], 4, flat=0.75))
        x, y, _ = (0.95 * reach * way).tolist()
        if rolling:
            castor(a, f"castor_{i}", (x, y, deck), radius, wide, heading + 0.7 * i, metal, twin)
        else:
            body.add(lathe([(0.02, 0.0), (0.012, deck + 0.005)], (x, y, 0), sides=12), look=BLACK)
    slide = a.draw(0.06, 0.14) if a.happens(0.75) else 0.0
    seat = a.spin("seat", UP, (0, 0, top), slide, look=cloth)
    _cushion(a, seat, column, low, top, metal)
    if a.happens(0.8):
        tilts = a.happens(0.4)
        at = (0, 0.266, top + 0.02)
        back = a.hinge("back", LEFT, at, a.degrees(15, 35), on=seat) if tilts else seat
        _back(a, back, top, metal)


def _cushion(
    a: Assembly, seat: PartDraft, column: float, low: float, top: float, metal: Material
) -> None:
    """The inner tube, the plate on it, the cushion; often arm rests."""
    half, deep, thick = a.draws((0.21, 0.26), (0.2, 0.24), (0.04, 0.09))
    tube = cylinder(Z, (0.0, 0.0), 0.75 * column, (low + PLAY, top + 0.001))
    plate = box(about(0.1), about(0.1), span(top, 0.012))
    seat.add(tube, plate, box(about(0.03), (0.09, 0.28), (top + 0.0002, top + 0.008)), look=metal)
    start = top + 0.0122
    if a.happens(0.25):
        pad = [(half - 0.02, 0.0), (half, 0.4 * thick), (half - 0.02, thick)]
        seat.add(lathe(pad, (0, 0, start), sides=32))
        return
    seat.add(block(about(half), about(deep), span(start, thick), 0.07, 0.3 * thick))
    if not a.happens(0.55):
        return
    rise, out = a.draw(0.18, 0.26), half + 0.03
    for side in SIDES:
        corner = [(0.1, 0.006), (out - 0.02, 0.006), (out, 0.03), (out, rise)]
        arm = pipe([(side * x, 0.02, top + z) for x, z in corner], 0.012, 6, up=BACK)
        seat.add(arm, look=metal)
        rest = block(
            about(0.025, side * out), (-0.12, 0.14), span(top + rise - 0.005, 0.025), 0.02, 0.005
        )
        seat.add(rest, look=BLACK)


def _back(a: Assembly, back: PartDraft, top: float, metal: Material) -> None:
    half, low, high, y = a.draws((0.2, 0.26), (0.18, 0.25), (0.5, 0.8), (0.25, 0.28))
    low, high, thick, x = top + low, top + high, a.draw(0.02, 0.06), np.linspace(-half, half, 9)
    bow, edge = y - a.draw(0.0, 0.06) * (x / half) ** 2, 0.12 * (x / half) ** 4 * (high - low)
    corners = ((0.0, low + edge), (thick, low + edge), (thick, high - edge), (0.0, high - edge))
    back.add(loft(np.stack([np.stack([x, bow + dy, z], axis=1) for dy, z in corners], axis=1)))
    behind = y + thick + 0.012
    stem = [(0.0, 0.266, top + 0.028), (0.0, behind + 0.008, top + 0.08), (0.0, behind, low + 0.15)]
    back.add(pipe(stem, 0.018, 4, up=RIGHT, flat=2.0), look=metal)


def folding_chair(a: Assembly) -> None:
    """Two crossed frames and a seat, unfolded; positive values fold it up."""
    metal, cloth = a.picks((STEEL, BLACK, OAK, WHITE), (BLACK, BLUE, OAK, RED, WALNUT))
    half, seat_z, high, r = a.draws((0.2, 0.25), (0.4, 0.47), (0.76, 0.95), (0.009, 0.014))
    foot, slope = -a.draw(0.2, 0.26), a.draw(0.3, 0.42) / seat_z
    sides, body = 4 if a.happens(0.3) else 10, a.body(metal)

    def main(z: float) -> float:
        """The long frame leans back as it rises."""
        return foot + slope * z

    for side in SIDES:
        body.add(
            pipe([(side * half, main(z), z) for z in (0.0, 0.5 * high, high)], r, sides, up=RIGHT)
        )
    body.add(cylinder(X, (main(0.12), 0.12), 0.7 * r, about(half), 10))
    top, tilt = main(high), -float(np.arctan(slope))
    pad = block(
        about(half), about(0.006, top), (high - a.draw(0.12, 0.3), high - 0.01), 0.02, axis=Y
    )
    body.add(pad.turned(RIGHT, tilt, (0, top, high)), look=cloth)
    inner, cross = half - 2 * r - PLAY, 0.5 * seat_z + a.draw(0.0, 0.06)
    pivot, back_foot = (0.0, main(cross), cross), main(seat_z) + a.draw(-0.02, 0.06)
    run = (pivot[1] - back_foot) / cross
    folded = float(np.arctan(slope) + np.arctan(-run))
    legs = a.hinge("legs", LEFT, pivot, folded * a.draw(0.65, 0.85))
    for side in SIDES:
        line = [(side * inner, back_foot + run * z, z) for z in (0.0, cross, seat_z - 0.035)]
        pin = sorted((side * (inner - r * 0.5), side * (half - r - PLAY / 2)))
        legs.add(
            pipe(line, r, sides, up=RIGHT), cylinder(X, pivot[1:], 0.006, (pin[0], pin[1]), 10)
        )
    legs.add(cylinder(X, (back_foot + run * 0.08, 0.08), 0.7 * r, about(inner), 10))
    width, hinge_y = inner - r - PLAY, main(seat_z)
    upper = float(np.pi / 2 - np.arctan(slope)) * a.draw(0.7, 0.95)
    seat = a.hinge("seat", LEFT, (0, hinge_y, seat_z), upper)
    deep, z = (
        (hinge_y - a.draw(0.34, 0.4), hinge_y - 0.005),
        (seat_z - 0.008, seat_z + a.draw(0.008, 0.02)),
    )
    seat.add(block(about(width), deep, z, 0.04, 0.003), look=cloth)
    seat.add(cylinder(X, (hinge_y, seat_z), 0.006, about(half - r - PLAY / 2), 10))
    seat.add(box(about(width - 0.01), (hinge_y - 0.02, hinge_y), about(0.003, seat_z)))


def _egg(wide: float, front: float, back: float, inset: float = 0.0) -> FloatArray:
    """An oval that reaches ``front`` towards -Y and ``back`` towards +Y [m], shape [32, 2]."""
    angle = 2.0 * np.pi * np.arange(32) / 32
    reach = np.where(np.sin(angle) < 0.0, front, back) - inset
    return np.stack([(wide - inset) * np.cos(angle), reach * np.sin(angle)], axis=1)


def toilet(a: Assembly) -> None:
    """A bowl with a seat and a lid; most have a cistern with a lever or buttons, some hang on a wall.

    Seat and lid both turn about the pins behind the bowl, each on its own: who lifts the seat lifts
    the lid too.
    """
    rim, wide, front, back = a.draws((0.36, 0.44), (0.17, 0.2), (0.26, 0.36), (0.15, 0.2))
    skin, metal = a.picks((WHITE, BLACK), (WHITE, STEEL))
    body, pin, room = a.body(skin), back + a.draw(0.01, 0.03), a.draw(0.06, 0.13)
    _bowl(a, rim, wide, front, back)
    thick, lid_thick, gap = a.draws((0.012, 0.025), (0.01, 0.025), (0.001, 0.004))
    wall, seat_z = pin + room, span(rim + gap, thick)
    at, lid_z = (0.0, pin, mid(seat_z)), span(seat_z[1] + gap, lid_thick)
    body.add(box(about(0.6 * wide), (0.8 * back, wall), (rim - a.draw(0.1, 0.3), rim - 0.001)))
    past = (room - (lid_z[1] - at[2]) - 0.045) / (front + pin)
    upper = np.radians(90.0) + np.arcsin(min(max(past, -0.1), 0.25))
    tabs = (back - 0.03, pin + 0.004)
    seat = a.hinge("seat", LEFT, at, upper - 0.05)
    hole = _egg(wide, front, back - 0.02, a.draw(0.055, 0.08))
    outer, closed = _egg(wide + 0.005, front + 0.005, back - 0.02), a.happens(0.75)
    lines = [line if closed else np.roll(line, 6, axis=0)[:-3] for line in (outer, hole)]
    seat.add(ribbon(*lines, seat_z, looped=closed))
    seat.add(*(box(about(0.011, x), tabs, within(seat_z, 0.0002)) for x in (-0.06, 0.06)))
    lid = a.hinge("lid", LEFT, at, upper)
    middle = lid_z[0] + 0.6 * lid_thick
    lid.add(stack([(outer, lid_z[0]), (outer, middle), (a.draw(0.85, 0.97) * outer, lid_z[1])]))
    low = span(lid_z[0] + 0.0002, 0.5 * lid_thick)
    lid.add(*(box(about(0.011, x), tabs, low) for x in (-0.085, 0.085)))
    for x in (-0.11, 0.11):
        foot = box(about(0.01, x), (pin + 0.001, wall), (rim - 0.02, at[2] - 0.007))
        body.add(cylinder(X, at[1:], 0.006, about(0.012, x), 12), foot, look=metal)
    if a.happens(0.85):
        _cistern(a, wall, rim, metal)
    else:
        body.add(box(about(0.25), (wall + 0.001, wall + 0.02), (0.0, rim + 0.25)), look=metal)


def _bowl(a: Assembly, rim: float, wide: float, front: float, back: float) -> None:
    """Foot, waist, rim, and down the inside: one surface."""
    top, deep = _egg(wide, front, back), _egg(0.35 * wide, 0.35 * front, 0.3 * back)
    inside = _egg(wide, front, back, a.draw(0.03, 0.045))
    rows = [(0.97 * top, a.draw(0.7, 0.9)), (top, 1.0), (inside, 1.0), (deep, 0.55)]
    if a.happens(0.2):
        rows = [(deep, 0.3), (0.75 * top, 0.5), *rows]
    else:
        f = a.draws((0.5, 0.8), (0.4, 0.7), (0.8, 1.1), (0.45, 0.65), (0.35, 0.55), (0.8, 1.0))
        foot = _egg(wide * f[0], front * f[1], back * f[2])
        waist = _egg(wide * f[3], front * f[4], back * f[5])
        rows = [(foot, 0.0), (waist, a.draw(0.3, 0.5)), *rows]
    a.root.add(stack([(outline, rim * height) for outline, height in rows]))


def _cistern(a: Assembly, wall: float, rim: float, metal: Material) -> None:
    half, deep, low, high = a.draws((0.17, 0.24), (0.15, 0.2), (-0.05, 0.01), (0.32, 0.42))
    x, y, body, style = (
        about(half),
        (wall + 0.0005, wall + deep),
        a.root,
        a.pick("lever", "side", "buttons"),
    )
    z = (rim + low, rim + high)
    body.add(block(x, y, z, a.draw(0.005, 0.05), taper=a.draw(0.85, 1.0)))
    cap, lid = (z[1] + 0.001, z[1] + a.draw(0.02, 0.04)), body
    if a.happens(0.3) and style != "buttons":
        lid = a.slider("cistern_lid", UP, (0, y[0], cap[0]), a.draw(0.05, 0.15))
    lid.add(block(within(x, -0.008), within(y, -0.008, 0.0), cap, 0.02, 0.004))
    if style == "buttons":
        plate = [(0.06, 0.0002), (0.06, 0.0015)]
        body.add(lathe(plate, (0, mid(y), cap[1]), stretch=(1.0, 0.6)), look=metal)
        count, radius = a.count(1, 2), a.draw(0.016, 0.024)
        for i in range(count):
            # The button dips into a well that nobody sees; it stops above the plate.
            at, place = about(radius, (i - (count - 1) / 2) * 0.052), facing_up(cap[1] + 0.002)
            button(a, f"button_{i}", at, about(radius, mid(y)), metal, place, thick=0.006)
        return
    level, length, side = z[1] - a.draw(0.04, 0.09), a.draw(0.06, 0.11), a.sign()
    if style == "lever":
        at = (side * (half - a.draw(0.04, 0.06)), y[0] - 0.008, level)
        stem = cylinder(Y, (at[0], level), 0.009, (y[0] - 0.028, y[0] - 0.006), 14)
        start, arm, axis = (
            np.array((at[0], y[0] - 0.022, level)),
            (-side * length, 0.0, -0.01),
            (0.0, side, 0.0),
        )
    else:
        at = (side * (half + 0.008), mid(y), level)
        stem = cylinder(X, at[1:], 0.009, span(at[0] - side * 0.002, side * 0.022), 14)
        start, arm, axis = (
            np.array((at[0] + side * 0.012, *at[1:])),
            (0.0, -length, -0.01),
            (-side, 0.0, 0.0),
        )
    lever = a.hinge("lever", axis, at, a.degrees(25, 50), look=metal)
    lever.add(
        stem, pipe([start, start + np.multiply(arm, 0.5), start + arm], [0.006, 0.006, 0.008], 8)
    )


MAKERS = {"office_chair": office_chair, "folding_chair": folding_chair, "toilet": toilet}
