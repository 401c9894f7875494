"""Tables and desks, chairs and toilets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from asset_factory.factory.mesh import FloatArray, Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, FRONT, LEFT, RIGHT, UP, X, Y, Z, facing_front, facing_side, facing_up
from ..kit.boards import stand
from ..kit.casework import Casework, furniture
from ..kit.controls import ControlPanel, lever
from ..kit.layouts import column, drawers, grid, row
from ..kit.looks import BLACK, BLUE, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from ..kit.shapes import Form, block, both, box, cylinder, lathe, loft, pipe, ribbon, stack
from ..kit.spans import PLAY, Span, about, ends, mid, size, span, upto, within
from ..kit.styles import any_color, any_style
from ..kit.wheels import castor

UNDER = {"tapered": 0.35, "round": 0.25, "feet": 0.2, "turned": 0.2}


def _top(a: Assembly, x: Span, y: Span, z: float) -> float:
    """Build a table top under ``z``; returns the height of its underside [m]."""
    level = span(z, -a.draw(0.015, 0.05))
    radius = 0.0 if a.happens(0.7) else a.draw(0.02, 0.1)
    top = block(x, y, level, radius) if radius else box(x, y, level)
    a.root.add(top, look=any_color(a))
    return level[0]


def table(a: Assembly) -> None:
    """Build a table with one to four drawers in its apron; a shelf below at times."""
    width, depth, height, apron = a.draws((0.4, 1.9), (0.35, 0.9), (0.4, 0.95), (0.08, 0.2))
    style = replace(any_style(a, {"slab": 0.7, "bevel": 0.3}, 0.6), shelves=0, covered=True)
    over = a.pick(0.0, 0.01, 0.03, 0.06)
    under = _top(a, (-over, width + over), (-over - 0.03, depth + over), height)
    count = min(4, max(1, round(width / a.draw(0.35, 0.9))))
    fixed = [(1.0, "fixed")] if count < 3 and a.happens(0.3) else []
    node = row(*fixed, *[(1.0, "drawer")] * count, *fixed)
    base = under - apron
    case = furniture(a, style, (width, depth, apron), node, a.weighted(UNDER), base)
    if a.happens(0.3):
        shelf = span(a.draw(0.15, 0.5) * base, 0.018)
        a.root.add(box(within(case.x, 0.03), within(case.y, 0.03), shelf), look=style.body)


def desk(a: Assembly) -> None:
    """Build a desk: a case on one side or on both, drawers over the knees at times."""
    width, depth, height = a.draws((0.9, 2.0), (0.45, 0.85), (0.68, 0.8))
    panels = {"slab": 0.5, "bevel": 0.15, "shaker": 0.2, "raised": 0.15}
    style = replace(any_style(a, panels), covered=True, crowded=True, shelves=2)
    over, base = a.picks((0.0, 0.01, 0.03), (0.0, 0.03, 0.08, 0.2))
    under = _top(a, (-over, width + over), (-over - 0.03, depth + over), height)
    x, y = upto(width, depth)
    sides = ends(x, a.draw(0.24, 0.4) * min(width, 1.4))
    taken = sides if a.happens(0.45) else [a.pick(*sides)]
    for i, side in enumerate(taken):
        closed = a.pick("door", column((0.65, "door"), (0.35, "drawer")))
        node = closed if a.happens(0.3) else drawers(a, a.count(2, 4))
        Casework(a, style, side, y, (base, under), f"side_{i}_").build(node)
        stand(a, a.weighted(UNDER | {"plinth": 1.0}), side, y, base, style.body)
    knees = (sides[0][1], sides[1][0])
    if len(taken) == 1:
        left = taken[0] == sides[0]
        post = ends(x, 0.03)[1 if left else 0]
        knees = (sides[0][1], post[0]) if left else (post[1], sides[1][0])
        deep = [y] if a.happens(0.5) else ends(y, 0.03)
        a.root.add(*(box(post, each, (0.0, under)) for each in deep), look=style.body)
    if a.happens(0.5):
        node = grid(a, min(3, max(1, round(size(knees) / 0.5))), 1)
        high = (under - a.draw(0.08, 0.13), under)
        Casework(a, replace(style, board=0.012), knees, y, high, "knee_").build(node)
    if a.happens(0.5):
        modesty = box(knees, span(depth - 0.03, 0.018), (0.35 * under, under - 0.15))
        a.root.add(modesty, look=style.body)


def folding_table(a: Assembly) -> None:
    """Build a table whose side leaves hang and come up."""
    width, depth, height, thick = a.draws((0.3, 0.8), (0.6, 1.2), (0.6, 0.8), (0.015, 0.03))
    x, y = upto(width, depth)
    under = height - thick
    body = a.body(any_color(a), box(x, y, (under, height)))
    frame_x = within(x, 0.04)
    frame_y = within(y, 0.08)
    stand(a, a.weighted(UNDER), frame_x, frame_y, under, any_color(a))
    body.add(*(box(frame_x, end, span(under, -0.08)) for end in ends(frame_y, 0.018)))
    gap, length = a.draws((0.001, 0.004), (0.25 * height, 0.6 * height))
    for i, side in enumerate((-1.0, 1.0) if a.happens(0.7) else (1.0,)):
        # The axis lies at the edge's lower corner, a gap outside: a hanging leaf faces outwards.
        edge = x[1] + gap if side > 0 else x[0] - gap
        at = (edge, depth / 2, under)
        leaf = a.hinge(f"leaf_{i}", FRONT if side > 0 else BACK, at, a.degrees(90, 90))
        leaf.add(box(span(edge, side * thick), y, span(under, -length)))


def vanity(a: Assembly) -> None:
    """Build a dressing table: drawers under the top, a mirror on it that tilts."""
    width, depth, height, high = a.draws((0.7, 1.4), (0.35, 0.5), (0.68, 0.8), (0.1, 0.35))
    style = any_style(a, {"slab": 0.6, "bevel": 0.2, "raised": 0.2})
    style = replace(style, covered=True, shelves=0)
    under = _top(a, (-0.01, width + 0.01), (-0.035, depth + 0.01), height)
    node = grid(a, a.count(1, 3), 1)
    if high > 0.22:
        node = row((1.0, drawers(a, 2)), (1.2, "drawer"), (1.0, drawers(a, 2)))
    furniture(a, style, (width, depth, high), node, a.weighted(UNDER), under - high)
    x = about(a.draw(0.2, 0.4) * width, width / 2)
    y = span(depth - 0.06, 0.015)
    z = span(height + 0.04, a.draw(0.4, 0.7))
    for post in ends(within(x, -0.025), 0.02):
        upright = (height, z[0] + 0.6 * size(z))
        a.root.add(box(post, within(y, -0.01, -0.005), upright), look=style.body)
    at = (width / 2, mid(y), mid(z))
    mirror = a.hinge("mirror", a.pick(LEFT, RIGHT), at, a.degrees(15, 30), look=any_color(a))
    mirror.add(box(x, y, z))


def office_chair(a: Assembly) -> None:
    """Build feet on castors or glides, and a seat that turns and rises; some backs tilt."""
    reach, radius, wide, column = a.draws((0.26, 0.34), (0.022, 0.03), (0.02, 0.03), (0.02, 0.03))
    top, clear, heading = a.draws((0.38, 0.5), (0.008, 0.02), (0.0, 2 * np.pi))
    cloth, metal = a.picks((BLACK, BLUE, RED, GREEN, WHITE), (STEEL, BLACK))
    rolling, twin, rises, backed, tilts = a.happen(0.75, 0.8, 0.75, 0.8, 0.4)
    deck = 2 * radius + clear
    low = 0.7 * top
    body = a.body(metal)
    post = [(1.6, deck + 0.001), (1.7, deck + 0.06), (1.1, deck + 0.08), (1.0, low)]
    body.add(lathe([(r * column, z) for r, z in post], sides=20))
    feet = a.pick(4, 5, 5)
    for i in range(feet):
        angle = 2 * np.pi * i / feet - np.pi / 2
        x = float(np.cos(angle))
        y = float(np.sin(angle))
        line = ((0.9 * column, deck + 0.045), (reach, deck + 0.012))
        body.add(pipe([(out * x, out * y, z) for out, z in line], [0.022, 0.0155], 4, flat=0.75))
        at = (0.95 * reach * x, 0.95 * reach * y, deck)
        if rolling:
            castor(a, f"castor_{i}", at, radius, wide, heading + 0.7 * i, metal, twin)
        else:
            glide = lathe([(0.02, 0.0), (0.012, deck + 0.005)], (*at[:2], 0.0), sides=12)
            body.add(glide, look=BLACK)
    seat = a.spin("seat", UP, (0, 0, top), a.draw(0.06, 0.14) if rises else 0.0, look=cloth)
    tube = cylinder(Z, (0.0, 0.0), 0.75 * column, (low + PLAY, top + 0.001))
    arm = box(about(0.03), (0.09, 0.28), (top + 0.0002, top + 0.008))
    seat.add(tube, arm, box(about(0.1), about(0.1), span(top, 0.012)), look=metal)
    _cushion(a, seat, top, metal)
    if backed:
        pin = (0, 0.266, top + 0.02)
        back = a.hinge("back", LEFT, pin, a.degrees(15, 35), on=seat) if tilts else seat
        _back(a, back, top, metal)


def _cushion(a: Assembly, seat: PartDraft, top: float, metal: Material) -> None:
    """Build a cushion, round or square; often arm rests."""
    half, deep, thick, rise = a.draws((0.21, 0.26), (0.2, 0.24), (0.04, 0.09), (0.18, 0.26))
    z = span(top + 0.0122, thick)
    if a.happens(0.25):
        pad = [(half - 0.02, z[0]), (half, z[0] + 0.4 * thick), (half - 0.02, z[1])]
        seat.add(lathe(pad, sides=32))
        return
    seat.add(block(about(half), about(deep), z, 0.07, 0.3 * thick))
    if a.happens(0.55):
        out = half + 0.03
        corner = [(0.1, 0.006), (out - 0.02, 0.006), (out, 0.03), (out, rise)]
        arm = pipe([(x, 0.02, top + up) for x, up in corner], 0.012, 6, up=BACK)
        seat.add(*both(arm), look=metal)
        rest = block(about(0.025, out), (-0.12, 0.14), span(top + rise - 0.005, 0.025), 0.02, 0.005)
        seat.add(*both(rest), look=BLACK)


def _back(a: Assembly, back: PartDraft, top: float, metal: Material) -> None:
    half, start, tall, y = a.draws((0.2, 0.26), (0.18, 0.25), (0.5, 0.8), (0.25, 0.28))
    hollow, thick = a.draws((0.0, 0.06), (0.02, 0.06))
    low = top + start
    high = top + tall
    x = np.linspace(-half, half, 9)
    bow = y - hollow * (x / half) ** 2
    edge = 0.12 * (x / half) ** 4 * (high - low)
    corners = ((0.0, low + edge), (thick, low + edge), (thick, high - edge), (0.0, high - edge))
    back.add(loft(np.stack([np.stack([x, bow + dy, z], axis=1) for dy, z in corners], axis=1)))
    behind = y + thick + 0.012
    stem = [(0.0, 0.266, top + 0.028), (0.0, behind + 0.008, top + 0.08), (0.0, behind, low + 0.15)]
    back.add(pipe(stem, 0.018, 4, up=RIGHT, flat=2.0), look=metal)


def folding_chair(a: Assembly) -> None:
    """Build two crossed frames and a seat, unfolded; positive values fold it up."""
    half, seat_z, high, r = a.draws((0.2, 0.25), (0.4, 0.47), (0.76, 0.95), (0.009, 0.014))
    foot, lean, rest, crossing = a.draws((0.2, 0.26), (0.3, 0.42), (0.12, 0.3), (0.0, 0.06))
    back, deep, thick = a.draws((-0.02, 0.06), (0.34, 0.4), (0.008, 0.02))
    metal, cloth = a.picks((STEEL, BLACK, OAK, WHITE), (BLACK, BLUE, OAK, RED, WALNUT))
    slope = lean / seat_z
    sides = a.pick(4, 10, 10)
    body = a.body(metal)

    def main(z: float) -> float:
        """Return where the long frame, which leans back as it rises, is at a height."""
        return slope * z - foot

    line = [(half, main(z), z) for z in (0.0, 0.5 * high, high)]
    body.add(*both(pipe(line, r, sides, up=RIGHT)))
    body.add(cylinder(X, (main(0.12), 0.12), 0.7 * r, about(half), 10))
    pad = block(about(half), about(0.006, main(high)), (high - rest, high - 0.01), 0.02, axis=Y)
    tilt = float(np.arctan(slope))
    body.add(pad.turned(RIGHT, -tilt, (0, main(high), high)), look=cloth)
    inner = half - 2 * r - PLAY
    cross = 0.5 * seat_z + crossing
    pivot = (main(cross), cross)
    back_foot = main(seat_z) + back
    run = (pivot[0] - back_foot) / cross
    folded = (tilt + float(np.arctan(-run))) * a.draw(0.65, 0.85)
    legs = a.hinge("legs", LEFT, (0.0, *pivot), folded)
    line = [(inner, back_foot + run * z, z) for z in (0.0, cross, seat_z - 0.035)]
    pin = cylinder(X, pivot, 0.006, (inner - r * 0.5, half - r - PLAY / 2), 10)
    legs.add(*both(pipe(line, r, sides, up=RIGHT), pin))
    legs.add(cylinder(X, (back_foot + run * 0.08, 0.08), 0.7 * r, about(inner), 10))
    width = inner - r - PLAY
    rear = main(seat_z)
    upper = (np.pi / 2 - tilt) * a.draw(0.7, 0.95)
    seat = a.hinge("seat", LEFT, (0, rear, seat_z), upper)
    z = (seat_z - 0.008, seat_z + thick)
    seat.add(block(about(width), (rear - deep, rear - 0.005), z, 0.04, 0.003), look=cloth)
    seat.add(cylinder(X, (rear, seat_z), 0.006, about(half - r - PLAY / 2), 10))
    seat.add(box(about(width - 0.01), span(rear, -0.02), about(0.003, seat_z)))


def _egg(wide: float, front: float, back: float, inset: float = 0.0) -> FloatArray:
    """Return an oval from ``front`` towards -Y to ``back`` towards +Y [m], shape [32, 2]."""
    angle = 2.0 * np.pi * np.arange(32) / 32
    reach = np.where(np.sin(angle) < 0.0, front, back) - inset
    return np.stack([(wide - inset) * np.cos(angle), reach * np.sin(angle)], axis=1)


def toilet(a: Assembly) -> None:
    """Build a bowl with a seat and a lid; most have a cistern with a lever or buttons.

    Both turn about the pins behind the bowl, each on its own: who lifts the seat lifts the lid.
    """
    rim, wide, front, back = a.draws((0.36, 0.44), (0.17, 0.2), (0.26, 0.36), (0.15, 0.2))
    room, thick = a.draws((0.06, 0.13), (0.012, 0.025))
    lid_thick, gap = a.draws((0.01, 0.025), (0.001, 0.004))
    skin, metal = a.picks((WHITE, BLACK), (WHITE, STEEL))
    body = a.body(skin, _bowl(a, rim, wide, front, back))
    pin = back + a.draw(0.01, 0.03)
    wall = pin + room
    body.add(box(about(0.6 * wide), (0.8 * back, wall), (rim - a.draw(0.1, 0.3), rim - 0.001)))
    seat_z = span(rim + gap, thick)
    lid_z = span(seat_z[1] + gap, lid_thick)
    at = (0.0, pin, mid(seat_z))
    past = (room - (lid_z[1] - at[2]) - 0.045) / (front + pin)
    upper = np.radians(90.0) + np.arcsin(min(max(past, -0.1), 0.25))
    tab = (back - 0.03, pin + 0.004)
    outer = _egg(wide + 0.005, front + 0.005, back - 0.02)
    hole = _egg(wide, front, back - 0.02, a.draw(0.055, 0.08))
    seat = a.hinge("seat", LEFT, at, upper - 0.05)
    if a.happens(0.75):
        seat.add(ribbon(outer, hole, seat_z, looped=True))
    else:
        # Open at its front.
        left, right = (np.roll(line, 6, axis=0)[:-3] for line in (outer, hole))
        seat.add(ribbon(left, right, seat_z))
    seat.add(*both(box(about(0.011, 0.06), tab, within(seat_z, 0.0002))))
    lid = a.hinge("lid", LEFT, at, upper)
    edge = lid_z[0] + 0.6 * lid_thick
    lid.add(stack([(outer, lid_z[0]), (outer, edge), (a.draw(0.85, 0.97) * outer, lid_z[1])]))
    lid.add(*both(box(about(0.011, 0.085), tab, span(lid_z[0] + 0.0002, 0.5 * lid_thick))))
    foot = box(about(0.01, 0.11), (pin + 0.001, wall), (rim - 0.02, at[2] - 0.007))
    hinge = cylinder(X, (pin, at[2]), 0.006, about(0.012, 0.11), 12)
    body.add(*both(hinge, foot), look=metal)
    if a.happens(0.85):
        _cistern(a, wall, rim, metal)
    else:
        body.add(box(about(0.25), (wall + 0.001, wall + 0.02), (0.0, rim + 0.25)), look=metal)


def _bowl(a: Assembly, rim: float, wide: float, front: float, back: float) -> Form:
    """Build foot, waist, rim, and down the inside: one surface."""
    top = _egg(wide, front, back)
    deep = _egg(0.35 * wide, 0.35 * front, 0.3 * back)
    inside = _egg(wide, front, back, a.draw(0.03, 0.045))
    rows = [(0.97 * top, a.draw(0.7, 0.9)), (top, 1.0), (inside, 1.0), (deep, 0.55)]
    if a.happens(0.2):
        rows = [(deep, 0.3), (0.75 * top, 0.5), *rows]
    else:
        x, y, z = a.draws((0.5, 0.8), (0.4, 0.7), (0.8, 1.1))
        u, v, w = a.draws((0.45, 0.65), (0.35, 0.55), (0.8, 1.0))
        foot = _egg(wide * x, front * y, back * z)
        waist = _egg(wide * u, front * v, back * w)
        rows = [(foot, 0.0), (waist, a.draw(0.3, 0.5)), *rows]
    return stack([(outline, rim * height) for outline, height in rows])


def _cistern(a: Assembly, wall: float, rim: float, metal: Material) -> None:
    half, deep, low, high = a.draws((0.17, 0.24), (0.15, 0.2), (-0.05, 0.01), (0.32, 0.42))
    r, taper, thick = a.draws((0.005, 0.05), (0.85, 1.0), (0.02, 0.04))
    style = a.pick("lever", "side", "buttons")
    x = about(half)
    y = (wall + 0.0005, wall + deep)
    z = (rim + low, rim + high)
    body = a.root
    body.add(block(x, y, z, r, taper=taper))
    cap = span(z[1] + 0.001, thick)
    lid = body
    if a.happens(0.3) and style != "buttons":
        lid = a.slider("cistern_lid", UP, (0, y[0], cap[0]), a.draw(0.05, 0.15))
    lid.add(block(within(x, -0.008), within(y, -0.008, 0.0), cap, 0.02, 0.004))
    if style == "buttons":
        plate = [(0.06, cap[1] + 0.0002), (0.06, cap[1] + 0.0015)]
        body.add(lathe(plate, (0, mid(y), 0), stretch=(1.0, 0.6)), look=metal)
        radius = a.draw(0.016, 0.024)
        across = about(radius, mid(y))
        # The button dips into a well that nobody sees; it stops above the plate.
        panel = ControlPanel(a, facing_up(cap[1] + 0.002), metal)
        for i, at in enumerate(a.pick((0.0,), (-0.026, 0.026))):
            panel.button(f"button_{i}", about(radius, at), across, thick=0.006)
        return
    level = z[1] - a.draw(0.04, 0.09)
    length = a.draw(0.06, 0.11)
    side = a.sign()
    at = side * (half - a.draw(0.04, 0.06))
    face = facing_front(y[0])
    if style == "side":
        at = side * mid(y)
        face = facing_side(side * half)
    axis = (0.0, side, 0.0)
    pivot = (at, -0.008, level)
    handle = a.hinge("lever", axis, pivot, a.degrees(25, 50), look=metal, place=face)
    tip = (at - side * length, level - 0.01)
    handle.add(*lever((at, level), (-0.006, -0.028), tip, 0.008))
