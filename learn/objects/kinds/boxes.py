"""Boxes that open: chests, freezers, safes, cartons, suitcases, mailboxes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from asset_factory.factory.mesh import FloatArray, Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, FRONT, LEFT, RIGHT, UP, Point, X, Y, Z, facing_front
from ..kit.boards import stand, tray
from ..kit.casework import Leaf, furniture
from ..kit.controls import ControlPanel, keypad, lever
from ..kit.looks import BLACK, BLUE, BRASS, GLASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE, wood
from ..kit.outlines import arc, rounded
from ..kit.shapes import Form, block, both, box, cylinder, hoop, pipe, prism, ribbon, stack
from ..kit.spans import PLAY, Span, about, centred, ends, mid, size, span, upto, within
from ..kit.styles import any_color, any_metal, any_style
from ..kit.wheels import bracket, castor, wheel


def _staves(x: Span, y: Span, z: float, board: float, rise: float) -> list[Form]:
    """Return an arched lid of two end plates, and staves along the arch between them."""
    half = size(y) / 2
    arch = arc((0.0, 0.0), 1.0, 0.0, np.pi, 9) * (half, rise) + (0.0, board)
    at = np.array((mid(y), z))
    line = np.vstack([[(half, 0.0)], arch, [(-half, 0.0)]])
    outer = at + line
    inner = at + line * (1.0 - board / half, rise / (board + rise))
    quads = np.stack([outer[:-1], outer[1:], inner[1:], inner[:-1]], axis=1)
    plates = [prism(outer, end, X) for end in ends(x, board)]
    return [*plates, *(prism(quad, within(x, board), X) for quad in quads)]


def _lid(a: Assembly, name: str, x: Span, y: Span, z: float, look: Material) -> None:
    """Build a lid over ``z``, hinged at its back; its axis lies at its lower or upper edge."""
    over = a.pick(0.0, 0.005, 0.015)
    thick = a.draw(0.015, 0.08)
    low = z + a.pick(0.0, 0.001, 0.003)
    x = within(x, -over)
    y = within(y, -over, 0.0)
    upper = a.degrees(60, 105)
    level = low if upper > 1.6 or a.happens(0.6) else low + thick
    lid = a.hinge(name, LEFT, (mid(x), y[1], level), upper, look=look)
    style = a.weighted({"arched": 0.17, "staves": 0.08, "flat": 0.53, "field": 0.22})
    if style == "arched":
        rise = a.draw(0.15, 0.6) * size(y) / 2
        arch = arc((0.0, 0.0), 1.0, 0.0, np.pi, 11) * (size(y) / 2, rise) + (mid(y), low + thick)
        lid.add(prism([*arch, (y[0], low), (y[1], low)], x, X))
    elif style == "staves":
        lid.add(*_staves(x, y, low, min(thick, 0.02), a.draw(0.2, 0.5) * size(y) / 2))
    else:
        lid.add(box(x, y, span(low, thick)))
    if style == "field":
        lid.add(box(within(x, 0.03), within(y, 0.03), span(low + thick, 0.006)))
    if a.happens(0.5):
        lid.add(box(about(0.05, mid(x)), span(y[0], -0.015), span(low, 0.6 * thick)), look=BLACK)


def _side_grips(body: PartDraft, x: Span, y: Span, z: float, look: Material) -> None:
    body.add(*(box(end, y, span(z, 0.02)) for end in ends(within(x, -0.022), 0.022)), look=look)


def coffer(a: Assembly) -> None:
    """Build a chest, a bench or a freezer: one lid hinged at its back, or two beside each other."""
    width, depth, height, wall = a.draws((0.4, 1.7), (0.3, 0.7), (0.25, 0.9), (0.012, 0.06))
    x, y = upto(width, depth)
    z = span(a.pick(0.0, 0.03, 0.08), height)
    body = a.body(any_color(a), *(tray(x, y, z, wall) if a.happens(0.75) else [box(x, y, z)]))
    stand(a, a.weighted({"feet": 1.0, "plinth": 1.0, "round": 0.5}), x, y, z[0], body.look)
    look = any_color(a)
    if width > 0.9 and a.happens(0.4):
        for i, half in enumerate(ends(x, width / 2)):
            _lid(a, f"lid_{i}", within(half, 0.016), y, z[1], look)
    else:
        _lid(a, "lid", x, y, z[1], look)
    if a.happens(0.3):
        _side_grips(body, x, about(0.1 * depth, depth / 2), 0.7 * height, BLACK)


def chest(a: Assembly) -> None:
    """Build a chest of the demo: on feet, with a flat or arched lid."""
    width, depth, height = a.draws((0.6, 1.0), (0.38, 0.5), (0.3, 0.42))
    board = a.pick(0.016, 0.018)
    x, y = upto(width, depth)
    z = span(0.04, height)
    metal = a.pick(BRASS, BLACK)
    body = a.body(a.pick(wood(a.count(0, 999)), OAK, WALNUT), *tray(x, y, z, board))
    stand(a, "feet", x, y, z[0], body.look)
    _side_grips(body, x, about(0.06, depth / 2), mid(z), metal)
    low = z[1] + 0.003
    lid = a.hinge("lid", LEFT, (width / 2, depth, low), a.degrees(85, 105))
    lid_x = within(x, -0.008)
    lid_y = within(y, -0.01, 0.0)
    if a.happens(0.5):
        lid.add(box(lid_x, lid_y, span(low, board)))
    else:
        lid.add(*_staves(lid_x, lid_y, low, board, 0.175 * depth))
    lip = box(about(0.05, width / 2), span(lid_y[0], -0.022), span(low + 0.003, 0.01))
    lid.add(lip, look=metal)


def glass_freezer(a: Assembly) -> None:
    """Build a shop's freezer: two panes that slide over its top."""
    width, depth, height = a.draws((0.9, 2.0), (0.5, 0.8), (0.7, 0.95))
    x, y = upto(width, depth)
    wall = 0.06
    body = a.body(any_color(a), *tray(x, y, (0.03, height), wall))
    body.add(*(box(x, end, span(height, 0.03)) for end in ends(y, wall - 0.012)))
    stand(a, "feet", x, y, 0.03, BLACK)
    inner = within(x, wall)
    deep = within(y, wall - 0.01)
    long = size(inner) / 2 + a.draw(0.02, 0.08)
    travel = round(size(inner) - long - 0.01, 3)
    for i, pane in enumerate(ends(inner, long)):
        low = height + 0.002 + i * 0.014
        way = (1.0 - 2.0 * i, 0.0, 0.0)
        slider = a.slider(f"pane_{i}", way, (mid(pane), depth / 2, low), travel, look=GLASS)
        slider.add(box(pane, deep, span(low, 0.006)))
        slider.add(box(ends(pane, 0.02)[i], deep, span(low, 0.012)), look=WHITE)


def safe(a: Assembly) -> None:
    """Build a strong box: on its door a dial, a wheel, a lever or keys, which move with it."""
    sizes = a.draws((0.28, 0.75), (0.25, 0.65), (0.22, 1.2))
    style = any_style(a, {"slab": 1.0}, 0.6, 0.75)
    board, front, gap = a.draws((0.02, 0.07), (0.02, 0.06), (0.001, 0.004))
    taste = 0.0 if style.inset else 0.5
    pull = replace(style.pull, kind="none")
    style = replace(style, board=board, front=front, gap=gap, taste=taste, pull=pull, behind=0.001)
    shelves = 1 if sizes[2] > 0.4 else 0
    style = replace(style, reveal=0.0, recess=0.0, shelves=shelves, face=style.body)
    metal = any_metal(a)
    case = furniture(a, style, sizes, "door:door", "feet", a.pick(0.0, 0.02), BLACK)
    door = case.doors[0]
    left = door.side == "left"
    if style.inset and a.happens(0.5):
        wall = style.board
        pin = (within(case.x, wall / 2)[0 if left else 1], -0.001)
        for share in (0.2, 0.8):
            barrel = about(0.03, case.z[0] + share * sizes[2])
            a.root.add(cylinder(Z, pin, min(0.008, 0.3 * wall), barrel, 12), look=metal)
    _locks(a, door, case.face, metal)


def _locks(a: Assembly, leaf: Leaf, face: float, metal: Material) -> None:
    """Add what turns and gives way on a safe's door."""
    door, _, side, x, z = leaf
    left = side == "left"
    at = x[0] + (0.7 if left else 0.3) * size(x)
    room = min(size(x), size(z))
    place = facing_front(face)
    if a.happens(0.6):
        look = BLACK if metal is STEEL else STEEL
        dial = ControlPanel(a, place, look, WHITE, door)
        dial.knob("dial", (at, mid(z) + 0.2 * room), 0.09 * room)
    elif room > 0.15:
        pad = (mid(z) + 0.08 * room, mid(z) + 0.36 * room)
        keypad(a, about(0.16 * room, mid(x)), pad, place, door)
    r = 0.16 * room
    center = (at, mid(z) - 0.2 * room)
    pivot = (at, face, center[1])
    kind = a.weighted({"wheel": 0.4, "handle": 0.35, "none": 0.25})
    if kind == "wheel":
        wheel = a.hinge("wheel", BACK, pivot, a.pick(1.57, 3.14, 6.2), on=door, look=metal)
        wheel.add(cylinder(Y, center, 0.25 * r, (face - 0.05, face - 0.001), 12))
        wheel.add(hoop(Y, center, (0.85 * r, r), (face - 0.05, face - 0.04), 20))
        for half_x, half_z in ((0.9 * r, 0.006), (0.006, 0.9 * r)):
            spoke = about(0.003, face - 0.045)
            wheel.add(box(about(half_x, at), spoke, about(half_z, center[1])))
    elif kind == "handle":
        axis = BACK if left else FRONT
        handle = a.hinge("handle", axis, pivot, a.degrees(45, 90), on=door, look=metal)
        tip = (at + (-1.6 if left else 1.6) * r, center[1])
        handle.add(*lever(center, (face - 0.001, face - 0.043), tip, 0.011))


SQUARE = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])


def flap_box(a: Assembly) -> None:
    """Build a carton with two to four flaps, or a lid with a tongue; some stand open at rest.

    Flaps turn outwards. Where two pairs lie on each other, each is free on its own: who opens a
    lower flap pushes the upper ones up.
    """
    half_x, half_y, high, wall = a.draws((0.06, 0.3), (0.06, 0.25), (0.06, 0.4), (0.0015, 0.005))
    x, y = centred(half_x, half_y)
    body = a.body(a.pick(OAK, WHITE, BLUE, BRASS))
    outline = SQUARE * (half_x, half_y)
    body.add(ribbon(outline, outline - wall * SQUARE, (0.0, high), looped=True))
    body.add(box(within(x, wall), within(y, wall), (0.0, wall)))
    style = a.pick("four", "four", "long", "short", "lid", "tuck")
    z = span(high + PLAY, wall)
    if style == "lid":
        lid = a.hinge("lid", LEFT, (0, half_y, z[0]), a.degrees(90, 170))
        lid.add(box(x, (y[0] - 0.001, y[1]), z))
        return
    least = min(half_x, half_y)
    if style == "tuck":
        _flap_pair(a, 0, half_x, half_y - wall, a.draw(0.5, 0.95) * least, z, True)
        _tuck_lid(a, half_x, half_y, span(z[1] + PLAY, wall))
        return
    opened = a.happens(0.4)
    if style != "long":
        long = half_x - PLAY if style == "short" else a.draw(0.6, 1.0) * least
        _flap_pair(a, 0, half_x, half_y - wall, long, z, opened)
        z = span(z[1] + PLAY, wall)
    if style != "short":
        _flap_pair(a, 1, half_y, half_x, half_y - PLAY, z, opened)


def _tuck_lid(a: Assembly, half_x: float, half_y: float, z: Span) -> None:
    """Build the lid of a product box, standing open, with a tongue at its end."""
    value = a.draw(1.65, 2.6)
    at = (0.0, half_y + z[1] - z[0], z[0])
    lid = a.hinge("lid", LEFT, at, value + a.draw(0.2, 1.0), rest=value)
    lid.add(box(about(half_x), about(half_y), z))
    edge = -half_y - PLAY
    tongue = a.hinge("tongue", LEFT, (0.0, edge, z[0]), 0.1, -np.pi / 2, on=lid)
    tongue.add(box(about(0.96 * half_x), span(edge, -a.draw(0.15, 0.5) * half_y), z))


def _flap_pair(
    a: Assembly, axis: int, edge: float, half: float, long: float, z: Span, opened: bool
) -> None:
    """Build two flaps at ``+-edge`` along ``axis``, each reaching inwards by ``long`` [m]."""
    upper = a.degrees(180, 250) if a.happens(0.6) else a.degrees(90, 170)
    across = about(0.98 * half - 0.001)
    for name, side in (("near", -1.0), ("far", 1.0)):
        reach = span(side * edge, -side * long)
        # A little outside the wall it hangs on, or the flap would cut into that.
        pin = side * (edge + z[1] - z[0])
        turn: Point = (0.0, side, 0.0) if axis == 0 else (-side, 0.0, 0.0)
        at = (pin, 0.0, z[0]) if axis == 0 else (0.0, pin, z[0])
        # All of them lean outwards, or one would stand in another's way.
        rest = a.draw(1.62, 0.9 * upper) if opened and upper > 1.9 else 0.0
        flap = a.hinge(f"flap_{'xy'[axis]}_{name}", turn, at, upper, rest=rest)
        flap.add(box(reach, across, z) if axis == 0 else box(across, reach, z))


def _half_shell(x: Span, y: Span, z: Span, radius: float, axis: int = Z) -> Form:
    """Return an open tray with rounded corners; its floor lies at ``z[0]``, whichever end that is.

    ``z`` runs along ``axis``, and ``x`` and ``y`` across it.
    """
    outer = rounded(x, y, radius)
    inner = rounded(within(x, 0.004), within(y, 0.004), max(radius - 0.004, 0.001))
    middle = (mid(x), mid(y))
    soft = (outer - middle) * (0.99, 0.98) + middle
    low, high = z
    floor = low + (0.004 if high > low else -0.004)
    shoulder = low + 0.2 * (high - low)
    rows = [(soft, low), (outer, shoulder), (outer, high), (inner, high), (inner, floor)]
    return stack(rows, axis)


def case(a: Assembly) -> None:
    """Build a briefcase, tool case or suitcase lying down: shells, latches, a folding grip."""
    half_x, half_y, low, high = a.draws((0.15, 0.35), (0.11, 0.24), (0.03, 0.12), (0.025, 0.1))
    skin, metal = a.picks((BLACK, WALNUT, BLUE, STEEL, RED), (BRASS, STEEL, BLACK))
    x, y = centred(half_x, half_y)
    radius = a.draw(0.006, 0.05)
    seam = low + PLAY
    pin = half_y + 0.004
    body = a.body(skin, _half_shell(x, y, (0.0, low), radius))
    lid = a.hinge("lid", LEFT, (0, pin, seam), a.degrees(80, 120))
    lid.add(_half_shell(x, y, (seam + high, seam), radius))
    for part, side in ((body, -1.0), (lid, 1.0)):
        for at in (-0.6 * half_x, 0.6 * half_x):
            barrel = span(at + side * 0.001, side * 0.029)
            plate = span(at + side * 0.003, side * 0.025)
            part.add(cylinder(X, (pin, seam), 0.003, barrel, 8), look=metal)
            tall = span(seam + side * 0.001, side * 0.011)
            part.add(box(plate, (half_y - 0.002, pin), tall), look=metal)
    front = y[0]
    if a.happens(0.7):
        for i, at in enumerate((-0.55 * half_x, 0.55 * half_x)):
            tall = (seam - 0.012, seam + 0.008)
            foot = (at, front - 0.006, tall[0])
            latch = a.hinge(f"latch_{i}", RIGHT, foot, a.degrees(60, 120), look=metal)
            latch.add(box(about(0.012, at), (front - 0.006, front - PLAY), tall))
    half, reach = a.draws((0.045, 0.07), (0.025, 0.04))
    z = min(0.6 * low, low - 0.016)
    ear = box(about(0.003, half + 0.008), (front - 0.011, front + 0.002), about(0.005, z))
    body.add(*both(ear), look=metal)
    grip = body
    if a.happens(0.7):
        grip = a.hinge("grip", RIGHT, (0, front - 0.008, z), a.degrees(50, 75), -0.1)
    bend = ((-half, 0.008), (-0.85 * half, reach), (0.85 * half, reach), (half, 0.008))
    grip.add(pipe([(at, front - out, z) for at, out in bend], 0.004, 8), look=BLACK)


def trolley_case(a: Assembly) -> None:
    """Build an upright suitcase: telescopic handle, wheels, at times a front that opens."""
    half_x, half_y, high = a.draws((0.17, 0.25), (0.1, 0.15), (0.45, 0.7))
    radius, r, lift = a.draws((0.018, 0.03), (0.02, 0.06), (0.005, 0.04))
    skin, metal = a.picks((BLACK, BLUE, RED, GREEN, STEEL), (STEEL, BLACK))
    base = 2 * radius + 0.008
    x = about(half_x)
    y = (-half_y, half_y - 0.044)
    z = span(base, high)
    body = a.body(skin)
    if a.happens(0.5):
        split = y[0] + a.draw(0.3, 0.65) * (y[1] - y[0])
        side = a.sign()
        body.add(_half_shell(x, z, (y[1], split + PLAY), r, Y))
        pin = (side * (half_x + 0.002), split, mid(z))
        front = a.hinge("front", (0.0, 0.0, side), pin, a.degrees(80, 170))
        front.add(_half_shell(x, z, (y[0], split), r, Y))
    else:
        body.add(block(x, y, z, r, 0.015, Y))
    floor = box(within(x, r), span(y[1] - 0.003, 0.025), (base + 0.01, base + 0.05))
    body.add(floor, look=metal)
    rail = y[1] + 0.011
    top = z[1] + lift
    apart = a.draw(0.05, 0.5 * half_x)
    handle = a.slider("handle", UP, (0, rail, top), a.draw(0.25, 0.8) * high, look=metal)
    at = (apart, rail)
    sleeve = (SQUARE * (0.011, 0.0105) + at, SQUARE * (0.006 + PLAY) + at)
    body.add(*both(ribbon(*sleeve, (base + 0.051, z[1]), looped=True)), look=metal)
    handle.add(*both(cylinder(Z, at, 0.006, (base + 0.055, top), 10)))
    grip = block(about(apart + 0.012), about(0.011, rail), span(top, 0.022), 0.008, 0.004)
    handle.add(grip, look=BLACK)
    four = a.happens(0.5)
    rear = y[1] - (0.04 if four else 0.02)
    for name, at_x in zip(("left", "right"), about(half_x - r - 0.012), strict=True):
        if four:
            castor(a, f"rear_{name}", (at_x, rear, base), radius, 0.012, 0.0, metal)
            castor(a, f"front_{name}", (at_x, y[0] + 0.03, base), radius, 0.012, 0.0, metal)
            continue
        wheel(a, f"{name}_wheel", (at_x, rear, radius), radius, 0.02, metal)
        foot = box(about(0.01, at_x), about(0.015, y[0] + 0.03), (0.0, base - 0.008))
        body.add(foot, *bracket(at_x, rear, radius, 0.02, base + 0.002), look=metal)


def mailbox(a: Assembly) -> None:
    """Build an arched box with a door in front and a flag, on a post or on its own."""
    half, long, tall, rise = a.draws((0.07, 0.12), (0.2, 0.28), (0.06, 0.16), (0.5, 1.0))
    skin, metal = a.picks((BLACK, WHITE, BLUE, STEEL, RED), (OAK, STEEL))
    post = a.draw(0.7, 1.0) if a.happens(0.5) else 0.0
    body = a.body(skin)
    outer, inner = (_arch(half, rise * half, tall, inset, post) for inset in (0.0, 0.003))
    body.add(ribbon(outer, inner, about(long), Y, looped=True))
    body.add(prism(inner, (long - 0.003, long), Y))
    if post:
        width = about(a.draw(0.03, 0.05))
        body.add(box(width, width, (0.0, post)), look=metal)
    y = span(-long - PLAY, -0.004)
    door = a.hinge("door", RIGHT, (0, y[0], post), a.degrees(80, 120))
    door.add(prism(outer, y, Y))
    knob = span(post + tall + 0.2 * half, 0.03)
    door.add(block(about(0.01), span(y[0], -0.02), knob, 0.004, axis=Y), look=metal)
    if a.happens(0.8):
        x = half + PLAY
        y0 = a.draw(-0.5, 0.3) * long
        z = post + 0.7 * tall
        reach = a.draw(0.08, 0.14)
        flag = a.hinge("flag", RIGHT, (x, y0, z), np.pi / 2, look=a.pick(RED, BRASS))
        flag.add(cylinder(X, (y0, z), 0.008, span(x, 0.006), 12), look=metal)
        flag.add(box(span(x + 0.001, 0.003), span(y0, reach), about(0.006, z)))
        cloth = span(y0 + reach, -0.3 * reach)
        flag.add(box(span(x + 0.0012, 0.0026), cloth, span(z + 0.005, 0.03)))


def _arch(half: float, rise: float, tall: float, inset: float, low: float) -> FloatArray:
    """Return the outline of an arched box, ``inset`` inside of it [m]; it stands on ``low``."""
    curve = arc((0.0, 0.0), 1.0, 0.0, np.pi, 11) * (half - inset, rise - inset)
    foot = np.array([(half - inset, inset - tall), (inset - half, inset - tall)])
    outline = np.vstack([foot[:1], curve, foot[1:]])
    outline[:, 1] += tall + low
    return outline
