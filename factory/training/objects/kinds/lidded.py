"""Boxes with lids, and safes: chests, freezers, benches, strong doors with dials and wheels."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ....mesh import Material
from ..kit.assembly import BACK, FRONT, LEFT, Assembly, PartDraft, facing_front
from ..kit.boards import carcass, frame, stand, tray
from ..kit.casework import swung
from ..kit.controls import keypad, knob
from ..kit.hinges import swing
from ..kit.looks import BLACK, BRASS, GLASS, OAK, STEEL, WALNUT, WHITE, wood
from ..kit.shapes import (
    Form,
    Span,
    X,
    Y,
    Z,
    about,
    arc,
    box,
    cylinder,
    hoop,
    mid,
    prism,
    size,
    span,
    within,
)  # fmt: skip
from ..kit.styles import any_color, any_metal


def _arched(x: Span, y: Span, z: float, thick: float, rise: float) -> Form:
    """A solid lid with an arch along x."""
    curve = arc((0.0, 0.0), 1.0, 0.0, np.pi, 11) * (size(y) / 2, rise) + (mid(y), z + thick)
    return prism([*curve, (y[0], z), (y[1], z)], x, X)


def _staves(x: Span, y: Span, z: float, board: float, rise: float) -> list[Form]:
    """An arched lid of two end plates, and staves along the arch between them."""
    arch = arc((0.0, 0.0), 1.0, 0.0, np.pi, 9) * (size(y) / 2, rise) + (0.0, board)
    outer = np.vstack([[(size(y) / 2, 0.0)], arch, [(-size(y) / 2, 0.0)]])
    inner = outer * (1.0 - 2 * board / size(y), 1.0 - board / (board + rise)) + (mid(y), z)
    outer = outer + (mid(y), z)
    ends = [prism(outer, span(end, way), X) for end, way in ((x[0], board), (x[1], -board))]
    quads = np.stack([outer[:-1], outer[1:], inner[1:], inner[:-1]], axis=1)
    return [*ends, *(prism(quad, within(x, board), X) for quad in quads)]


def _lid(a: Assembly, name: str, x: Span, y: Span, z: float, look: Material) -> None:
    """A lid over ``z``, hinged at its back; its axis lies at its lower or upper edge."""
    over, thick = a.pick(0.0, 0.005, 0.015), a.draw(0.015, 0.08)
    low = z + a.pick(0.0, 0.001, 0.003)
    x, y, upper = within(x, -over), within(y, -over, 0.0), a.degrees(60, 105)
    level = low if a.happens(0.6) or upper > 1.6 else low + thick
    lid = a.hinge(name, LEFT, (mid(x), y[1], level), upper, look=look)
    style = a.weighted({"arched": 0.17, "staves": 0.08, "flat": 0.53, "field": 0.22})
    if style == "arched":
        lid.add(_arched(x, y, low, thick, a.draw(0.15, 0.6) * size(y) / 2))
    elif style == "staves":
        lid.add(*_staves(x, y, low, min(thick, 0.02), a.draw(0.2, 0.5) * size(y) / 2))
    else:
        lid.add(box(x, y, span(low, thick)))
    if style == "field":
        lid.add(box(within(x, 0.03), within(y, 0.03), span(low + thick, 0.006)))
    if a.happens(0.5):
        lid.add(box(about(0.05, mid(x)), span(y[0], -0.015), span(low, 0.6 * thick)), look=BLACK)


def coffer(a: Assembly) -> None:
    """A chest, a bench or a freezer: one lid hinged at its back, or two beside each other."""
    width, depth, height, wall = a.draws((0.4, 1.7), (0.3, 0.7), (0.25, 0.9), (0.012, 0.06))
    base, look, lid_look = a.pick(0.0, 0.03, 0.08), any_color(a), any_color(a)
    x, y, z, body = (0.0, width), (0.0, depth), span(base, height), a.body(look)
    body.add(*(tray(x, y, z, wall) if a.happens(0.75) else [box(x, y, z)]))
    stand(a, a.weighted({"feet": 1.0, "plinth": 1.0, "round": 0.5}), x, y, base, look)
    if width > 0.9 and a.happens(0.4):
        _lid(a, "lid_0", (0.016, width / 2 - 0.016), y, z[1], lid_look)
        _lid(a, "lid_1", (width / 2 + 0.016, width - 0.016), y, z[1], lid_look)
    else:
        _lid(a, "lid", x, y, z[1], lid_look)
    if a.happens(0.3):
        _side_grips(body, x, about(0.1 * depth, depth / 2), 0.7 * height, BLACK)


def _side_grips(body: PartDraft, x: Span, y: Span, z: float, look: Material) -> None:
    for end, way in ((x[0], -0.022), (x[1], 0.022)):
        body.add(box(span(end, way), y, span(z, 0.02)), look=look)


def chest(a: Assembly) -> None:
    """A chest of the demo: on feet, with a flat or arched lid."""
    board, base = a.pick(0.016, 0.018), 0.04
    width, depth, height = a.draws((0.6, 1.0), (0.38, 0.5), (0.3, 0.42))
    look, metal = a.pick(wood(a.count(0, 999)), OAK, WALNUT), a.pick(BRASS, BLACK)
    x, y, z, body = (0.0, width), (0.0, depth), span(base, height), a.body(look)
    body.add(*tray(x, y, z, board))
    stand(a, "feet", x, y, base, look)
    _side_grips(body, x, about(0.06, depth / 2), mid(z), metal)
    lid_x, lid_y, low = within(x, -0.008), within(y, -0.01, 0.0), z[1] + 0.003
    lid = a.hinge("lid", LEFT, (width / 2, depth, low), a.degrees(85, 105))
    flat = a.happens(0.5)
    lid.add(
        *(
            [box(lid_x, lid_y, span(low, board))]
            if flat
            else _staves(lid_x, lid_y, low, board, 0.175 * depth)
        )
    )
    lid.add(
        box(about(0.05, width / 2), span(lid_y[0], -0.022), span(low + 0.003, 0.01)), look=metal
    )


def glass_freezer(a: Assembly) -> None:
    """A shop's freezer: two panes that slide over its top."""
    width, depth, height, lap = a.draws((0.9, 2.0), (0.5, 0.8), (0.7, 0.95), (0.02, 0.08))
    look, wall, x, y = any_color(a), 0.06, (0.0, width), (0.0, depth)
    a.body(look).add(*tray(x, y, (0.03, height), wall))
    stand(a, "feet", x, y, 0.03, BLACK)
    inner, deep = within(x, wall), within(y, wall - 0.01)
    long = size(inner) / 2 + lap
    for i, (end, way) in enumerate(((inner[0], 1.0), (inner[1], -1.0))):
        pane, low = span(end, way * long), height + 0.002 + i * 0.014
        at, travel = (mid(pane), depth / 2, low), round(size(inner) - long - 0.01, 3)
        slider = a.slider(f"pane_{i}", (way, 0.0, 0.0), at, travel, look=GLASS)
        slider.add(box(pane, deep, span(low, 0.006)))
        slider.add(box(span(end, way * 0.02), deep, span(low, 0.012)), look=WHITE)
    for end, way in ((0.0, 1.0), (depth, -1.0)):
        a.root.add(box(x, span(end, way * (wall - 0.012)), span(height, 0.03)))


def safe(a: Assembly) -> None:
    """A strong box: on its door a dial, a wheel, a lever or keys, which move with it."""
    width, depth, height, wall = a.draws((0.28, 0.75), (0.25, 0.65), (0.22, 1.2), (0.02, 0.07))
    thick, gap, base = a.draw(0.02, 0.06), a.draw(0.001, 0.004), a.pick(0.0, 0.02)
    look, metal, inset = any_color(a), any_metal(a), a.happens(0.6)
    x, y, z, body = (0.0, width), (0.0, depth), span(base, height), a.body(look)
    stand(a, "feet", x, y, base, BLACK)
    start = thick + 0.003 if inset else 0.0
    if a.happens(0.75):
        body.add(*carcass(x, y, z, wall, wall))
        if height > 0.4:
            shelf = box(within(x, wall), (start + 0.05, depth - wall), span(mid(z), 0.01))
            body.add(shelf, look=metal)
    else:
        body.add(box(x, (start, depth), z), *(frame(x, (0.0, start), z, wall) if inset else ()))
    side, edge = ("left" if a.happens(0.6) else "right"), (wall + gap if inset else 0.0)
    face, free = (0.0 if inset else -thick - 0.001), (gap if inset else float("inf"))
    furthest, taste = (110.0, 0.0) if inset else (150.0, 0.5)
    door_x, door_z = within(x, edge), within(z, edge)
    turn = swing(a, thick, size(door_x), (free, free), taste, furthest)
    door_x, door_z = turn.trimmed(door_x, door_z, side)
    door = swung(a, "door", side, door_x, door_z, face + turn.setback, turn.upper)
    door.add(box(door_x, span(face, thick), door_z))
    if inset and a.happens(0.5):
        pin = (x[0] + wall / 2 if side == "left" else x[1] - wall / 2, face - 0.001)
        for share in (0.2, 0.8):
            barrel = about(0.03, z[0] + share * height)
            body.add(cylinder(Z, pin, min(0.008, 0.3 * wall), barrel, 12), look=metal)
    _locks(a, door, door_x, door_z, face, side, metal)


def _locks(
    a: Assembly, door: PartDraft, x: Span, z: Span, face: float, side: str, metal: Material
) -> None:
    """What turns and gives way on a safe's door."""
    at = x[0] + (0.3 if side == "right" else 0.7) * size(x)
    room, place = min(size(x), size(z)), facing_front(face)
    if a.happens(0.6):
        look = BLACK if metal is STEEL else STEEL
        knob(a, "dial", (at, mid(z) + 0.2 * room), 0.09 * room, look, place, mark=WHITE, on=door)
    elif room > 0.15:
        pad_z = (mid(z) + 0.08 * room, mid(z) + 0.36 * room)
        keypad(a, about(0.16 * room, mid(x)), pad_z, place, door)
    r, low = 0.16 * room, mid(z) - 0.2 * room
    lock: Callable[..., None] | None = a.weighted({_hand_wheel: 0.4, _lever: 0.35, None: 0.25})
    if lock:
        lock(a, door, (at, face, low), r, -1.0 if side == "left" else 1.0, metal)


def _hand_wheel(
    a: Assembly,
    door: PartDraft,
    at: tuple[float, float, float],
    r: float,
    inward: float,
    metal: Material,
) -> None:
    (x, face, z), spokes = at, about(0.003, at[1] - 0.045)
    wheel = a.hinge("wheel", BACK, at, a.pick(1.57, 3.14, 6.2), on=door, look=metal)
    wheel.add(cylinder(Y, (x, z), 0.25 * r, (face - 0.05, face - 0.001), 12))
    wheel.add(hoop(Y, (x, z), (0.85 * r, r), (face - 0.05, face - 0.04), 20))
    wheel.add(box(about(0.9 * r, x), spokes, about(0.006, z)))
    wheel.add(box(about(0.006, x), spokes, about(0.9 * r, z)))


def _lever(
    a: Assembly,
    door: PartDraft,
    at: tuple[float, float, float],
    r: float,
    inward: float,
    metal: Material,
) -> None:
    x, face, z = at
    axis = BACK if inward < 0.0 else FRONT
    lever = a.hinge("handle", axis, at, a.degrees(45, 90), on=door, look=metal)
    lever.add(cylinder(Y, (x, z), 0.012, (face - 0.035, face - 0.001), 12))
    arm = span(x - inward * 0.012, inward * (0.012 + 1.6 * r))
    lever.add(box(arm, (face - 0.043, face - 0.033), about(0.009, z)))


MAKERS = {"coffer": coffer, "chest": chest, "glass_freezer": glass_freezer, "safe": safe}
