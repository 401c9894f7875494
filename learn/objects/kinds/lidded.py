"""Boxes with lids, and safes: chests, freezers, benches, strong doors with dials and wheels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import BACK, FRONT, LEFT, Assembly, PartDraft, facing_front
from ..kit.boards import stand, tray
from ..kit.casework import Leaf, furniture
from ..kit.controls import keypad, knob, lever
from ..kit.looks import BLACK, BRASS, GLASS, OAK, STEEL, WALNUT, WHITE, wood
from ..kit.outlines import arc
from ..kit.shapes import Form, box, cylinder, hoop, prism
from ..kit.spans import Span, X, Y, Z, about, ends, mid, size, span, upto, within
from ..kit.styles import any_color, any_metal, any_style


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
        knob(a, "dial", (at, mid(z) + 0.2 * room), 0.09 * room, look, place, mark=WHITE, on=door)
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
